// Chooses where to cut ranges of simplices by the surface area heuristic, for oriented boxes.
// 1. Moments of each simplex are summed over the range: its covariance gives the principal axes.
// 2. All cuts across the coordinate axes and some principal axes are ranked by the moments of both halves,
// with prefix sums, in time linear in the number of simplices.
// 3. The best ranked cuts are measured with the boxes that fit the halves, and the cheapest one is taken.
// 4. The orders along the coordinate axes are partitioned stably, so that no half is ever sorted again.

#include "engine/tree/fitted_cut.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Estimates the cost of the fitting box, up to a factor. Half the surface of a box is about the root of the
/// sum of the squares of the three products of two standard deviations along principal axes. No axes are
/// needed: the radicand is the sum of the principal minors of the covariance.
double ranked_cost(const Spread& spread) {
  // Covariance from raw moments. Cancellation is bounded by measuring small ranges anew (kMeasureAgain).
  const double whole = 1 / spread.weight;
  const Vector3d mean = spread.first * whole;
  const Vector3d square = spread.squares * whole - mean.cwiseProduct(mean);
  const Vector3d product =
      spread.products * whole - Vector3d(mean.y() * mean.z(), mean.z() * mean.x(), mean.x() * mean.y());
  const double minors =
      square.y() * square.z() + square.z() * square.x() + square.x() * square.y() - product.squaredNorm();
  // In this order, each is 0 if rounding has made it NaN.
  return std::sqrt(std::max(0.0, minors)) + kLengthCost * std::max(0.0, square.sum());
}

/// A simplex with its position along a direction, as one integer that sorts fast: the high bits grow with the
/// position, the low bits are the simplex's number.
std::uint64_t place_at(float x, std::uint32_t number) {
  // Floats of one sign are ordered like their bits. Flip all bits of negative ones, and the sign of the
  // others.
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 is in the same place as 0
  const std::uint32_t growing = bits >> 31 != 0 ? ~bits : bits | 0x80000000u;
  return std::uint64_t{growing} << 32 | number;
}

std::uint32_t number_at(std::uint64_t place) {
  return static_cast<std::uint32_t>(place);
}

/// Returns what a cut costs with some simplices on its left and right.
float sum_of_costs(const FittedCuts::Halves& halves, std::uint32_t left, std::uint32_t right) {
  return static_cast<float>(halves.left_cost * leaves_for(left) + halves.right_cost * leaves_for(right));
}

}  // namespace

bool FittedCuts::Cut::operator<(const Cut& y) const {
  return std::tie(cost, larger, way, left) < std::tie(y.cost, y.larger, y.way, y.left);
}

FittedCuts::FittedCuts(const Soup& soup, std::span<const std::uint32_t> simplices, CutEffort effort)
    : soup_(soup), effort_(effort), simplices_(simplices.begin(), simplices.end()) {
  // Number the simplices in an order that does not depend on earlier splits, so that ties are broken alike.
  std::sort(simplices_.begin(), simplices_.end());
  const std::size_t n = simplices_.size();
  // The only sorts along coordinate axes; cuts keep these orders.
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t>& order = coordinate_[axis];
    order.resize(n);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, soup.order_on(axis), [&](std::uint32_t i) { return simplices_[i]; });
  }
  is_left_.resize(n);
  spread_.resize(n);
  size_ = static_cast<std::uint32_t>(n);
  measure();
  whole_cost_ = fitted_box_cost(along(0));
}

FittedCuts::Halves FittedCuts::cut(std::uint32_t begin, std::uint32_t end) {
  // Step 1: the moments of the range.
  begin_ = begin;
  size_ = end - begin;
  const auto sum = [&] {
    Spread all;
    for (const std::uint32_t i : along(0)) all += spread_[i];
    return all;
  };
  all_ = sum();
  // The range has become small beside the one that it was measured with: use a closer origin and scale.
  if (all_.variance() < kMeasureAgain) {
    measure();
    all_ = sum();
  }
  // Eigenvalues ascend, so column 2 is the longest axis.
  if (effort_.principal > 0) {
    const Matrix3d axes = eigenvectors_of_symmetric(all_.covariance());
    for (int k = 0; k < effort_.principal; ++k) order_along_principal(k, axes.col(2 - k));
  }
  // Step 2: rank all cuts.
  cuts_.clear();
  for (int way = 0; way < 3 + effort_.principal; ++way) rank(way);
  constexpr std::size_t kPerCut = 128;  // ranks are less sure where there are more simplices
  // Step 3: measure the best ranked ones, in order of rank.
  const std::size_t few = std::min(std::max<std::size_t>(effort_.tried, size_ / kPerCut), cuts_.size());
  std::partial_sort(cuts_.begin(), cuts_.begin() + static_cast<std::ptrdiff_t>(few), cuts_.end());
  Cut best = cuts_.front();
  best.cost = kInfinity;
  Halves halves{};
  for (Cut cut : std::span(cuts_).first(few)) {
    const Halves tried = measured(cut, best.cost);
    cut.cost = sum_of_costs(tried, cut.left, size_ - cut.left);
    // Ties go to the most even cut.
    if (!(cut < best)) continue;
    best = cut;
    halves = tried;
  }
  // Step 4.
  part(best);
  halves.middle = begin + best.left;
  return halves;
}

