#pragma once
/// The simplices that a tree is built over, and the boxes that fit some of them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/core/ids.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/simplex_view.hpp"

namespace lrb {

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

}  // namespace lrb
