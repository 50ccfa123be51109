// Selection of cuts of ranges of simplices by the surface area heuristic, for oriented boxes.
// 1. The moments of the simplices are summed over the range; their covariance gives the principal axes.
// 2. All cuts across the coordinate axes and some principal axes are ranked by the moments of both halves,
//    with prefix sums, in linear time.
// 3. The best ranked cuts are evaluated with the tight boxes of the halves, and the cheapest one is chosen.
// 4. The orders along the coordinate axes are partitioned stably, so that no half is sorted again.

#include "engine/tree/fitted_cut.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Estimates the cost of the tight box, up to a factor. Half the surface area of a box is about the root of
/// the sum of the squared products of two standard deviations each, along principal axes. The axes are not
/// needed: the radicand is the sum of the principal minors of the covariance.
double ranked_cost(const Spread& spread) {
  // Covariance from raw moments. Cancellation is limited by measuring small ranges again (kMeasureAgain).
  const double whole = 1 / spread.weight;
  const Vector3d mean = spread.first * whole;
  const Vector3d square = spread.squares * whole - mean.cwiseProduct(mean);
  const Vector3d product =
      spread.products * whole - Vector3d(mean.y() * mean.z(), mean.z() * mean.x(), mean.x() * mean.y());
  const double minors =
      square.y() * square.z() + square.z() * square.x() + square.x() * square.y() - product.squaredNorm();
  // std::max(0.0, x), in this order, is 0 if x is NaN due to rounding.
  return std::sqrt(std::max(0.0, minors)) + kLengthCost * std::max(0.0, square.sum());
}

/// A simplex with its position along a direction, as an integer sort key: the high bits increase with the
/// position, the low bits are the simplex's number.
std::uint64_t place_at(float x, std::uint32_t number) {
  // Floats of one sign are ordered like their bits. Flip all bits of negative ones, and only the sign of the
  // others.
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 gets the same key as 0
  const std::uint32_t growing = bits >> 31 != 0 ? ~bits : bits | 0x80000000u;
  return std::uint64_t{growing} << 32 | number;
}

std::uint32_t number_at(std::uint64_t place) {
  return static_cast<std::uint32_t>(place);
}

/// Sorts keys by position. Equal positions: by number for few keys, otherwise in the order of the list. Radix
/// sort, 11 bits of the position at a time; `buffer` is overwritten.
void sort_places(std::vector<std::uint64_t>& places, std::vector<std::uint64_t>& buffer) {
  constexpr std::size_t kFew = 256;  // clearing the counters would take longer
  if (places.size() <= kFew) {
    std::sort(places.begin(), places.end());
    return;
  }
  constexpr int kBits = 11, kRounds = 3;
  constexpr std::uint64_t kMask = (1u << kBits) - 1;
  std::array<std::array<std::uint32_t, kMask + 1>, kRounds> begin{};
  for (const std::uint64_t place : places)
    for (int round = 0; round < kRounds; ++round) ++begin[round][place >> (32 + kBits * round) & kMask];
  buffer.resize(places.size());
  for (int round = 0; round < kRounds; ++round) {
    std::uint32_t sum = 0;
    for (std::uint32_t& count : begin[round]) sum += std::exchange(count, sum);
    // Stable, so that equal positions keep their order.
    for (const std::uint64_t place : places)
      buffer[begin[round][place >> (32 + kBits * round) & kMask]++] = place;
    places.swap(buffer);
  }
}

/// Returns the cost of a cut with these numbers of simplices on its left and right.
float sum_of_costs(const FittedCuts::Halves& halves, std::uint32_t left, std::uint32_t right) {
  return static_cast<float>(halves.left_cost * leaves_for(left) + halves.right_cost * leaves_for(right));
}

}  // namespace

bool FittedCuts::Cut::operator<(const Cut& y) const {
  return std::tie(cost, larger, way, left) < std::tie(y.cost, y.larger, y.way, y.left);
}

FittedCuts::FittedCuts(const Soup& soup, std::span<const std::uint32_t> simplices, CutEffort effort)
    : soup_(soup), effort_(effort), simplices_(simplices.begin(), simplices.end()) {
  // Number the simplices independently of earlier splits, so that ties are broken consistently.
  std::sort(simplices_.begin(), simplices_.end());
  const std::size_t n = simplices_.size();
  size_ = static_cast<std::uint32_t>(n);
  coordinate_[0].resize(n);
  std::iota(coordinate_[0].begin(), coordinate_[0].end(), 0u);
  spread_.reserve(n);
  for (const std::uint32_t s : simplices_) spread_.push_back(soup_.spread[s]);
  local_.resize(n);
  is_left_.resize(n);
  localise();
  // The only sorts along coordinate axes; cuts preserve these orders. Axis 0 comes last because along(0) is
  // read by all three.
  for (int axis = 2; axis >= 0; --axis) order_along(Vector3d::Unit(axis), coordinate_[axis]);
  whole_cost_ = fitted_box_cost(along(0), sum());
}

