#include "scenarios/run/measure_marks.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "render/overlay.hpp"
#include "scenarios/run/pair_lines.hpp"
#include "scenarios/run/view_camera.hpp"

namespace lrb::run {
namespace {

using Eigen::Vector3d;

constexpr float kWayWidth = 4, kTextOff = 20, kTextHeight = 19;

void write_beside(render::DrawList& list, const Vector3d& x, float below, const std::string& text,
                  render::Rgba colour) {
  render::DrawLabel label;
  label.x = x;
  label.text = text;
  label.colour = colour;
  label.height = kTextHeight;
  label.dy = below;
  list.labels.push_back(label);
}

/// Draws the barbs of an arrow's head in the plane of the arrow and `across`.
void add_barbs(render::DrawList& list, const MarkedWay& way, const Vector3d& across, render::Rgba colour) {
  constexpr double kHeadLength = 0.24, kHeadWidth = 0.11;
  const Vector3d along = way.to - way.from;
  const Vector3d back = way.to - kHeadLength * along, aside = kHeadWidth * along.norm() * across;
  for (const Vector3d& end : {Vector3d(back + aside), Vector3d(back - aside)})
    outline(list, {end, way.to}, colour, kWayWidth);
}

}  // namespace

std::string interval_words(double lower, double upper) {
  const std::string low = render::short_number(lower), high = render::short_number(upper);
  return low == high ? high : low + " to " + high;
}

std::string kind_words(ClashKind kind) {
  switch (kind) {
    case ClashKind::a_inside_b:
      return "A inside B";
    case ClashKind::b_inside_a:
      return "B inside A";
    case ClashKind::touching_point:
      return "touching in points";
    case ClashKind::touching_edge:
      return "touching along lines";
    case ClashKind::touching_face:
      return "touching in faces";
    case ClashKind::protrudes:
      return "one protrudes into the other";
    case ClashKind::pierces:
      return "A pierces B";
    case ClashKind::cuts_through:
      return "A cuts through B";
    default: {
      std::string out = to_string(kind);
      std::replace(out.begin(), out.end(), '_', ' ');
      return out;
    }
  }
}

std::string kind_words(ClashKind kind, ClashReason reason) {
  return kind_words(kind) + (reason == ClashReason::none ? "" : ": ") + std::string(name_of(reason));
}

std::optional<MarkedWay> gap_of(const ProvedInterval& distance, const Vector3d& point_a,
                                const Vector3d& point_b) {
  if (!(distance.lower > 0) || !std::isfinite(distance.upper)) return std::nullopt;
  return MarkedWay{point_a, point_b, interval_words(distance.lower, distance.upper)};
}

std::optional<MarkedWay> way_out_of(const std::optional<ProvedInterval>& depth, const Vector3d& translation,
                                    const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                    std::span<const ContactRegion> contacts) {
  if (!depth || !std::isfinite(depth->upper) || translation.isZero(0)) return std::nullopt;
  Eigen::AlignedBox3d shared = box_of(a, pose_a).intersection(box_of(b, pose_b));
  if (const std::vector<Vector3d> points = render::contact_points(contacts); !points.empty()) {
    shared.setEmpty();
    for (const Vector3d& x : points) shared.extend(x);
  }
  const Vector3d middle = shared.center();
  return MarkedWay{middle - translation / 2, middle + translation / 2,
                   interval_words(depth->lower, depth->upper)};
}

void add_gap(render::Scene& scene, const MarkedWay& gap, const render::Style& style) {
  const render::Rgba colour = style.of(kGapColour);
  outline(scene.list, {gap.from, gap.to}, colour, kWayWidth);
  for (const Vector3d& x : {gap.from, gap.to}) add_mark(scene.list, x, colour, 4, style.paper);
  write_beside(scene.list, (gap.from + gap.to) / 2, -kTextOff, gap.text, colour);
  scene.key.push_back({render::LegendItem::Mark::line, colour, "nearest points"});
}

void add_way_out(render::Scene& scene, const MarkedWay& way, int dim) {
  outline(scene.list, {way.from, way.to}, kWayOutColour, kWayWidth);
  const Vector3d along = (way.to - way.from).normalized();
  const Vector3d across = dim == 2 ? Vector3d::UnitZ().cross(along) : along.unitOrthogonal();
  add_barbs(scene.list, way, across, kWayOutColour);
  if (dim == 3) add_barbs(scene.list, way, along.cross(across), kWayOutColour);
  write_beside(scene.list, way.from, kTextOff, way.text, kWayOutColour);
  scene.key.push_back({render::LegendItem::Mark::line, kWayOutColour, "B leaves A this way"});
}

}  // namespace lrb::run
