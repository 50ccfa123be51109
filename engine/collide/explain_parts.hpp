#pragma once
/// What explain_pair() and explain_walk() share.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "engine/collide/tree_query.hpp"
#include <lrbscope/explain.hpp>

namespace lrb {

/// Begins a query of two bodies. Throws InputError in the same cases as collide().
inline void begin(QueryContext& ctx, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                  const Pose& pose_b) {
  check_query(a, pose_a, b, pose_b);
  ctx[Side::a].begin(a, pose_a, WrapperMode::regularised);
  ctx[Side::b].begin(b, pose_b, WrapperMode::regularised);
}

/// Runs the dual traversal of two trees one pair of nodes at a time.
class Stepper {
 public:
  explicit Stepper(QueryContext& ctx) : ctx_(ctx), k_(start_kernel(ctx, kCapacity)) {}

  /// The outcome of one pair of nodes: pairs of children, or candidate pairs of simplices.
  struct Outcome {
    std::vector<NodePair> children;
    std::vector<Candidate> candidates;
    std::uint64_t face_pairs;  ///< pairs of faces whose boxes overlap
    bool parts_whole;          ///< the nodes' own boxes are disjoint: nothing in them was compared
  };

  Outcome step(const NodePair& pair) {
    // Make this pair the only one on the stack, and stop the kernel after it.
    start_at(k_, pair);
    k_.out_size = k_.rejected_nodes_size = 0;
    k_.rejected_nodes = rejected_nodes_.data();
    k_.max_node_pairs = k_.node_pairs + 1;
    const std::uint64_t before = k_.prefilter_tests;
    run_tree_kernel(k_);
    return {{k_.stack, k_.stack + k_.stack_size},
            {k_.out, k_.out + k_.out_size},
            k_.prefilter_tests - before,
            k_.rejected_nodes_size != 0};
  }

  bool is_leaf(Side side, std::uint32_t node) const { return tree(side).nodes()[node].is_leaf != 0; }
  const ObbTree& tree(Side side) const { return ctx_[side].tree(); }

 private:
  static constexpr std::size_t kCapacity = 128;

  QueryContext& ctx_;
  TreeKernel k_;
  std::array<NodePair, 1> rejected_nodes_;
};

using Corners = std::array<const double*, 3>;

inline Eigen::Vector3d point(const double* x) {
  return {x[0], x[1], x[2]};
}

/// The closest points of two simplices.
struct NearPoints {
  Eigen::Vector3d a, b;
  double distance_sq = std::numeric_limits<double>::infinity();

  void add(const Eigen::Vector3d& of_a, const Eigen::Vector3d& of_b) {
    const double d = (of_a - of_b).squaredNorm();
    if (d < distance_sq) a = of_a, b = of_b, distance_sq = d;
  }
};

/// Returns the closest points of two simplices, in double.
NearPoints nearest_points(int dim, const Corners& a, const Corners& b);

}  // namespace lrb