FittedCuts::Halves FittedCuts::cut(std::uint32_t begin, std::uint32_t end) {
  // Step 1: the moments of the range.
  begin_ = begin;
  size_ = end - begin;
  all_ = sum();
  // The range has become small compared with the one used for measuring: use a closer origin and scale.
  if (all_.variance() < kMeasureAgain) {
    localise();
    measure();
    all_ = sum();
  }
  // Eigenvalues ascend, so column 2 is the longest axis.
  if (effort_.principal > 0) {
    const Matrix3d axes = eigenvectors_of_symmetric(all_.covariance());
    for (int k = 0; k < effort_.principal; ++k) order_along(axes.col(2 - k), principal_[k]);
  }
  // Step 2: rank all cuts.
  cuts_.clear();
  left_spread_.clear();
  for (int way = 0; way < 3 + effort_.principal; ++way) rank(way);
  constexpr std::size_t kPerCut = 128;  // ranks are less reliable for more simplices
  // Step 3: measure the best ranked ones, in order of rank.
  const std::size_t few = std::min(std::max<std::size_t>(effort_.tried, size_ / kPerCut), cuts_.size());
  std::partial_sort(cuts_.begin(), cuts_.begin() + static_cast<std::ptrdiff_t>(few), cuts_.end());
  Cut best = cuts_.front();
  best.cost = kInfinity;
  Halves halves{};
  for (Cut cut : std::span(cuts_).first(few)) {
    const Halves tried = measured(cut, best.cost);
    cut.cost = sum_of_costs(tried, cut.left, size_ - cut.left);
    // Ties go to the most balanced cut.
    if (!(cut < best)) continue;
    best = cut;
    halves = tried;
  }
  // Step 4.
  part(best);
  halves.boundary = begin + best.left;
  return halves;
}

std::vector<std::uint32_t> FittedCuts::order() const {
  std::vector<std::uint32_t> order;
  order.reserve(simplices_.size());
  for (const std::uint32_t i : coordinate_[0]) order.push_back(simplices_[i]);
  return order;
}

/// Returns the simplices of the range, ordered along a direction.
std::span<const std::uint32_t> FittedCuts::along(int way) const {
  return way < 3 ? std::span(coordinate_[way]).subspan(begin_, size_) : principal_[way - 3];
}

Spread FittedCuts::sum() const {
  Spread all;
  for (const std::uint32_t i : along(0)) all += spread_[i];
  return all;
}

/// Converts the corners of the range's simplices to float, relative to the centre of the range and scaled by
/// its diagonal, so that floats are precise enough.
void FittedCuts::localise() {
  Box bounds;
  for (const std::uint32_t i : along(0)) bounds.extend(soup_.box[simplices_[i]]);
  origin_ = bounds.center();
  scale_ = 1 / bounds.sizes().norm();
  if (!std::isfinite(scale_)) scale_ = 1;
  for (const std::uint32_t i : along(0))
    for (int k = 0; k < 3; ++k)
      local_[i][k] = four<float>(scale_ * (soup_.corners[simplices_[i]][k] - origin_));
}

/// Measures the moments of the simplices of the range relative to the same centre and scale, which limits
/// cancellation.
void FittedCuts::measure() {
  for (const std::uint32_t i : along(0)) spread_[i] = Spread(soup_.corners[simplices_[i]], origin_, scale_);
}

/// Orders the range along a direction by the centres of boxes, rounded to float.
void FittedCuts::order_along(const Vector3d& direction, std::vector<std::uint32_t>& order) {
  places_.resize(size_);
  for (std::uint32_t k = 0; k < size_; ++k) {
    const std::uint32_t i = along(0)[k];
    const Vector3d seen = soup_.centre[simplices_[i]] - origin_;
    places_[k] = place_at(static_cast<float>(scale_ * direction.dot(seen)), i);
  }
  sort_places(places_, sorted_);
  order.resize(size_);
  for (std::uint32_t k = 0; k < size_; ++k) order[k] = number_at(places_[k]);
}

/// Adds all cuts across one direction, with their estimated costs.
void FittedCuts::rank(int way) {
  // The moments of the left half grow by one simplex per step; those of the right half are the remainder.
  const std::span<const std::uint32_t> order = along(way);
  Spread left;
  for (std::uint32_t i = 1; i < size_; ++i) {
    left += spread_[order[i - 1]];
    if (i % kTreeWidth != 0) continue;
    const std::uint32_t right = size_ - i;
    const double cost = ranked_cost(left) * leaves_for(i) + ranked_cost(all_ - left) * leaves_for(right);
    cuts_.push_back({static_cast<float>(cost), larger_side(i, size_), way, i});
    left_spread_.push_back(left);
  }
}

