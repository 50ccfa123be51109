#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::trace {

const ObbTree& walked_tree(const LrbRep& rep, std::uint32_t walked) {
  if (walked == 0) return rep.tree();
  const std::span<const WrapperLevel> levels = rep.levels().all();
  if (walked > levels.size())
    throw InputError("body " + rep.name() + ": the trace walks its level " + std::to_string(walked - 1) +
                     ", but it has " + std::to_string(levels.size()) +
                     "; the trace is damaged: record it again");
  return levels[walked - 1].tree;
}

NodeCounts count_nodes(const TreeShape& tree, Side side, std::span<const Event> events) {
  const std::vector<std::uint32_t> none(tree.size());
  NodeCounts counts{none, none, none};
  // Node numbers of levels of detail refer to other trees: count the body's own traversal only.
  bool is_body = true;
  for (const Event& e : events) {
    if (e.kind == EventKind::begin && walks_trees(e.phase()))
      is_body = (side == Side::a ? e.depth_a : e.depth_b) == 0;
    if (e.kind != EventKind::node_pair || !is_body) continue;
    const std::uint32_t node = side == Side::a ? e.a : e.b;
    if (node >= tree.size())
      throw InputError("the trace visits node " + std::to_string(node) + " of " + std::string(name_of(side)) +
                       "'s tree, which has " + std::to_string(tree.size()) +
                       "; the trace is damaged: record it again");
    ++counts.visits[node];
    counts.ended[node] += e.work().met == 0;
    counts.box_tests[node] += e.work().box_tests;
  }
  return counts;
}

std::vector<double> box_tests_by_face(const LrbRep& rep, const TreeShape& tree, const NodeCounts& counts) {
  std::vector<double> out(rep.face_count());
  std::vector<double> share(tree.size());  // of the node and those above, for each simplex
  // Distribute each node's tests evenly over the simplices beneath it, as a prefix sum from the root:
  // O(nodes).
  for (const std::uint32_t node : tree.from_root()) {
    share[node] += static_cast<double>(counts.box_tests[node]) / tree.beneath(node);
    for (const std::uint32_t child : tree.children(node)) share[child] = share[node];
    for (const SimplexId s : tree.simplices(node)) out[rep.face_of_simplex(s)] += share[node];
  }
  return out;
}

std::vector<DepthWork> work_by_depth(const TreeShape& tree, const NodeCounts& counts) {
  std::vector<DepthWork> out;
  const double root = tree.size() > 0 ? tree.box(0).area() : 0;
  for (const std::uint32_t n : tree.from_root()) {
    if (tree.depth(n) >= out.size()) out.resize(tree.depth(n) + 1);
    DepthWork& w = out[tree.depth(n)];
    ++w.nodes;
    // Surface area heuristic: the probability that a line through the root also hits the node.
    w.expected += root > 0 ? tree.box(n).area() / root : 0;
    w.nodes_visited += counts.visits[n] > 0;
    w.visits += counts.visits[n];
    w.ended += counts.ended[n];
    w.box_tests += counts.box_tests[n];
  }
  return out;
}

double ShapeBox::area() const {
  constexpr int kSides = 2, kSquareOfHalf = 4;
  // Three pairs of sides; each is a parallelogram spanned by two full axes, twice the half axes.
  return kSides * kSquareOfHalf *
         (half[0].cross(half[1]).norm() + half[1].cross(half[2]).norm() + half[2].cross(half[0]).norm());
}

TreeShape::TreeShape(const ObbTree& tree) {
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const TreeNode& n = tree.nodes()[i];
    const WorldBox box = box_of(tree, i, kWhole, Pose{});
    if (n.is_leaf) {
      add({}, {tree.blocks()[n.first].simplex, n.count}, {box.centre, box.half});
    } else {
      std::array<std::uint32_t, kTreeWidth> children{};
      for (std::uint32_t k = 0; k < n.count; ++k) children[k] = n.first + k;
      add({children.data(), n.count}, {}, {box.centre, box.half});
    }
  }
  finish();
}

void TreeShape::add(std::span<const std::uint32_t> children, std::span<const SimplexId> simplices,
                    const ShapeBox& box) {
  children_.insert(children_.end(), children.begin(), children.end());
  simplices_.insert(simplices_.end(), simplices.begin(), simplices.end());
  first_child_.push_back(static_cast<std::uint32_t>(children_.size()));
  first_simplex_.push_back(static_cast<std::uint32_t>(simplices_.size()));
  boxes_.push_back(box);
}

void TreeShape::finish() {
  depth_.assign(size(), 0);
  beneath_.assign(size(), 0);
  order_.clear();
  if (size() > 0) order_.push_back(0);
  // Breadth-first order from the root. More nodes than exist means a node with two parents, or a cycle.
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (const std::uint32_t child : children(order_[i])) {
      if (child == 0 || child >= size() || order_.size() >= size())
        throw std::invalid_argument("TreeShape: the nodes are no tree");
      depth_[child] = depth_[order_[i]] + 1;
      order_.push_back(child);
    }
  if (order_.size() != size())
    throw std::invalid_argument("TreeShape: there are nodes that no other leads to");
  // In reverse order children come first: sum the simplices bottom up.
  for (auto i = order_.rbegin(); i != order_.rend(); ++i) {
    beneath_[*i] += static_cast<std::uint32_t>(simplices(*i).size());
    for (const std::uint32_t child : children(*i)) beneath_[*i] += beneath_[child];
  }
}

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

