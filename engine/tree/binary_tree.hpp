#pragma once
/// The binary tree over simplices that is collapsed to the 8-wide OBB tree, and the selection of cuts that
/// divide ranges of simplices into halves with small tight boxes.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/box_kernel.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/simplex_view.hpp>

namespace lrb {

// The simplices of a tree, and their tight boxes.

/// Moments of the points of simplices: the integrals of 1, of the point, and of its outer product. A simplex
/// has a weight of twice its area plus a small constant, so that segments and points count.
struct Spread {
  /// The weight, the integral of the point (3), and of xx, yy, zz, yz, zx, xy: one array, so that sums take
  /// few instructions.
  Eigen::Array<double, 10, 1> sums = Eigen::Array<double, 10, 1>::Zero();

  Spread() = default;
  /// Measures one simplex relative to `origin`, with lengths scaled by `scale`.
  Spread(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& origin, double scale);

  void operator+=(const Spread& more) { sums += more.sums; }
  Spread operator-(const Spread& part) const {
    Spread rest;
    rest.sums = sums - part.sums;
    return rest;
  }

  /// Returns the mean of the points.
  Eigen::Vector3d mean() const { return sums.segment<3>(1) / sums[0]; }
  /// Returns the covariance of the points.
  Eigen::Matrix3d covariance() const;
  /// Returns the mean squared distance of the points from their mean.
  double variance() const { return ((sums[4] + sums[5]) + sums[6]) / sums[0] - squared_norm3(mean()); }
};

/// Simplices in the tree's units, in the given order. Positions stay in the body, so that large bodies take
/// little memory.
struct Soup {
  std::vector<SimplexId> simplices;
  std::vector<std::array<VertexId, 3>> corners;
  std::vector<Eigen::AlignedBox3d> box;       ///< until follow_order()
  std::vector<std::uint32_t> order;           ///< the simplices in the order of the tree's leaves
  std::span<const Eigen::Vector3d> vertices;  ///< mesh units
  double to_tree;                             ///< factor from mesh units to the tree's

  Soup(const SimplexView& body, std::span<const SimplexId> simplices, double unit, Workers& workers);

  /// Returns the position of a corner.
  Eigen::Vector3d corner(std::uint32_t s, int k) const { return vertices[corners[s][k]] * to_tree; }
  std::array<Eigen::Vector3d, 3> triangle(std::uint32_t s) const {
    return {corner(s, 0), corner(s, 1), corner(s, 2)};
  }
  /// Computes the box of a simplex.
  Eigen::AlignedBox3d box_of(std::uint32_t s) const {
    Eigen::AlignedBox3d b;
    for (int k = 0; k < 3; ++k) b.extend(corner(s, k));
    return b;
  }

  /// Returns the centre of a simplex's box.
  Eigen::Vector3d centre(std::uint32_t s) const { return 0.5 * (box[s].min() + box[s].max()); }
  /// Returns the moments of a simplex relative to the centre of all simplices, scaled by their diagonal.
  Spread spread(std::uint32_t s) const { return {triangle(s), origin_, scale_}; }

  /// Returns the comparison of two simplices on an axis: by centre, then by number.
  auto order_on(int axis) const {
    return [this, axis](std::uint32_t s, std::uint32_t t) {
      const double x = centre(s)[axis], y = centre(t)[axis];
      return x != y ? x < y : s < t;
    };
  }

  /// Returns order[begin .. end - 1].
  std::span<const std::uint32_t> listed(std::uint32_t begin, std::uint32_t end) const {
    return std::span(order).subspan(begin, end - begin);
  }

  /// Moves the simplices and their corners to the order of the leaves, in which they are read from here on,
  /// and discards the boxes.
  void follow_order(Workers& workers);

