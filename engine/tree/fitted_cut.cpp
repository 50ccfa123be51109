#include "engine/tree/fitted_cut.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <vector>

#include "engine/core/eigenvectors.hpp"
#include "engine/core/infinity.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns about how large a box is that fits, up to a factor: the root of the sum of the squares of the
/// three products of two standard deviations along principal axes. It takes no such axes: what is under the
/// root is the sum of the principal minors of the covariance.
double area_of(const Spread& spread) {
  const double whole = 1 / spread.weight;
  const Vector3d mean = spread.first * whole;
  const Vector3d square = spread.squares * whole - mean.cwiseProduct(mean);
  const Vector3d product =
      spread.products * whole - Vector3d(mean.y() * mean.z(), mean.z() * mean.x(), mean.x() * mean.y());
  const double minors =
      square.y() * square.z() + square.z() * square.x() + square.x() * square.y() - product.squaredNorm();
  return std::sqrt(std::max(0.0, minors));  // in this order: 0 if rounding has made it NaN
}

/// A simplex by its place along a direction, as one number that is sorted fast: in front, bits that grow with
/// the place, then the simplex's number in the range.
using Place = std::uint64_t;

Place place_at(float x, std::uint32_t number) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t growing = bits >> 31 != 0 ? ~bits : bits | 0x80000000u;
  return std::uint64_t{growing} << 32 | number;
}

std::uint32_t number_at(Place place) {
  return static_cast<std::uint32_t>(place);
}

struct Cut {
  double cost;
  int way;             ///< the direction it is across
  std::uint32_t left;  ///< number of simplices on its left
};

bool is_cheaper(const Cut& x, const Cut& y) {
  return std::tie(x.cost, x.way, x.left) < std::tie(y.cost, y.way, y.left);
}

class CutSearch {
 public:
  CutSearch(const Soup& soup, std::span<std::uint32_t> range) : soup_(soup), range_(range) {}

  std::uint32_t run(CutEffort effort) {
    if (!measure()) return 0;
    for (int way = 0; way < 3 + effort.principal; ++way) rank(way);
    constexpr std::size_t kPerCut = 128;  // ranks are less sure where there are more simplices
    const std::size_t few =
        std::min(std::max<std::size_t>(effort.tried, range_.size() / kPerCut), cuts_.size());
    std::partial_sort(cuts_.begin(), cuts_.begin() + static_cast<std::ptrdiff_t>(few), cuts_.end(),
                      is_cheaper);
    Cut best{kInfinity, 0, kTreeWidth};
    for (const Cut& cut : std::span(cuts_).first(few)) {
      const double cost = cost_of(cut, best.cost);
      if (cost < best.cost) best = {cost, cut.way, cut.left};
    }
    std::vector<std::uint32_t> sorted;
    sorted.reserve(range_.size());
    for (const Place place : order_[best.way]) sorted.push_back(range_[number_at(place)]);
    std::copy(sorted.begin(), sorted.end(), range_.begin());
    return best.left;
  }

 private:
  static constexpr int kMostWays = 6;

  /// Finds how the simplices are spread. Returns false if they are at one point.
  bool measure() {
    Box bounds;
    for (const std::uint32_t s : range_) bounds.extend(soup_.box[s]);
    origin_ = bounds.center();
    const double size = bounds.sizes().norm();
    if (!(size > 0)) return false;
    spread_.reserve(range_.size());
    for (const std::uint32_t s : range_) all_ += spread_.emplace_back(soup_.corners[s], origin_, size);
    principal_ = eigenvectors_of_symmetric(all_.covariance());
    return true;
  }

  /// Orders the simplices along one direction and adds all cuts across it.
  void rank(int way) {
    const Vector3d along = way < 3 ? Vector3d(Vector3d::Unit(way)) : Vector3d(principal_.col(5 - way));
    std::vector<Place>& order = order_[way];
    order.reserve(range_.size());
    for (std::uint32_t i = 0; i < range_.size(); ++i)
      order.push_back(place_at(static_cast<float>(along.dot(soup_.centre[range_[i]] - origin_)), i));
    std::sort(order.begin(), order.end());
    Spread left;
    const auto size = static_cast<std::uint32_t>(order.size());
    for (std::uint32_t i = 1; i < size; ++i) {
      left += spread_[number_at(order[i - 1])];
      if (i % kTreeWidth == 0)
        cuts_.push_back(
            {area_of(left) * leaves_for(i) + area_of(all_ - left) * leaves_for(size - i), way, i});
    }
  }

  /// Returns what a cut costs, or `most` if it costs no less.
  double cost_of(const Cut& cut, double most) const {
    const std::span<const Place> order = order_[cut.way], left = order.first(cut.left),
                                 right = order.subspan(cut.left);
    const double cost = fitted_area(left) * leaves_for(cut.left);
    const auto on_right = static_cast<std::uint32_t>(right.size());
    return cost < most ? cost + fitted_area(right) * leaves_for(on_right) : most;
  }

  /// Returns half the surface of the box that fits some of the simplices.
  double fitted_area(std::span<const Place> some) const {
    Spread spread;
    Box straight, turned;
    for (const Place place : some) {
      spread += spread_[number_at(place)];
      straight.extend(soup_.box[range_[number_at(place)]]);
    }
    const Matrix3d axes = eigenvectors_of_symmetric(spread.covariance()).transpose();
    for (const Place place : some)
      for (const Vector3d& x : soup_.corners[range_[number_at(place)]]) turned.extend(axes * (x - origin_));
    return half_area(turned) < half_area(straight) ? half_area(turned) : half_area(straight);
  }

  const Soup& soup_;
  const std::span<std::uint32_t> range_;
  Vector3d origin_;
  std::vector<Spread> spread_;  ///< one for each simplex of the range
  Spread all_;
  Matrix3d principal_;                               ///< columns, that of the least extent first
  std::array<std::vector<Place>, kMostWays> order_;  ///< of the whole range, along each direction
  std::vector<Cut> cuts_;
};

}  // namespace

std::uint32_t cut_by_fitted_boxes(const Soup& soup, std::span<std::uint32_t> range, CutEffort effort) {
  return CutSearch(soup, range).run(effort);
}

}  // namespace lrb
