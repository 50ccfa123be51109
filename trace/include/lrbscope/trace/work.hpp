#pragma once
/// The shape of a tree over a body's simplices, ours or another engine's: all that is needed to say where
/// work went.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

/// A box in the body's frame, mesh's unit.
struct ShapeBox {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;  ///< from the centre to the middle of a side

  double area() const;
};

class TreeShape {
 public:
  TreeShape() = default;
  /// The shape of one of our trees.
  explicit TreeShape(const ObbTree& tree);

  /// Adds a node, the root first; its number is that of nodes before it. Leaves have simplices, all others
  /// children, which may be added later.
  void add(std::span<const std::uint32_t> children, std::span<const SimplexId> simplices,
           const ShapeBox& box);
  /// Finds depths and what lies beneath, when all nodes are there. Throws std::invalid_argument if they are
  /// no tree.
  void finish();

  std::size_t size() const { return boxes_.size(); }
  bool is_leaf(std::uint32_t node) const { return children(node).empty(); }
  std::span<const std::uint32_t> children(std::uint32_t node) const {
    return {children_.data() + first_child_[node], children_.data() + first_child_[node + 1]};
  }
  std::span<const SimplexId> simplices(std::uint32_t node) const {
    return {simplices_.data() + first_simplex_[node], simplices_.data() + first_simplex_[node + 1]};
  }
  const ShapeBox& box(std::uint32_t node) const { return boxes_[node]; }
  std::uint32_t depth(std::uint32_t node) const { return depth_[node]; }  ///< 0: the root
  /// Returns the number of simplices beneath a node.
  std::uint32_t beneath(std::uint32_t node) const { return beneath_[node]; }
  /// Returns the nodes, parents before children.
  const std::vector<std::uint32_t>& from_root() const { return order_; }

 private:
  std::vector<std::uint32_t> first_child_ = {0}, first_simplex_ = {0};
  std::vector<std::uint32_t> children_;
  std::vector<SimplexId> simplices_;
  std::vector<ShapeBox> boxes_;
  std::vector<std::uint32_t> depth_, beneath_, order_;
};

// Where the work of the tree walk went, from a trace's events from EventLevel::nodes on: by node of a tree,
// by depth of nodes, and by face.

/// Returns the tree that a walk descends of a body: its own, or that of a level (walked = 1 + its index).
/// Throws InputError if the body has no such level.
const ObbTree& walked_tree(const LrbRep& rep, std::uint32_t walked);

/// The work at each node of a body's own tree. All (nodes).
struct NodeCounts {
  std::vector<std::uint32_t> visits;     ///< pairs that the node was in
  std::vector<std::uint32_t> ended;      ///< those of them of which no two boxes met
  std::vector<std::uint32_t> box_tests;  ///< of these pairs
};
/// Counts over walks of the body itself; walks of levels are left out. `tree` is that of the body that was
/// recorded as `side`. Throws InputError if an event names a node that the tree does not have.
NodeCounts count_nodes(const TreeShape& tree, Side side, std::span<const Event> events);

/// Returns, for each face (|F|), the box tests of the nodes above it: each node's are shared evenly by the
/// simplices beneath it, so that the sum over all faces is that over all nodes.
std::vector<double> box_tests_by_face(const LrbRep& rep, const TreeShape& tree, const NodeCounts& counts);

/// The nodes of one depth of a body's tree, beside what the surface area heuristic expects.
struct DepthWork {
  std::uint32_t nodes = 0;
  double expected = 0;  ///< sum of the nodes' areas / the root's: how many of them a random line meets
  std::uint32_t nodes_visited = 0;  ///< different ones
  std::uint64_t visits = 0, ended = 0, box_tests = 0;
};
/// Returns the work by depth, the root's first.
std::vector<DepthWork> work_by_depth(const TreeShape& tree, const NodeCounts& counts);

// The work of a run's queries as a chart of nested parts shows it: query, phase, what decided. From a
// trace's events from EventLevel::nodes on.

/// What one thing decided in one phase, over all steps.
struct WorkOutcome {
  std::string_view phase;    ///< such as "walk of the bodies"
  std::string_view outcome;  ///< such as "boxes of nodes"; empty: the phase is not divided
  std::uint64_t events = 0;
  /// Tests of boxes, of planes (one for each pair of faces whose boxes meet) and of faces; regions refined or
  /// taken back, pairs sorted, points located, faces of separating wrappers, contact regions.
  std::uint64_t operations = 0;
  double seconds = 0;  ///< as WorkShare::seconds
};

struct WorkChart {
  static constexpr std::uint8_t kNone = 255;
  std::vector<WorkOutcome> outcomes;   ///< those that came, by phase, in the order of a query
  std::vector<std::uint8_t> of_event;  ///< (|events|) index of each event's; kNone: it has none
};

/// Returns the chart's outcomes with what they count in one step, in the chart's order.
std::vector<WorkOutcome> outcomes_of_step(const Trace& trace, const WorkChart& chart, std::size_t step);

/// Returns the chart: the parts of work_shares(), with walks of bodies and of levels told apart.
WorkChart work_chart(const Trace& trace);

// What the parts of a query cost, from a trace's events from EventLevel::nodes on.

/// A part of a query's work, in the order of a query.
enum class WorkPart : std::uint8_t {
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
  cache_making,
};

struct WorkShare {
  std::string_view name;  ///< snake_case, fixed: files use it
  std::string_view what;  ///< what `count` counts
  std::uint64_t events = 0, count = 0;
  std::uint64_t box_tests = 0;  ///< of pairs of nodes
  double seconds = 0;  ///< from the event before to each of them, recording included; 0 on the event clock
};

/// Returns the parts of the queries of a run, one for each WorkPart: traversal (pairs of inner nodes),
/// leaves (pairs of leaves), float_tests, shared_corner_tests, filter_tests and expansion_tests (face tests
/// by what decided them), other_tests (those of the paper's recursions), wrappers (refinements), sorting,
/// relation, separation, contact_geometry and cache_making (coherent queries).
std::vector<WorkShare> work_shares(const Trace& trace);

/// Returns which of these parts an event belongs to; nullopt if it takes no work of its own.
std::optional<WorkPart> work_part(const Event& e);
/// Returns what an event adds to its part's `count`.
std::uint64_t work_count(const Event& e);

}  // namespace lrb::trace
