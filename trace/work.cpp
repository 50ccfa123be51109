#include <algorithm>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::trace {

const ObbTree& walked_tree(const LrbRep& rep, std::uint32_t walked) {
  if (walked == 0) return rep.tree();
  const std::span<const WrapperLevel> levels = rep.levels().all();
  if (walked > levels.size())
    throw InputError("body " + rep.name() + ": the trace visits its level " + std::to_string(walked - 1) +
                     ", but it has " + std::to_string(levels.size()) +
                     "; the trace is damaged; record it again");
  return levels[walked - 1].tree;
}

NodeCounts count_nodes(const TreeShape& tree, Side side, std::span<const Event> events) {
  const std::vector<std::uint32_t> none(tree.size());
  NodeCounts counts{none, none, none};
  // Node numbers of levels of detail refer to other trees: count the body's own traversal only.
  bool is_body = true;
  for (const Event& e : events) {
    if (e.kind == EventKind::begin && walks_trees(e.phase()))
      is_body = (side == Side::a ? e.phase_begin().walked_a : e.phase_begin().walked_b) == 0;
    if (e.kind != EventKind::node_pair || !is_body) continue;
    const payload::NodePair pair = e.node_pair();
    const std::uint32_t node = side == Side::a ? pair.a : pair.b;
    if (node >= tree.size())
      throw InputError("the trace visits node " + std::to_string(node) + " of " + std::string(name_of(side)) +
                       "'s tree, which has " + std::to_string(tree.size()) +
                       "; the trace is damaged; record it again");
    ++counts.visits[node];
    counts.ended[node] += pair.work.met == 0;
    counts.box_tests[node] += pair.work.box_tests;
  }
  return counts;
}