/// Returns the costs of the halves of a cut. The right cost is infinite if the left one alone exceeds `most`.
FittedCuts::Halves FittedCuts::measured(const Cut& cut, float most) const {
  const std::span<const std::uint32_t> order = along(cut.way);
  // rank() adds the same number of cuts for every direction, in order.
  const std::uint32_t cuts = (size_ - 1) / kTreeWidth;
  const Spread& left = left_spread_[static_cast<std::size_t>(cut.way) * cuts + cut.left / kTreeWidth - 1];
  Halves halves{0, fitted_box_cost(order.first(cut.left), left), 0};
  // Stop early: costs only add up, so the cut cannot win.
  const bool too_much = sum_of_costs(halves, cut.left, 0) > most;
  halves.right_cost = too_much ? kInfinity : fitted_box_cost(order.subspan(cut.left), all_ - left);
  return halves;
}

/// Returns the cost of the tight box of some simplices.
double FittedCuts::fitted_box_cost(std::span<const std::uint32_t> some, const Spread& spread) const {
  // The candidates for a node's frame: the coordinate axes and the principal axes. The rotation maps x to the
  // sum of x[k] * column[k].
  const Matrix3d axes = eigenvectors_of_symmetric(spread.covariance());
  Eigen::Array4f column[3];
  for (int k = 0; k < 3; ++k) column[k] = four<float>(axes.row(k));
  GrowingBox<float> straight, turned;
  for (const std::uint32_t i : some)
    for (const Eigen::Array4f& x : local_[i]) {
      straight.extend(x);
      turned.extend(x[0] * column[0] + x[1] * column[1] + x[2] * column[2]);
    }
  const double unit = 1 / scale_;
  return std::min(box_cost(straight.sides() * unit), box_cost(turned.sides() * unit));
}

/// Cuts the range: partitions the order along each axis into left and right, stably.
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

// The simplices of a tree in its units, and tight frames: principal axes of the covariance of surface points,
// not of vertices, so that the tessellation does not matter (Gottschalk, Lin and Manocha 1996).

namespace {

/// Returns true if the rows are as orthonormal as kKernelRounding assumes; false for NaN.
bool is_orthonormal(const Matrix3d& axes) {
  return rotation_defect(axes.transpose()) <= kFrameDefect;
}

}  // namespace

Soup::Soup(const SimplexView& body, std::span<const SimplexId> simplices_, double unit)
    : simplices(simplices_) {
  // The unit is a power of two: 2^(exponent - 1). Two factors, as its inverse may be out of range.
  int exponent = 0;
  std::frexp(unit, &exponent);
  const double once = std::ldexp(1.0, (1 - exponent) / 2),
               again = std::ldexp(1.0, 1 - exponent - (1 - exponent) / 2);
  const auto n = static_cast<std::uint32_t>(simplices.size());
  corners.resize(n);
  box.resize(n);
  centre.resize(n);
  order.resize(n);
  std::iota(order.begin(), order.end(), 0u);
  Box bounds;
  for (std::uint32_t s = 0; s < n; ++s) {
    VertexId v[3];
    body.simplex(simplices[s], v);
    // A segment is a triangle whose last two corners coincide.
    if (body.dim == 2) v[2] = v[1];
    for (int k = 0; k < 3; ++k) {
      corners[s][k] = body.vertices[v[k]] * once * again;
      box[s].extend(corners[s][k]);
    }
    // The centre of the box, not the centroid: cuts are evaluated by boxes.
    centre[s] = 0.5 * (box[s].min() + box[s].max());
    bounds.extend(box[s]);
  }
  double scale = 1 / bounds.sizes().norm();
  if (!std::isfinite(scale)) scale = 1;
  spread.reserve(n);
  for (std::uint32_t s = 0; s < n; ++s) spread.emplace_back(corners[s], bounds.center(), scale);
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
  Eigen::Array4d column[3];
  for (int k = 0; k < 3; ++k) column[k] = four<double>(frame.axes.col(k));
  GrowingBox<double> box;
  for (const std::uint32_t s : which)
    for (const Vector3d& x : soup.corners[s])
      box.extend((x[0] - frame.origin[0]) * column[0] + (x[1] - frame.origin[1]) * column[1] +
                 (x[2] - frame.origin[2]) * column[2]);
  return {Vector3d(box.low.head<3>()), Vector3d(box.high.head<3>())};
}

Frame principal_frame(const Soup& soup, std::span<const std::uint32_t> which, const Spread& spread,
                      const Box& bounds) {
  const Frame straight{Matrix3d::Identity(), 0.5 * (bounds.min() + bounds.max())};
  // Without extent there are no principal axes: 1 / 0 is not finite.
  const double scale = 1 / bounds.sizes().norm();
  if (!std::isfinite(scale)) return straight;
  Spread measured = spread;
  // Small compared with the body: measure again, with a closer origin and scale.
  if (spread.variance() < kMeasureAgain) {
    measured = {};
    for (const std::uint32_t s : which) measured += Spread(soup.corners[s], straight.origin, scale);
  }
  const Matrix3d axes = eigenvectors_of_symmetric(measured.covariance()).transpose();
  // Round the axes to float before measuring. If rounding spoils orthonormality, fall back to the coordinate
  // axes.
  const Frame principal{axes.cast<float>().cast<double>(), straight.origin};
  return principal.axes.allFinite() && is_orthonormal(principal.axes) ? principal : straight;
}

}  // namespace lrb