 private:
  Eigen::Vector3d origin_;
  double scale_;
};

/// Number of simplices to be distributed to a thread at once.
inline constexpr std::size_t kShare = 4096;
inline std::size_t shares_of(std::size_t n) {
  return (n + kShare - 1) / kShare;
}

/// Calls work(begin, end, share) for the ranges of kShare numbers that [0, n) consists of.
template <class Work>
void for_each_share(std::size_t n, Workers& workers, const Work& work) {
  workers.for_each(shares_of(n), [&](std::size_t share, unsigned) {
    work(static_cast<std::uint32_t>(share * kShare),
         static_cast<std::uint32_t>(std::min(n, (share + 1) * kShare)), share);
  });
}

/// Returns half the surface area of a box with sides of these lengths.
inline double half_area(const Eigen::Vector3d& sides) {
  return sides.x() * sides.y() + sides.y() * sides.z() + sides.z() * sides.x();
}
inline double half_area(const Eigen::AlignedBox3d& b) {
  return half_area(Eigen::Vector3d(b.sizes()));
}

/// Returns the cost of a box to a query by the surface area heuristic: half its surface area, plus a small
/// term for its length.
inline double box_cost(const Eigen::Vector3d& sides) {
  return half_area(sides) + kLengthCost * squared_norm3(sides);
}
inline double box_cost(const Eigen::AlignedBox3d& b) {
  return box_cost(Eigen::Vector3d(b.sizes()));
}

/// A box that grows. Points are x, y, z and 0: four coordinates fill a vector register.
template <class Scalar>
struct GrowingBox {
  using Point = Eigen::Array<Scalar, 4, 1>;
  Point low = Point::Constant(std::numeric_limits<Scalar>::infinity()), high = -low;

  void extend(const Point& x) {
    low = low.min(x);
    high = high.max(x);
  }
  void extend(const GrowingBox& box) {
    low = low.min(box.low);
    high = high.max(box.high);
  }
  Eigen::Vector3d sides() const { return (high - low).template head<3>().template cast<double>(); }
};

/// Returns a point or vector as a GrowingBox takes it.
template <class Scalar>
Eigen::Array<Scalar, 4, 1> four(const Eigen::Vector3d& x) {
  return {static_cast<Scalar>(x[0]), static_cast<Scalar>(x[1]), static_cast<Scalar>(x[2]), Scalar{0}};
}

/// Unit axes about an origin: a point x has the coordinates axes * (x - origin).
struct Frame {
  Eigen::Matrix3d axes;  ///< rows
  Eigen::Vector3d origin;
};

/// Returns the box of some simplices in a frame.
Eigen::AlignedBox3d box_in_frame(const Soup& soup, std::span<const std::uint32_t> which, const Frame& frame);

/// Returns the principal axes of some simplices, or the coordinate axes if the simplices have no extent. Axes
/// are rounded to float before they are evaluated, as the query uses them. spread: the sum of the moments.
/// bounds: the box of the simplices on the coordinate axes.
Frame principal_frame(const Soup& soup, std::span<const std::uint32_t> which, const Spread& spread,
                      const Eigen::AlignedBox3d& bounds);

/// Returns the number of leaves for some simplices; all except the last are full.
inline std::uint32_t leaves_for(std::uint32_t simplices) {
  return (simplices + kTreeWidth - 1) / kTreeWidth;
}

/// Returns the number of simplices on the larger side of a cut: smaller is more balanced.
inline std::uint32_t larger_side(std::uint32_t left, std::uint32_t all) {
  return std::max(left, all - left);
}

/// Number of cuts of a range to compare.
struct CutEffort {
  int principal;        ///< number of principal axes of the range to cut across, longest first; 0 to 3
  std::uint32_t tried;  ///< minimum number of cuts for which tight boxes are computed, at least 1; more for
                        ///< large ranges
};

/// Recursive cutting of simplices into ranges, down to leaves. Keeps the simplices ordered along the
/// coordinate axes.
///
/// All cuts of a range across the coordinate axes and some principal axes are ranked by the moments of the
/// halves. Among the best ranked ones, the cut with the smallest boxes is chosen, each box on its own axes
/// as in ObbTree. The cost is the sum of box_cost() times the number of leaves (the surface area heuristic
/// with the boxes that the query uses). Ties go to the most balanced cut, so that coincident simplices are
/// halved.
class FittedCuts {
 public:
  /// Starts with the single range [0, simplices.size()). `soup` must outlive this object.
  FittedCuts(const Soup& soup, std::span<const std::uint32_t> simplices, CutEffort effort);

  struct Halves {
    std::uint32_t boundary;  ///< index of the cut: a multiple of kTreeWidth after the beginning of the range
    double left_cost, right_cost;  ///< box_cost() of the tight boxes
  };
  /// Cuts an existing range of more than kTreeWidth simplices into two ranges.
  Halves cut(std::uint32_t begin, std::uint32_t end);

  /// Returns box_cost() of the tight box of all simplices.
  double whole_cost() const { return whole_cost_; }

  /// Returns the moments of the simplex order()[k], as Soup::spread() does.
  const Spread& spread(std::uint32_t k) const {
    return (first_spread_.empty() ? spread_ : first_spread_)[coordinate_[0][k]];
  }

  /// Returns the simplices, range by range.
  std::vector<std::uint32_t> order() const;

