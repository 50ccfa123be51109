#include "scenarios/frames/framing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <lrbscope/render/scene.hpp>

namespace lrb::run {
namespace {

/// Returns a subset of points with almost the same extent: the extreme ones in a few dozen directions.
std::vector<Eigen::Vector3d> extremes(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kTurns = 24, kRows = 7;
  std::vector<Eigen::Vector3d> out;
  if (points.empty()) return out;
  for (int row = 0; row < kRows; ++row) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double azimuth = 2 * std::numbers::pi * turn / kTurns;
      const double elevation = std::numbers::pi * (row - kRows / 2) / (kRows - 1);
      const Eigen::Vector3d d(std::cos(azimuth) * std::cos(elevation),
                              std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      out.push_back(*std::max_element(points.begin(), points.end(),
                                      [&](const auto& p, const auto& q) { return p.dot(d) < q.dot(d); }));
    }
  }
  return out;
}

/// Adds the corners of all intersecting faces: for coarse answers, which have no contact regions.
void add_contacts(const std::vector<const LrbRep*>& reps, const trace::Trace& trace,
                  std::vector<Eigen::Vector3d>& points) {
  for (std::size_t step = 0; step < trace.steps.size(); ++step)
    for (const trace::Event& e : trace.events_of(step)) {
      if (e.kind != EventKind::contact) continue;
      for (const VertexId v : reps[0]->face(reps[0]->face_of_simplex(e.simplex(Side::a))))
        points.push_back(trace.steps[step].pose_a.apply(reps[0]->vertices()[v]));
      for (const VertexId v : reps[1]->face(reps[1]->face_of_simplex(e.simplex(Side::b))))
        points.push_back(trace.steps[step].pose_b.apply(reps[1]->vertices()[v]));
    }
}

/// Returns the points that a body shows: all its wrappers, with displaced regions if exploded; or the
/// isolated regions, with a margin around them if the rest is shown as well.
std::vector<Eigen::Vector3d> shown_points(const LrbRep& rep, const std::vector<RegionId>& isolated,
                                          bool alone, const render::FrameSpec& spec) {
  std::vector<Eigen::Vector3d> out;
  if (alone) {
    for (const RegionId r : isolated)
      for (const FaceId face : rep.collector(r))
        for (const VertexId v : rep.face(face)) out.push_back(rep.vertices()[v]);
    if (!spec.ghost_rest || out.empty()) return out;
    constexpr double kAround = 0.5;  // of the regions' size, on each side
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& x : out) box.extend(x);
    const Eigen::Vector3d middle = box.center();
    for (Eigen::Vector3d& x : out) x = middle + (1 + kAround) * (x - middle);
    return out;
  }
  out = render::body_points(rep, Pose{});
  for (RegionId r = 0; spec.explode > 0 && r < rep.region_count(); ++r) {
    const Eigen::Vector3d way = render::exploded_way(rep, Pose{}, r, spec.explode);
    for (const FaceId face : rep.collector(r))
      for (const VertexId v : rep.face(face)) out.push_back(rep.vertices()[v] + way);
  }
  return out;
}

}  // namespace

Framing frame_sequence(const std::vector<const LrbRep*>& reps, const trace::Trace& trace,
                       const std::vector<CollideResult>& results, const render::FrameSpec& spec) {
  const bool regions_alone = !(spec.isolate[0].empty() && spec.isolate[1].empty());
  Framing f;
  f.dim = reps[0]->dim();
  for (std::size_t i = 0; i < reps.size(); ++i) {
    const std::vector<Eigen::Vector3d> body =
        extremes(shown_points(*reps[i], spec.isolate[i], regions_alone, spec));
    for (const trace::Step& step : trace.steps) {
      const Pose& pose = i == 0 ? step.pose_a : step.pose_b;
      for (const Eigen::Vector3d& p : body) f.points.push_back(pose.apply(p));
    }
  }
  if (trace.header.request.is_coarse()) add_contacts(reps, trace, f.contacts);
  for (const CollideResult& result : results)
    for (const Eigen::Vector3d& p : render::contact_points(result.regions)) f.contacts.push_back(p);
  return f;
}

}  // namespace lrb::run