std::vector<std::uint32_t> FittedCuts::order() const {
  std::vector<std::uint32_t> order;
  order.reserve(simplices_.size());
  for (const std::uint32_t i : coordinate_[0]) order.push_back(simplices_[i]);
  return order;
}

/// Returns the range, ordered along a direction.
std::span<const std::uint32_t> FittedCuts::along(int way) const {
  return way < 3 ? std::span(coordinate_[way]).subspan(begin_, size_) : principal_[way - 3];
}

/// Measures how the simplices of the range are spread.
void FittedCuts::measure() {
  // Moments are taken about the centre of the range and scaled by its diagonal, which limits cancellation.
  Box bounds;
  for (const std::uint32_t i : along(0)) bounds.extend(soup_.box[simplices_[i]]);
  const Vector3d origin = bounds.center();
  double scale = 1 / bounds.sizes().norm();
  if (!std::isfinite(scale)) scale = 1;
  for (const std::uint32_t i : along(0)) spread_[i] = Spread(soup_.corners[simplices_[i]], origin, scale);
}

/// Orders the range along its principal axis number k.
void FittedCuts::order_along_principal(int k, const Vector3d& direction) {
  const Vector3d& near = soup_.centre[simplices_[along(0)[size_ / 2]]];  // places are rounded to float
  places_.clear();
  for (const std::uint32_t i : along(0)) {
    const Vector3d seen = soup_.centre[simplices_[i]] - near;
    places_.push_back(place_at(static_cast<float>(direction.dot(seen)), i));
  }
  std::sort(places_.begin(), places_.end());
  principal_[k].clear();
  for (const std::uint64_t place : places_) principal_[k].push_back(number_at(place));
}

/// Adds all cuts across one direction.
void FittedCuts::rank(int way) {
  // Moments of the left half grow by one simplex per step; those of the right half are the rest.
  const std::span<const std::uint32_t> order = along(way);
  Spread left;
  for (std::uint32_t i = 1; i < size_; ++i) {
    left += spread_[order[i - 1]];
    if (i % kTreeWidth != 0) continue;
    const std::uint32_t right = size_ - i;
    const double cost = ranked_cost(left) * leaves_for(i) + ranked_cost(all_ - left) * leaves_for(right);
    cuts_.push_back({static_cast<float>(cost), larger_side(i, size_), way, i});
  }
}

/// Finds what the halves of a cut cost; the right one infinity if the cut costs more than `most` without it.
FittedCuts::Halves FittedCuts::measured(const Cut& cut, float most) const {
  const std::span<const std::uint32_t> order = along(cut.way);
  Halves halves{0, fitted_box_cost(order.first(cut.left)), 0};
  // Stop early: costs only add up, so the cut has lost.
  const bool too_much = sum_of_costs(halves, cut.left, 0) > most;
  halves.right_cost = too_much ? kInfinity : fitted_box_cost(order.subspan(cut.left));
  return halves;
}

/// Returns what the box costs that fits some of the simplices.
double FittedCuts::fitted_box_cost(std::span<const std::uint32_t> some) const {
  Spread spread;
  // The candidates of fit_frame(): the coordinate axes and the principal axes.
  Box straight, turned;
  for (const std::uint32_t i : some) {
    spread += spread_[i];
    straight.extend(soup_.box[simplices_[i]]);
  }
  const Matrix3d axes = eigenvectors_of_symmetric(spread.covariance()).transpose();
  const Vector3d& near = soup_.centre[simplices_[some.front()]];
  for (const std::uint32_t i : some)
    for (const Vector3d& x : soup_.corners[simplices_[i]]) turned.extend(axes * (x - near));
  return std::min(box_cost(straight), box_cost(turned));
}