namespace {

/// How the chart names the parts of work_shares(), in their order; an empty phase: that of the walk.
struct PartWords {
  std::string_view phase, outcome;
};
constexpr std::array<PartWords, 13> kPartWords = {{{"", "boxes of nodes"},
                                                   {"", "boxes and planes of faces"},
                                                   {"", "face tests: floats"},
                                                   {"", "face tests: shared corners"},
                                                   {"", "face tests: filter"},
                                                   {"", "face tests: expansions"},
                                                   {"", "face tests"},
                                                   {"", "wrappers refined"},
                                                   {"sorting", ""},
                                                   {"relation", ""},
                                                   {"separation", ""},
                                                   {"contact geometry", ""},
                                                   {"cache making", "pairs kept"}}};
constexpr std::size_t kWalks = 5;
constexpr std::array<std::string_view, kWalks> kWalkWords = {"walk of the bodies", "walk of levels",
                                                             "recursion", "cache making", "cached pairs"};

/// Follows which walk is going on.
class WalkFollower {
 public:
  explicit WalkFollower(const Trace& trace)
      : walk_(trace.header.request.recursion == Recursion::complete ? 0 : 2) {}

  void see(const Event& e) {
    if (e.kind != EventKind::begin) return;
    if (e.phase() == Phase::walk) walk_ = e.depth_a > 0 || e.depth_b > 0 ? 1 : 0;
    if (e.phase() == Phase::cache) walk_ = 3;
    if (e.phase() == Phase::cached || e.phase() == Phase::kept) walk_ = 4;
  }
  std::size_t walk() const { return walk_; }

 private:
  std::size_t walk_;
};

std::uint64_t operations_of(const Event& e) {
  if (e.kind != EventKind::node_pair) return work_count(e);
  return std::uint64_t{e.work().box_tests} +
         (e.node_end().step == NodeStep::leaves ? std::uint64_t{e.work().met} : 0);
}

}  // namespace

std::vector<WorkOutcome> outcomes_of_step(const Trace& trace, const WorkChart& chart, std::size_t step) {
  constexpr double kNanosecond = 1e-9;
  std::vector<WorkOutcome> out = chart.outcomes;
  for (WorkOutcome& o : out) o.events = o.operations = 0, o.seconds = 0;
  const EventId first = trace.steps[step].first_event;
  const auto end = first + static_cast<EventId>(trace.events_of(step).size());
  for (EventId i = first; i < end; ++i) {
    if (chart.of_event[i] == WorkChart::kNone) continue;
    WorkOutcome& o = out[chart.of_event[i]];
    ++o.events;
    o.operations += operations_of(trace.events[i]);
    if (!trace.wall_ns.empty())
      o.seconds += kNanosecond * static_cast<double>(trace.wall_ns[i] - trace.wall_ns[i - 1]);
  }
  return out;
}

WorkChart work_chart(const Trace& trace) {
  constexpr std::size_t kParts = kPartWords.size();
  constexpr double kNanosecond = 1e-9;
  // Step 1: one cell for each traversal and kind of work.
  std::vector<WorkOutcome> all(kWalks * kParts);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PartWords& words = kPartWords[i % kParts];
    all[i].phase = words.phase.empty() ? kWalkWords[i / kParts] : words.phase;
    all[i].outcome = words.outcome;
  }
  WorkChart out;
  out.of_event.assign(trace.events.size(), WorkChart::kNone);
  // Step 2: attribute each event to a cell. Work outside traversals uses the first row.
  WalkFollower follower(trace);
  for (EventId i = 0; i < trace.events.size(); ++i) {
    const Event& e = trace.events[i];
    follower.see(e);
    const std::optional<std::size_t> part = work_part(e);
    if (!part) continue;
    const bool of_walk = kPartWords[*part].phase.empty();
    const std::size_t at = (of_walk ? follower.walk() : 0) * kParts + *part;
    out.of_event[i] = static_cast<std::uint8_t>(at);
    ++all[at].events;
    all[at].operations += operations_of(e);
    if (!trace.wall_ns.empty())
      all[at].seconds += kNanosecond * static_cast<double>(trace.wall_ns[i] - trace.wall_ns[i - 1]);
  }
  // Step 3: drop empty cells, with traversals before the other phases.
  std::vector<std::size_t> order;
  for (const bool of_walk : {true, false})
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].events > 0 && kPartWords[i % kParts].phase.empty() == of_walk) order.push_back(i);
  // Step 4: renumber the events' cells accordingly.
  std::vector<std::uint8_t> place(all.size(), WorkChart::kNone);
  for (const std::size_t i : order) {
    place[i] = static_cast<std::uint8_t>(out.outcomes.size());
    out.outcomes.push_back(all[i]);
  }
  for (std::uint8_t& of : out.of_event)
    if (of != WorkChart::kNone) of = place[of];
  return out;
}

}  // namespace lrb::trace