std::vector<double> box_tests_by_face(const LrbRep& rep, const TreeShape& tree, const NodeCounts& counts) {
  std::vector<double> out(rep.face_count());
  std::vector<double> share(tree.size());  // of the node and its ancestors, per simplex
  // Distribute each node's tests evenly over the simplices beneath it, as a prefix sum from the root:
  // O(nodes).
  for (const std::uint32_t node : tree.from_root()) {
    if (tree.beneath(node) == 0) continue;  // in a broken tree
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

TreeShape::Faults TreeShape::finish() {
  Faults faults;
  depth_.assign(size(), kNull);
  beneath_.assign(size(), 0);
  order_.clear();
  if (size() == 0) return faults;
  // Breadth-first order from the root. A link to a node that has been reached (by another parent, or along a
  // cycle) is left out, so that the remaining links form a tree.
  order_.push_back(0);
  depth_[0] = 0;
  std::vector<char> is_kept(children_.size(), 0);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::uint32_t n = order_[i];
    for (std::uint32_t k = first_child_[n]; k < first_child_[n + 1]; ++k) {
      const std::uint32_t child = children_[k];
      if (child >= size() || depth_[child] != kNull) {
        ++faults.links;
        continue;
      }
      is_kept[k] = 1;
      depth_[child] = depth_[n] + 1;
      order_.push_back(child);
    }
  }
  faults.unreachable = static_cast<std::uint32_t>(size() - order_.size());
  if (faults.any()) keep_children(is_kept);
  // In reverse order children come first: sum the simplices bottom up.
  for (auto i = order_.rbegin(); i != order_.rend(); ++i) {
    beneath_[*i] += static_cast<std::uint32_t>(simplices(*i).size());
    for (const std::uint32_t child : children(*i)) beneath_[*i] += beneath_[child];
  }
  return faults;
}

void TreeShape::keep_children(const std::vector<char>& is_kept) {
  std::vector<std::uint32_t> kept;
  std::uint32_t begin = 0;
  for (std::uint32_t n = 0; n < size(); ++n) {
    const std::uint32_t end = first_child_[n + 1];
    for (std::uint32_t k = begin; k < end; ++k)
      if (is_kept[k]) kept.push_back(children_[k]);
    begin = end;
    first_child_[n + 1] = static_cast<std::uint32_t>(kept.size());
  }
  children_ = std::move(kept);
}

namespace {

/// Names of a part of the work in files and charts.
struct PartRow {
  WorkPart part;
  std::string_view name;     ///< in files, snake_case
  std::string_view what;     ///< unit of WorkShare::count
  std::string_view phase;    ///< in the chart; empty: the current traversal
  std::string_view outcome;  ///< in the chart
};
constexpr auto kParts = std::to_array<PartRow>({
    {WorkPart::traversal, "traversal", "pairs of boxes that meet", "", "boxes of nodes"},
    {WorkPart::leaves, "leaves", "pairs of faces", "", "boxes and planes of faces"},
    {WorkPart::float_tests, "float_tests", "face tests", "", "face tests: floats"},
    {WorkPart::shared_corner_tests, "shared_corner_tests", "face tests", "", "face tests: shared corners"},
    {WorkPart::filter_tests, "filter_tests", "face tests", "", "face tests: filter"},
    {WorkPart::expansion_tests, "expansion_tests", "face tests", "", "face tests: expansions"},
    {WorkPart::other_tests, "other_tests", "face tests", "", "face tests"},
    {WorkPart::wrappers, "wrappers", "regions refined or taken back", "", "wrappers refined"},
    {WorkPart::sorting, "sorting", "pairs", "sorting", ""},
    {WorkPart::relation, "relation", "points located", "relation", ""},
    {WorkPart::separation, "separation", "faces of the wrappers", "separation", ""},
    {WorkPart::contact_geometry, "contact_geometry", "contact regions", "contact geometry", ""},
    {WorkPart::cache_making, "cache_making", "pairs kept", "cache making", "pairs kept"},
});

consteval bool is_in_enum_order() {
  for (std::size_t i = 0; i < kParts.size(); ++i)
    if (static_cast<std::size_t>(kParts[i].part) != i) return false;
  return true;
}
static_assert(is_in_enum_order());

bool belongs_to_walk(const PartRow& row) {
  return row.phase.empty();
}

WorkPart part_of_test(TestedBy by) {
  switch (by) {
    case TestedBy::unreported:
      return WorkPart::other_tests;
    case TestedBy::floats:
      return WorkPart::float_tests;
    case TestedBy::shared_corners:
      return WorkPart::shared_corner_tests;
    case TestedBy::filter:
      return WorkPart::filter_tests;
    case TestedBy::expansions:
      return WorkPart::expansion_tests;
  }
  return WorkPart::other_tests;
}

std::optional<WorkPart> part_of_phase(Phase phase) {
  switch (phase) {
    case Phase::walk:
      return {};
    case Phase::sort:
      return WorkPart::sorting;
    case Phase::relation:
      return WorkPart::relation;
    case Phase::separation:
      return WorkPart::separation;
    case Phase::contacts:
      return WorkPart::contact_geometry;
    case Phase::cache:
      return WorkPart::cache_making;
    case Phase::kept:    // its regions count as work of the wrappers
    case Phase::cached:  // its tests count as work of the other parts
      return {};
  }
  return {};
}

}  // namespace

std::optional<WorkPart> work_part(const Event& e) {
  switch (e.kind) {
    case EventKind::node_pair:
      return e.node_end().step == NodeStep::leaves ? WorkPart::leaves : WorkPart::traversal;
    case EventKind::face_test:
      return part_of_test(e.tested_by());
    case EventKind::refine:
    case EventKind::coarsen:
      return WorkPart::wrappers;
    case EventKind::point:
      return WorkPart::relation;
    case EventKind::end:
      return part_of_phase(e.phase());
    case EventKind::plane_test:
      return WorkPart::leaves;
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

std::uint64_t work_count(const Event& e) {
  switch (e.kind) {
    case EventKind::node_pair:
      return e.work().met;
    case EventKind::end:
      return e.phase_end().count;
    case EventKind::point:  // their number is in the event that ends the phase
    case EventKind::plane_test:
      return 0;
    default:
      return 1;
  }
}

namespace {

/// Returns the duration of an event in seconds: events are recorded when their work is done, so this is the
/// time since the previous event. 0 on the event clock.
double elapsed_s(const Trace& trace, EventId event) {
  constexpr double kNanosecond = 1e-9;
  if (trace.wall_ns.empty()) return 0;
  return kNanosecond * static_cast<double>(trace.wall_ns[event] - trace.wall_ns[event - 1]);
}

}  // namespace

std::vector<WorkShare> work_shares(const Trace& trace) {
  std::vector<WorkShare> out;
  for (const PartRow& row : kParts) out.push_back({row.name, row.what});
  for (EventId i = 0; i < trace.events.size(); ++i) {
    const Event& e = trace.events[i];
    const std::optional<WorkPart> part = work_part(e);
    if (!part) continue;
    WorkShare& share = out[static_cast<std::size_t>(*part)];
    ++share.events;
    share.count += work_count(e);
    if (e.kind == EventKind::node_pair) share.box_tests += e.work().box_tests;
    share.seconds += elapsed_s(trace, i);
  }
  return out;
}

namespace {

/// The current tree traversal.
enum class Walk : std::uint8_t { bodies, levels, recursion, cache, cached };
constexpr auto enum_names(Walk) {
  return std::array<EnumName<Walk>, 5>{{{Walk::bodies, "walk of the bodies"},
                                        {Walk::levels, "walk of levels"},
                                        {Walk::recursion, "recursion"},
                                        {Walk::cache, "cache making"},
                                        {Walk::cached, "cached pairs"}}};
}

/// Tracks the current traversal.
class WalkFollower {
 public:
  explicit WalkFollower(const Trace& trace)
      : walk_(trace.header.request.recursion == Recursion::complete ? Walk::bodies : Walk::recursion) {}

  void follow(const Event& e) {
    if (e.kind != EventKind::begin) return;
    const auto [phase, walked_a, walked_b] = e.phase_begin();
    if (phase == Phase::walk) walk_ = walked_a > 0 || walked_b > 0 ? Walk::levels : Walk::bodies;
    if (phase == Phase::cache) walk_ = Walk::cache;
    if (phase == Phase::cached || phase == Phase::kept) walk_ = Walk::cached;
  }
  Walk walk() const { return walk_; }

 private:
  Walk walk_;
};

/// The chart's cells, one per traversal and part: by traversal, parts in order.
constexpr std::size_t kCells = kEnumNames<Walk>.size() * kParts.size();
Walk walk_of_cell(std::size_t cell) {
  return static_cast<Walk>(cell / kParts.size());
}
const PartRow& part_of_cell(std::size_t cell) {
  return kParts[cell % kParts.size()];
}
/// Returns the cell of a part's work. Work outside of traversals uses the cells of the first one.
std::size_t cell_of(WorkPart part, Walk walk) {
  const auto column = static_cast<std::size_t>(part);
  const std::size_t row = belongs_to_walk(kParts[column]) ? static_cast<std::size_t>(walk) : 0;
  return row * kParts.size() + column;
}

std::uint64_t operations_of(const Event& e) {
  if (e.kind != EventKind::node_pair) return work_count(e);
  return std::uint64_t{e.work().box_tests} +
         (e.node_end().step == NodeStep::leaves ? std::uint64_t{e.work().met} : 0);
}

}  // namespace

std::vector<WorkOutcome> outcomes_of_step(const Trace& trace, const WorkChart& chart, std::size_t step) {
  std::vector<WorkOutcome> out = chart.outcomes;
  for (WorkOutcome& o : out) o.events = o.operations = 0, o.seconds = 0;
  const EventId first = trace.steps[step].first_event;
  const auto end = first + static_cast<EventId>(trace.events_of(step).size());
  for (EventId i = first; i < end; ++i) {
    if (chart.of_event[i] == WorkChart::kNone) continue;
    WorkOutcome& o = out[chart.of_event[i]];
    ++o.events;
    o.operations += operations_of(trace.events[i]);
    o.seconds += elapsed_s(trace, i);
  }
  return out;
}

WorkChart work_chart(const Trace& trace) {
  // Step 1: one cell per traversal and kind of work.
  std::vector<WorkOutcome> all(kCells);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const PartRow& part = part_of_cell(i);
    all[i].phase = belongs_to_walk(part) ? name_of(walk_of_cell(i)) : part.phase;
    // Another engine compares the boxes of leaves, and no planes.
    const bool theirs = part.part == WorkPart::leaves && !trace.header.engine.empty();
    all[i].outcome = theirs ? "boxes of leaves" : part.outcome;
  }
  WorkChart out;
  out.of_event.assign(trace.events.size(), WorkChart::kNone);
  // Step 2: attribute each event to a cell.
  WalkFollower follower(trace);
  for (EventId i = 0; i < trace.events.size(); ++i) {
    const Event& e = trace.events[i];
    follower.follow(e);
    const std::optional<WorkPart> part = work_part(e);
    if (!part) continue;
    const std::size_t at = cell_of(*part, follower.walk());
    out.of_event[i] = static_cast<std::uint8_t>(at);
    ++all[at].events;
    all[at].operations += operations_of(e);
    all[at].seconds += elapsed_s(trace, i);
  }
  // Step 3: drop empty cells; traversals come before the other phases.
  std::vector<std::size_t> order;
  for (const bool of_walk : {true, false})
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].events > 0 && belongs_to_walk(part_of_cell(i)) == of_walk) order.push_back(i);
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
