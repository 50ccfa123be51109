#pragma once
/// Where to cut ranges of simplices in two so that the boxes that fit the halves are small.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/simplex_view.hpp>

namespace lrb {

// The simplices that a tree is built over, and the boxes that fit some of them.

/// Simplices in the tree's units, in the order in which they were given.
struct Soup {
  std::span<const SimplexId> simplices;
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  std::vector<Eigen::AlignedBox3d> box;
  std::vector<Eigen::Vector3d> centre;  ///< of the box
  std::vector<std::uint32_t> order;     ///< lists the simplices in the order of the tree's leaves

  Soup(const SimplexView& body, std::span<const SimplexId> simplices, double unit);

  /// Returns a function that tells which of two simplices comes first on an axis: by centre, then by number.
  auto order_on(int axis) const {
    return [this, axis](std::uint32_t s, std::uint32_t t) {
      const double x = centre[s][axis], y = centre[t][axis];
      return x != y ? x < y : s < t;
    };
  }

  std::span<const std::uint32_t> listed(std::uint32_t begin, std::uint32_t end) const {
    return std::span(order).subspan(begin, end - begin);
  }
};

/// Returns half the surface of a box.
inline double half_area(const Eigen::AlignedBox3d& b) {
  const Eigen::Vector3d e = b.sizes();
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

/// Returns what a box costs a query, by the surface area heuristic: half its surface, and a little for its
/// length.
inline double box_cost(const Eigen::AlignedBox3d& b) {
  return half_area(b) + kLengthCost * b.sizes().squaredNorm();
}

/// Axes of length 1 about an origin: a point x has the coordinates axes * (x - origin).
struct Frame {
  Eigen::Matrix3d axes;  ///< rows
  Eigen::Vector3d origin;
};

/// How the points of simplices are spread: the sums over all points of 1, of the point, and of its product
/// with itself. A simplex weighs twice its area, and a little more, so that segments and points count.
struct Spread {
  double weight = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();   ///< xx, yy, zz
  Eigen::Vector3d products = Eigen::Vector3d::Zero();  ///< yz, zx, xy

  Spread() = default;
  /// Measures one simplex, seen from `origin`, its lengths times `scale`.
  Spread(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& origin, double scale);

  void operator+=(const Spread& more) {
    weight += more.weight;
    first += more.first;
    squares += more.squares;
    products += more.products;
  }
  Spread operator-(const Spread& part) const {
    Spread rest = *this;
    rest.weight -= part.weight;
    rest.first -= part.first;
    rest.squares -= part.squares;
    rest.products -= part.products;
    return rest;
  }

  /// Returns the covariance of the points.
  Eigen::Matrix3d covariance() const;
  /// Returns the mean square of the points' distances from their middle.
  double variance() const { return squares.sum() / weight - (first / weight).squaredNorm(); }
};

/// Returns the box of some simplices in a frame.
Eigen::AlignedBox3d box_in_frame(const Soup& soup, std::span<const std::uint32_t> which, const Frame& frame);

/// Returns the principal axes of some simplices, rounded to float, so that what is measured is what the query
/// uses; or the coordinate axes where those give the smaller box. bounds: their box on the coordinate axes.
Frame fit_frame(const Soup& soup, std::span<const std::uint32_t> which, const Eigen::AlignedBox3d& bounds);

/// Returns the number of leaves that hold some simplices: all but the last are full.
inline std::uint32_t leaves_for(std::uint32_t simplices) {
  return (simplices + kTreeWidth - 1) / kTreeWidth;
}

/// Returns how many of some simplices are on the larger side of a cut: the fewer, the more even it is.
inline std::uint32_t larger_side(std::uint32_t left, std::uint32_t all) {
  return std::max(left, all - left);
}

/// How many cuts of a range to compare.
struct CutEffort {
  int principal;        ///< across how many of the range's principal axes, the longest first; 0 to 3
  std::uint32_t tried;  ///< number of cuts for which the boxes are found, at least 1; more in large ranges
};

/// Some simplices, ordered along the coordinate axes, that are cut into ranges and those again, down to
/// leaves.
///
/// All cuts of a range across the coordinate axes and some principal axes are ranked by how the points of the
/// halves are spread. Of the first ones that one is taken whose halves have the smallest boxes, each on its
/// own axes as in fit_frame(): the sum of box_cost(), each times the number of leaves in it (the surface area
/// heuristic, of boxes as the query will see them). Of cuts that rank or cost the same, the most even one
/// comes first, so that simplices at one point are halved.
class FittedCuts {
 public:
  /// Nothing is cut yet: the one range is [0, simplices.size()). `soup` must outlive this.
  FittedCuts(const Soup& soup, std::span<const std::uint32_t> simplices, CutEffort effort);

  struct Halves {
    std::uint32_t middle;          ///< where the range is cut: a multiple of kTreeWidth after its beginning
    double left_cost, right_cost;  ///< box_cost() of the boxes that fit
  };
  /// Cuts a range of more than kTreeWidth simplices that nothing has cut yet, in two ranges.
  Halves cut(std::uint32_t begin, std::uint32_t end);

  /// Returns box_cost() of the box that fits all simplices.
  double whole_cost() const { return whole_cost_; }

  /// Returns the simplices, range by range.
  std::vector<std::uint32_t> order() const;

 private:
  struct Cut {
    float cost;            ///< rounded: what differs by rounding errors alone mostly costs the same
    std::uint32_t larger;  ///< larger_side()
    int way;               ///< the direction it is across
    std::uint32_t left;    ///< number of simplices on its left
    bool operator<(const Cut& y) const;
  };

  std::span<const std::uint32_t> along(int way) const;
  void measure();
  void order_along_principal(int k, const Eigen::Vector3d& direction);
  void rank(int way);
  Halves measured(const Cut& cut, float most) const;
  double fitted_box_cost(std::span<const std::uint32_t> some) const;
  void part(const Cut& cut);

  const Soup& soup_;
  const CutEffort effort_;
  double whole_cost_ = 0;
  std::vector<std::uint32_t> simplices_;  ///< in order; below, simplices go by their place here
  std::vector<Spread> spread_;            ///< of each simplex; in a range, from one origin and at one scale
  std::array<std::vector<std::uint32_t>, 3> coordinate_;  ///< range by range, ordered along an axis in each

  // The range that is being cut.
  std::uint32_t begin_ = 0, size_ = 0;
  Spread all_;
  std::array<std::vector<std::uint32_t>, 3> principal_;  ///< ordered along its principal axes
  std::vector<Cut> cuts_;
  std::vector<std::uint8_t> is_left_;  ///< for each simplex

  // Memory that is kept from one use to the next.
  std::vector<std::uint64_t> places_;
  std::vector<std::uint32_t> right_;
};

}  // namespace lrb
