#include "trace/work_shares.hpp"

#include <array>
#include <optional>

namespace lrb::trace {

namespace {

enum class Part : std::uint8_t {
  traversal,
  leaves,
  float_tests,
  shared_corner_tests,
  filter_tests,
  expansion_tests,
  other_tests,
  wrappers,
  sorting,
  relation,
  separation,
  contact_geometry,
  cache,
};
constexpr std::array<WorkShare, 13> kParts = {{{"traversal", "pairs of boxes that meet"},
                                               {"leaves", "pairs of faces"},
                                               {"float_tests", "face tests"},
                                               {"shared_corner_tests", "face tests"},
                                               {"filter_tests", "face tests"},
                                               {"expansion_tests", "face tests"},
                                               {"other_tests", "face tests"},
                                               {"wrappers", "regions refined or taken back"},
                                               {"sorting", "pairs"},
                                               {"relation", "points located"},
                                               {"separation", "faces of the wrappers"},
                                               {"contact_geometry", "contact regions"},
                                               {"cache_making", "pairs kept"}}};

Part part_of_test(TestedBy by) {
  switch (by) {
    case TestedBy::untold:
      return Part::other_tests;
    case TestedBy::floats:
      return Part::float_tests;
    case TestedBy::shared_corners:
      return Part::shared_corner_tests;
    case TestedBy::filter:
      return Part::filter_tests;
    case TestedBy::expansions:
      return Part::expansion_tests;
  }
  return Part::other_tests;
}

std::optional<Part> part_of_phase(Phase phase) {
  switch (phase) {
    case Phase::walk:
      return {};
    case Phase::sort:
      return Part::sorting;
    case Phase::relation:
      return Part::relation;
    case Phase::separation:
      return Part::separation;
    case Phase::contacts:
      return Part::contact_geometry;
    case Phase::cache:
      return Part::cache;
    case Phase::kept:    // its regions are counted with the wrappers'
    case Phase::cached:  // its tests are counted with the others
      return {};
  }
  return {};
}

std::optional<Part> part_of(const Event& e) {
  switch (e.kind) {
    case EventKind::node_pair:
      return e.node_end().step == NodeStep::leaves ? Part::leaves : Part::traversal;
    case EventKind::face_test:
      return part_of_test(e.tested_by());
    case EventKind::refine:
    case EventKind::coarsen:
      return Part::wrappers;
    case EventKind::point:
      return Part::relation;
    case EventKind::end:
      return part_of_phase(e.phase());
    case EventKind::plane_test:
      return Part::leaves;
    case EventKind::step:
    case EventKind::contact:
    case EventKind::result:
    case EventKind::begin:
    case EventKind::pass:
    case EventKind::patch:
    case EventKind::cap:
    case EventKind::region:
    case EventKind::merged:
    case EventKind::pass_end:
    case EventKind::closed:
      return {};
  }
  return {};
}

}  // namespace

std::uint64_t work_count(const Event& e) {
  switch (e.kind) {
    case EventKind::node_pair:
      return e.work().met;
    case EventKind::end:
      return e.b;
    case EventKind::point:  // the phase's end has their number
    case EventKind::plane_test:
      return 0;
    default:
      return 1;
  }
}

std::optional<std::size_t> work_part(const Event& e) {
  const std::optional<Part> part = part_of(e);
  if (!part) return {};
  return static_cast<std::size_t>(*part);
}

std::vector<WorkShare> work_shares(const Trace& trace) {
  std::vector<WorkShare> out(kParts.begin(), kParts.end());
  constexpr double kNanosecond = 1e-9;
  for (EventId i = 0; i < trace.events.size(); ++i) {
    const Event& e = trace.events[i];
    const std::optional<Part> part = part_of(e);
    if (!part) continue;
    WorkShare& share = out[static_cast<std::size_t>(*part)];
    ++share.events;
    share.count += work_count(e);
    if (e.kind == EventKind::node_pair) share.box_tests += e.work().box_tests;
    // An event is recorded when its work is done, so its time is the difference to the event before.
    if (!trace.wall_ns.empty())
      share.seconds += kNanosecond * static_cast<double>(trace.wall_ns[i] - trace.wall_ns[i - 1]);
  }
  return out;
}

}  // namespace lrb::trace
