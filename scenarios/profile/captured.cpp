#include "scenarios/profile/captured.hpp"

#include <string>

#include <lrbscope/error.hpp>

namespace lrb::profile {
namespace {

capture::Mesh mesh_of(const LrbRep& rep) {
  capture::Mesh out;
  out.name = rep.name();
  out.vertices.assign(rep.vertices().begin(), rep.vertices().end());
  for (std::uint32_t s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId corners[3] = {0, 0, 0};
    rep.simplex(SimplexId(s), corners);
    out.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  return out;
}

capture::Tree tree_of(const trace::TreeShape& shape, std::uint32_t side) {
  capture::Tree out;
  out.id = side + 1;
  out.mesh = side;
  out.volume = capture::VolumeKind::obb;
  out.first_child = out.first_triangle = {0};
  for (std::uint32_t n = 0; n < shape.size(); ++n) {
    for (const std::uint32_t child : shape.children(n)) out.child.push_back(child);
    for (const SimplexId s : shape.simplices(n)) out.triangle.push_back(s);
    out.first_child.push_back(static_cast<std::uint32_t>(out.child.size()));
    out.first_triangle.push_back(static_cast<std::uint32_t>(out.triangle.size()));
    const trace::ShapeBox& box = shape.box(n);
    for (const Eigen::Vector3d& v : {box.centre, box.half[0], box.half[1], box.half[2]})
      out.volumes.insert(out.volumes.end(), v.data(), v.data() + 3);
  }
  return out;
}

/// Returns the events of one step.
std::vector<capture::Event> events_of(std::span<const trace::Event> events) {
  std::vector<capture::Event> out;
  bool is_body = true;  // else a level of detail, whose nodes have other numbers
  for (const trace::Event& e : events) {
    if (e.kind == lrb::EventKind::begin && walks_trees(e.phase())) {
      const trace::payload::PhaseBegin begin = e.phase_begin();
      is_body = begin.walked_a == 0 && begin.walked_b == 0;
    }
    if (!is_body) continue;
    if (e.kind == lrb::EventKind::node_pair) {
      const trace::payload::NodePair pair = e.node_pair();
      out.push_back({.a = pair.a,
                     .b = pair.b,
                     .kind = capture::EventKind::nodes,
                     .met = pair.work.met,
                     .tests = pair.work.box_tests});
    } else if (e.kind == lrb::EventKind::face_test) {
      const trace::payload::FaceTest test = e.face_test();
      out.push_back({.a = test.a,
                     .b = test.b,
                     .kind = capture::EventKind::triangles,
                     .met = static_cast<std::uint8_t>(test.meet != exact::Meet::disjoint)});
    }
  }
  return out;
}

}  // namespace

capture::Capture captured(const run::Recording& recording) {
  const trace::Trace& trace = recording.trace;
  const std::string who = trace.header.scenario.empty() ? "the run" : trace.header.scenario;
  if (recording.bodies.size() != 2 || recording.bodies[0].rep.dim() != 3)
    throw InputError(who + ": expected a run of two 3D bodies, found another; record two 3D bodies");
  if (recording.trees.size() != 2)
    throw InputError(who + ": expected pairs of tree nodes, found none; record it with --events nodes");
  capture::Capture out;
  out.engine = trace.header.engine.empty() ? "lrbscope " + trace.header.lrbscope : trace.header.engine;
  for (std::uint32_t side = 0; side < 2; ++side) {
    out.meshes.push_back(mesh_of(recording.bodies[side].rep));
    out.trees.push_back(tree_of(recording.trees[side], side));
  }
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const trace::Step& step = trace.steps[i];
    capture::Query q;
    q.number = static_cast<std::uint32_t>(i + 1);
    q.kind = trace.header.request.mode == Mode::all_pairs ? capture::QueryKind::all_pairs
                                                          : capture::QueryKind::any;
    q.trees = {0, 1};
    q.poses = {step.pose_a, step.pose_b};
    q.ended = true;
    q.verdict = step.result.pair_count > 0 ? capture::Verdict::intersecting : capture::Verdict::separate;
    q.pairs = step.result.pair_count;
    q.events = events_of(trace.events_of(i));
    q.parts = {{0, 0, q.events.size()}};
    // A trace that reached its limit lacks events of its last steps.
    q.events_seen = q.events.size() + (step.events_seen - trace.events_of(i).size());
    out.queries.push_back(std::move(q));
  }
  return out;
}

}  // namespace lrb::profile