/// Cuts the range: puts the simplices on the left first along each axis, and keeps both sides in order.
void FittedCuts::part(const Cut& cut) {
  const std::span<const std::uint32_t> order = along(cut.way);
  // Mark the sides once, then partition each order in place; the right half goes through a buffer.
  for (std::uint32_t k = 0; k < size_; ++k) is_left_[order[k]] = k < cut.left;
  for (std::vector<std::uint32_t>& all : coordinate_) {
    right_.clear();
    auto to = all.begin() + begin_;
    for (auto from = to, end = to + size_; from != end; ++from)
      if (is_left_[*from])
        *to++ = *from;
      else
        right_.push_back(*from);
    std::copy(right_.begin(), right_.end(), to);
  }
}

// The simplices of a tree in its unit, and frames that fit some of them: principal axes of the covariance of
// the surface's points, not of the vertices, so that the tessellation does not matter (Gottschalk, Lin and
// Manocha 1996).

namespace {

/// Returns true if the rows are as orthonormal as kKernelRounding assumes; false for NaN.
bool is_orthonormal(const Matrix3d& axes) {
  return rotation_defect(axes.transpose()) <= kFrameDefect;
}

}  // namespace

Soup::Soup(const SimplexView& body, std::span<const SimplexId> simplices_, double unit)
    : simplices(simplices_) {
  // The unit is a power of two: 2^(exponent - 1).
  int exponent = 0;
  std::frexp(unit, &exponent);
  const auto to_units = [e = 1 - exponent](const Vector3d& x) -> Vector3d {
    return {std::ldexp(x.x(), e), std::ldexp(x.y(), e), std::ldexp(x.z(), e)};
  };
  const auto n = static_cast<std::uint32_t>(simplices.size());
  corners.resize(n);
  box.resize(n);
  centre.resize(n);
  order.resize(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::uint32_t s = 0; s < n; ++s) {
    VertexId v[3];
    body.simplex(simplices[s], v);
    // A segment is a triangle whose last two corners coincide.
    if (body.dim == 2) v[2] = v[1];
    for (int k = 0; k < 3; ++k) {
      corners[s][k] = to_units(body.vertices[v[k]]);
      box[s].extend(corners[s][k]);
    }
    // The centre of the box, not the centroid: cuts are judged by boxes.
    centre[s] = 0.5 * (box[s].min() + box[s].max());
  }
}

Spread::Spread(const std::array<Vector3d, 3>& corners, const Vector3d& origin, double scale) {
  const Vector3d p = scale * (corners[0] - origin), q = scale * (corners[1] - origin),
                 r = scale * (corners[2] - origin);
  // Exact integrals over the triangle: mean (p + q + r) / 3, and second moments (sum^2 + p^2 + q^2 + r^2) /
  // 12.
  weight = (q - p).cross(r - p).norm() + kFrameCornerWeight;
  const Vector3d sum = p + q + r;
  first = weight / 3 * sum;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    squares[i] = weight / 12 * (sum[i] * sum[i] + p[i] * p[i] + q[i] * q[i] + r[i] * r[i]);
    products[i] = weight / 12 * (sum[j] * sum[k] + p[j] * p[k] + q[j] * q[k] + r[j] * r[k]);
  }
}

Matrix3d Spread::covariance() const {
  // E[x x^T] - mean mean^T.
  const Vector3d mean = first / weight;
  Matrix3d c;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    c(i, i) = squares[i] / weight - mean[i] * mean[i];
    c(j, k) = c(k, j) = products[i] / weight - mean[j] * mean[k];
  }
  return c;
}

Box box_in_frame(const Soup& soup, std::span<const std::uint32_t> which, const Frame& frame) {
  Box box;
  for (const std::uint32_t s : which)
    for (const Vector3d& x : soup.corners[s]) box.extend(frame.axes * (x - frame.origin));
  return box;
}

Frame fit_frame(const Soup& soup, std::span<const std::uint32_t> which, const Box& bounds) {
  // Without extent there are no principal axes: 1 / 0 is not finite.
  const Frame straight{Matrix3d::Identity(), 0.5 * (bounds.min() + bounds.max())};
  const double scale = 1 / bounds.sizes().norm();
  if (!std::isfinite(scale)) return straight;
  Spread spread;
  for (const std::uint32_t s : which) spread += Spread(soup.corners[s], straight.origin, scale);
  const Matrix3d axes = eigenvectors_of_symmetric(spread.covariance()).transpose();
  // Round the axes to float before measuring. If rounding spoils orthonormality, fall back to the coordinate
  // axes.
  const Frame principal{axes.cast<float>().cast<double>(), straight.origin};
  if (!principal.axes.allFinite() || !is_orthonormal(principal.axes)) return straight;
  // Principal axes are not always best: a cube's are arbitrary. Keep the smaller box.
  return half_area(box_in_frame(soup, which, principal)) < half_area(bounds) ? principal : straight;
}

}  // namespace lrb
