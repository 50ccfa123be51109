#pragma once
/// The shape of a tree over a body's simplices, lrbscope's or another engine's: the part needed to attribute
/// work to nodes and faces.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

/// A box in the body's frame, mesh units.
struct ShapeBox {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;  ///< half axes: from the centre to the centre of a side

  double area() const;
};

class TreeShape {
 public:
  TreeShape() = default;
  /// The shape of one of lrbscope's trees.
  explicit TreeShape(const ObbTree& tree);

  /// Adds a node, the root first; nodes are numbered in this order. Leaves have simplices; other nodes have
  /// children, which may be added later.
  void add(std::span<const std::uint32_t> children, std::span<const SimplexId> simplices,
           const ShapeBox& box);
  /// Links that a broken tree lost in finish().
  struct Faults {
    std::uint32_t links = 0;        ///< to a node that has a parent already, to the root, or to no node
    std::uint32_t unreachable = 0;  ///< nodes that the root does not reach
    bool any() const { return links + unreachable > 0; }
  };
  /// Computes depths and simplex counts after all nodes were added. If the nodes do not form a tree, each
  /// keeps its first parent, breadth first from the root; nodes that the root does not reach have the depth
  /// kNull and are not in from_root().
  Faults finish();

  std::size_t size() const { return boxes_.size(); }
  bool is_leaf(std::uint32_t node) const { return children(node).empty(); }
  std::span<const std::uint32_t> children(std::uint32_t node) const {
    return {children_.data() + first_child_[node], children_.data() + first_child_[node + 1]};
  }
  std::span<const SimplexId> simplices(std::uint32_t node) const {
    return {simplices_.data() + first_simplex_[node], simplices_.data() + first_simplex_[node + 1]};
  }
  const ShapeBox& box(std::uint32_t node) const { return boxes_[node]; }
  std::uint32_t depth(std::uint32_t node) const { return depth_[node]; }  ///< 0: the root; kNull: not reached
  /// Returns the number of simplices below a node.
  std::uint32_t beneath(std::uint32_t node) const { return beneath_[node]; }
  /// Returns the nodes, parents before children.
  const std::vector<std::uint32_t>& from_root() const { return order_; }

 private:
  void keep_children(const std::vector<char>& is_kept);

  std::vector<std::uint32_t> first_child_ = {0}, first_simplex_ = {0};
  std::vector<std::uint32_t> children_;
  std::vector<SimplexId> simplices_;
  std::vector<ShapeBox> boxes_;
  std::vector<std::uint32_t> depth_, beneath_, order_;
};

// Distribution of the tree traversal's work by tree node, node depth and face, from a trace's events at
// EventLevel::nodes and above.

/// Returns the tree that a traversal descends: the body's own, or that of a level of detail (walked = 1 + its
/// index). Throws InputError if the body has no such level.
const ObbTree& walked_tree(const LrbRep& rep, std::uint32_t walked);

/// The work at each node of a body's own tree. All arrays have size (nodes).
struct NodeCounts {
  std::vector<std::uint32_t> visits;     ///< pairs with the node
  std::vector<std::uint32_t> ended;      ///< visits in which no boxes overlap
  std::vector<std::uint32_t> box_tests;  ///< tests of boxes in all visits
};
/// Counts over traversals of the body itself; traversals of levels of detail are skipped. `tree` is that of
/// the body recorded as `side`. Throws InputError if an event names a node that the tree does not have.
NodeCounts count_nodes(const TreeShape& tree, Side side, std::span<const Event> events);

/// Returns, for each face (|F|), its share of the box tests of the nodes above it. Each node's tests are
/// divided evenly among the simplices below it, so that the sum over faces equals the sum over nodes.
std::vector<double> box_tests_by_face(const LrbRep& rep, const TreeShape& tree, const NodeCounts& counts);

/// The nodes of one depth of a body's tree, and the visits expected by the surface area heuristic.
struct DepthWork {
  std::uint32_t nodes = 0;
  /// Sum of the nodes' areas / the root's: expected number of them hit by a random line.
  double expected = 0;
  std::uint32_t nodes_visited = 0;  ///< distinct nodes
  std::uint64_t visits = 0, ended = 0, box_tests = 0;
};
/// Returns the work by depth, the root's first.
std::vector<DepthWork> work_by_depth(const TreeShape& tree, const NodeCounts& counts);

// The work of a run's queries as a nested chart: query, phase, deciding test. From a trace's events at
// EventLevel::nodes and above.

/// The work of one outcome in one phase, over all steps.
struct WorkOutcome {
  std::string_view phase;    ///< e.g. "walk of the bodies"
  std::string_view outcome;  ///< e.g. "boxes of nodes"; empty: the phase is not divided
  std::uint64_t events = 0;
  /// Number of tests of boxes, planes (one per face pair with overlapping boxes) and faces; of regions
  /// refined or coarsened, pairs sorted, points located, faces of separating wrappers, contact regions.
  std::uint64_t operations = 0;
  double seconds = 0;  ///< as WorkShare::seconds
};

struct WorkChart {
  static constexpr std::uint8_t kNone = 255;
  std::vector<WorkOutcome> outcomes;   ///< those that occurred, by phase, in the order of a query
  std::vector<std::uint8_t> of_event;  ///< (|events|) index of each event's outcome; kNone: none
};

/// Returns the chart's outcomes with their counts in one step, in the chart's order.
std::vector<WorkOutcome> outcomes_of_step(const Trace& trace, const WorkChart& chart, std::size_t step);

/// Returns the chart: the parts of work_shares(), with traversals of bodies and of levels of detail separate.
WorkChart work_chart(const Trace& trace);

// Cost of the parts of a query, from a trace's events at EventLevel::nodes and above.

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
  std::string_view name;  ///< snake_case; part of the file format
  std::string_view what;  ///< unit of `count`
  std::uint64_t events = 0, count = 0;
  std::uint64_t box_tests = 0;  ///< of pairs of nodes
  double seconds = 0;  ///< from the previous event to each of them, recording included; 0 on the event clock
};

/// Returns the parts of a run's queries, one for each WorkPart: traversal (pairs of inner nodes), leaves
/// (pairs of leaves), float_tests, shared_corner_tests, filter_tests and expansion_tests (face tests by the
/// deciding arithmetic), other_tests (of the paper's recursions), wrappers (refinements), sorting, relation,
/// separation, contact_geometry and cache_making (coherent queries).
std::vector<WorkShare> work_shares(const Trace& trace);

/// Returns the part that an event belongs to, or nullopt if it has no work of its own.
std::optional<WorkPart> work_part(const Event& e);
/// Returns the event's contribution to its part's `count`.
std::uint64_t work_count(const Event& e);

}  // namespace lrb::trace
