#pragma once
/// The traversal of two trees for a distance, in double: for poses that are not rotations, and for distant
/// bodies. Slower than the float kernel.

#include <cstdint>
#include <vector>

#include "engine/distance/distance_context.hpp"
#include "engine/distance/nearest_pairs.hpp"

namespace lrb {

/// Traverses the trees of the bodies of `ctx` and measures the pairs of simplices that may be the closest.
class WorldWalk {
 public:
  WorldWalk(QueryContext& ctx, NearestPairs& found);

  /// Returns true if it was completed, or the request is answered; false after `max_steps` steps (0: no
  /// limit). teller: null, or notified of bounds.
  bool run(std::uint64_t max_steps, BoundsTeller* teller);
  /// Returns a bound on the distances of all pairs that have not been measured.
  double rest() const;
  std::uint64_t steps() const { return steps_; }
  std::uint64_t box_tests() const { return box_tests_; }

 private:
  using Vector3d = Eigen::Vector3d;
  using Matrix3d = Eigen::Matrix3d;

  /// A box along the walk's axes.
  struct Box {
    Vector3d centre, half;
  };
  struct Waiting {
    double bound;
    std::uint32_t a, b;
  };
  struct Body {
    const ObbTree* tree;
    Matrix3d map;     ///< from the tree's units to the walk's axes
    Vector3d origin;  ///< on the walk's axes
    double margin;    ///< errors of coordinates
    double turn;      ///< a bound on what the map does to lengths
  };

  Body body_of(const QueryBody& body, int exponent) const;
  void boxes_of(const Body& body, const TreeNode& node, std::vector<Box>& out) const;
  static double gap_between(const Box& a, const Box& b);
  void open(const Waiting& pair);
  void see(const Waiting& parent, std::uint32_t a, std::uint32_t b, double bound, bool leaves);

  NearestPairs& found_;
  int exponent_;   ///< a unit of the walk is 2^exponent_
  Matrix3d axes_;  ///< rows: the walk's axes in the world
  Body body_[2];
  std::vector<Waiting> waiting_;
  std::vector<Box> boxes_[2];
  double dropped_ = std::numeric_limits<double>::infinity();  ///< the least bound of what was dropped
  std::uint64_t steps_ = 0, box_tests_ = 0;
};

}  // namespace lrb