 private:
  struct Cut {
    float cost;            ///< rounded, so that costs that differ only by rounding errors are mostly equal
    std::uint32_t larger;  ///< larger_side()
    int way;               ///< index of the direction that it cuts across
    std::uint32_t left;    ///< number of simplices on its left
    bool operator<(const Cut& y) const;
  };
  std::span<const std::uint32_t> along(int way) const;
  Spread sum() const;
  void localise();
  void measure();
  void order_along(const Eigen::Vector3d& direction, std::vector<std::uint32_t>& order);
  void rank(int way);
  Halves measured(const Cut& cut, float most) const;
  double fitted_box_cost(std::span<const std::uint32_t> some, const Spread& spread) const;
  void part(const Cut& cut);

  const Soup& soup_;
  const CutEffort effort_;
  double whole_cost_ = 0;
  std::vector<std::uint32_t> simplices_;  ///< ascending; below, simplices are identified by their index here
  std::vector<Spread> spread_;  ///< moments of each simplex; within a range, relative to one origin and scale
  std::vector<Spread> first_spread_;     ///< as Soup::spread(), if some were measured again
  std::vector<LocalSimplex> local_;      ///< each simplex: local_ = scale_ (x - origin_) within a range
  std::vector<Eigen::Vector3d> centre_;  ///< of each simplex's box
  Eigen::Vector3d origin_{0, 0, 0};      ///< of `local_`
  double scale_ = 1;                     ///< of `local_`
  /// Range by range, ordered along an axis within each.
  std::array<std::vector<std::uint32_t>, 3> coordinate_;

  // The current range.
  std::uint32_t begin_ = 0, size_ = 0;
  Spread all_;
  std::array<std::vector<std::uint32_t>, 3> principal_;  ///< ordered along its principal axes
  std::vector<Cut> cuts_;
  std::vector<Spread> left_spread_;    ///< moments of the left halves, in the order in which cuts were ranked
  std::vector<std::uint8_t> is_left_;  ///< for each simplex

  // Memory that is kept from one use to the next.
  std::vector<float> positions_;
  std::vector<std::uint64_t> places_, sorted_;
  std::vector<std::uint32_t> right_;
};

// The binary tree.

struct BinaryNode {
  std::uint32_t begin, end;  ///< range in Soup::order
  std::uint32_t left = kNull, right = kNull;
  Eigen::AlignedBox3d box;  ///< on the coordinate axes
  Spread spread{};          ///< sum of the moments of its simplices, as in Soup
  double cost = 0;          ///< box_cost() of the tight box, or of `box` for ranges that are not fitted
  bool is_leaf() const { return left == kNull; }
};

/// The effort of choosing splits.
struct Splits {
  /// Ranges of at most this many simplices are split by the tight boxes of their halves, larger ones by boxes
  /// on the coordinate axes.
  std::uint32_t fitted;
  CutEffort effort;  ///< for these small ranges
  bool all_cuts;     ///< for larger ranges: choose from all cuts instead of bin boundaries
};

/// Builds the tree top-down and sorts Soup::order. Every split has a multiple of kTreeWidth simplices on its
/// left, so that all leaves except the last are full; the surface area heuristic chooses among those splits.
/// Parents come before children, left before right. The result does not depend on the number of threads.
std::vector<BinaryNode> build_binary_tree(Soup& soup, Workers& workers, Splits splits);

// Collapse of a binary tree to a wide one.

/// Collapses a binary tree to nodes of up to kTreeWidth children with minimum total cost of all wide nodes.
/// The cost of a node estimates how often it is visited: BinaryNode::cost^1.5.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
/// BVHs", 2017, section 3.1 (bottom-up dynamic programming; there the cost is the surface area itself).
class Collapse {
 public:
  /// `tree` must outlive this object.
  explicit Collapse(std::span<const BinaryNode> tree);

  /// Returns the children of the wide node for an inner node: 2 to kTreeWidth, in the tree's order.
  std::vector<std::uint32_t> children(std::uint32_t node) const;

 private:
  /// The optimum for a subtree that may use 1 to kTreeWidth child slots of a wide node.
  struct Best {
    std::array<double, kTreeWidth> cost{};           ///< [slots - 1]: total cost of all wide nodes in it
    std::array<std::uint8_t, kTreeWidth> to_left{};  ///< [slots - 1]: slots used by its left half
  };

  void share(std::uint32_t node, std::uint32_t places, std::vector<std::uint32_t>& children) const;

  std::span<const BinaryNode> tree_;
  std::vector<Best> best_;  ///< for each node; 0 for a leaf, which costs the same in every tree
};

}  // namespace lrb
