#include "scenarios/run/pair_lines.hpp"

#include "render/palette.hpp"

namespace lrb::run {

using Eigen::Vector3d;

std::vector<Vector3d> corners_of(const LrbRep& rep, const Pose& pose, SimplexId s) {
  VertexId v[3];
  rep.simplex(s, v);
  std::vector<Vector3d> out;
  out.reserve(3);
  for (int k = 0; k < rep.simplex_size(); ++k) out.push_back(pose.apply(rep.vertices()[v[k]]));
  return out;
}

/// Draws a segment, or the outline of a polygon, over everything that hides it.
void outline(render::DrawList& list, const std::vector<Vector3d>& corners, render::Rgba colour, float width,
             render::Rgba halo) {
  render::DrawLine line;
  line.points = corners;
  line.closed = corners.size() > 2;
  line.colour = colour;
  line.width = width;
  line.halo = halo;
  line.halo_width = kHalo;
  line.layer = render::Layer::on_top;
  list.lines.push_back(line);
}

void add_mark(render::DrawList& list, const Vector3d& x, render::Rgba colour, float radius,
              render::Rgba halo) {
  render::DrawPoint point;
  point.x = x;
  point.colour = colour;
  point.radius = radius;
  point.halo = halo;
  point.halo_width = kHalo;
  point.layer = render::Layer::on_top;
  list.points.push_back(point);
}

void add_wrong_pairs(render::DrawList& list, std::span<const WrongPair> pairs, const LrbRep& a,
                     const Pose& pose_a, const LrbRep& b, const Pose& pose_b, render::Rgba halo) {
  constexpr float kLineWidth = 2.5F;
  for (const WrongPair& wrong : pairs) {
    outline(list, corners_of(a, pose_a, wrong.pair.a), render::palette::kWrong, kLineWidth, halo);
    outline(list, corners_of(b, pose_b, wrong.pair.b), render::palette::kWrong, kLineWidth, halo);
  }
}

}  // namespace lrb::run
