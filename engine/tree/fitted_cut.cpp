// Selection of cuts of ranges of simplices by the surface area heuristic, for oriented boxes.
// 1. The moments of the simplices are summed over the range; their covariance gives the principal axes.
// 2. All cuts across the coordinate axes and some principal axes are ranked by the moments of both halves,
//    with prefix sums, in linear time.
// 3. The best ranked cuts are evaluated with the tight boxes of the halves, and the cheapest one is chosen.
// 4. The orders along the coordinate axes are partitioned stably, so that no half is sorted again.

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/binary_tree.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Estimates the costs of the tight boxes of a part and of the rest, up to a factor. Half the surface area of
/// a box is about the root of the sum of the squared products of two standard deviations each, along
/// principal axes. The axes are not needed: the radicand is the sum of the principal minors of the
/// covariance.
std::array<double, 2> ranked_costs(const Spread& part, const Spread& all) {
  // Both at a time. Covariance from raw moments: cancellation is limited by measuring small ranges again
  // (kMeasureAgain).
  const auto sums = [&](int i) { return Eigen::Array2d(part.sums[i], all.sums[i] - part.sums[i]); };
  const Eigen::Array2d whole = 1 / sums(0);
  const Eigen::Array2d x = sums(1) * whole, y = sums(2) * whole, z = sums(3) * whole;
  const Eigen::Array2d xx = sums(4) * whole - x * x, yy = sums(5) * whole - y * y,
                       zz = sums(6) * whole - z * z;
  const Eigen::Array2d yz = sums(7) * whole - y * z, zx = sums(8) * whole - z * x,
                       xy = sums(9) * whole - x * y;
  const Eigen::Array2d minors = yy * zz + zz * xx + xx * yy - (yz * yz + (zx * zx + xy * xy));
  const Eigen::Array2d variance = xx + (yy + zz);
  std::array<double, 2> costs;
  // std::max(0.0, x), in this order, is 0 if x is NaN due to rounding.
  for (int i = 0; i < 2; ++i)
    costs[i] = std::sqrt(std::max(0.0, minors[i])) + kLengthCost * std::max(0.0, variance[i]);
  return costs;
}

/// Returns the principal axes of moments as columns, in any order and direction. Takes a third of the time of
/// eigenvectors_of_symmetric(), whose axes the nodes get; these here only rank cuts. The characteristic
/// polynomial is solved by Newton's method without trigonometric functions, which differ between machines.
Matrix3d estimated_axes(const Spread& spread) {
  const double whole = 1 / spread.sums[0];
  const double mean[3] = {spread.sums[1] * whole, spread.sums[2] * whole, spread.sums[3] * whole};
  double xx = spread.sums[4] * whole - mean[0] * mean[0], yy = spread.sums[5] * whole - mean[1] * mean[1],
         zz = spread.sums[6] * whole - mean[2] * mean[2], yz = spread.sums[7] * whole - mean[1] * mean[2],
         zx = spread.sums[8] * whole - mean[2] * mean[0], xy = spread.sums[9] * whole - mean[0] * mean[1];
  // With q a third of the trace and p^2 a sixth of the squares of M - q I, the eigenvalues of B = (M - q I) /
  // p are the roots of x^3 - 3 x - det B.
  const double q = (xx + yy + zz) * (1.0 / 3);
  xx -= q, yy -= q, zz -= q;
  const double p = std::sqrt((xx * xx + yy * yy + zz * zz + 2 * (yz * yz + zx * zx + xy * xy)) * (1.0 / 6));
  if (!(p > 0)) return Matrix3d::Identity();
  const double unit = 1 / p;
  xx *= unit, yy *= unit, zz *= unit, yz *= unit, zx *= unit, xy *= unit;
  // B or -B has a root of [sqrt(3), 2], at a distance of at least sqrt(3) from the others. Half of it, c, is
  // a root of 4 c^3 - 3 c - r for a half of the determinant, r, of [0, 1]. The polynomial in r is off by
  // 5e-5, and each step squares the error.
  const double half = 0.5 * (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx));
  const double r = std::min(std::abs(half), 1.0);
  double c = 0.86607 + r * (0.16533 - r * (0.04069 - r * 0.00932));
  for (int i = 0; i < 2; ++i) c -= (c * (4 * c * c - 3) - r) / (12 * c * c - 3);
  const double root = std::copysign(2 * c, half);
  xx -= root, yy -= root, zz -= root;
  // Its eigenvector is perpendicular to all rows: the longest of their cross products is the most precise,
  // with the largest component on the diagonal of the adjugate matrix.
  const double x2 = yy * zz - yz * yz, y2 = zz * xx - zx * zx, z2 = xx * yy - xy * xy;
  const double to_yz = xy * zx - xx * yz, to_zx = xy * yz - yy * zx, to_xy = yz * zx - zz * xy;
  Vector3d single(x2, to_xy, to_zx);
  if (std::abs(y2) > std::abs(single.x()) && std::abs(y2) >= std::abs(z2))
    single = {to_xy, y2, to_yz};
  else if (std::abs(z2) > std::abs(single.x()))
    single = {to_zx, to_yz, z2};
  const double length =
      std::sqrt(single.x() * single.x() + single.y() * single.y() + single.z() * single.z());
  if (!(length > 0)) return Matrix3d::Identity();
  single *= 1 / length;
  // The others are in the plane perpendicular to it, where the matrix is [a d; d b] on axes u and v, times
  // the square of their common length.
  const Vector3d u = std::abs(single.x()) > std::abs(single.y()) ? Vector3d(-single.z(), 0, single.x())
                                                                 : Vector3d(0, single.z(), -single.y());
  const Vector3d v(single.y() * u.z() - single.z() * u.y(), single.z() * u.x() - single.x() * u.z(),
                   single.x() * u.y() - single.y() * u.x());
  const auto product = [&](const Vector3d& s, const Vector3d& t) {
    return s.x() * (xx * t.x() + xy * t.y() + zx * t.z()) + s.y() * (xy * t.x() + yy * t.y() + yz * t.z()) +
           s.z() * (zx * t.x() + yz * t.y() + zz * t.z());
  };
  const double difference = 0.5 * (product(u, u) - product(v, v)), d = product(u, v);
  // The half of the angle whose tangent is d / difference.
  const double size = std::sqrt(difference * difference + d * d);
  double cosine = std::abs(difference) + size, sine = std::copysign(1.0, difference) * d;
  if (!(size > 0)) cosine = 1;
  const double scale =
      1 / std::sqrt((cosine * cosine + sine * sine) * (u.x() * u.x() + u.y() * u.y() + u.z() * u.z()));
  cosine *= scale;
  sine *= scale;
  Matrix3d axes;
  axes << single, cosine * u + sine * v, cosine * v - sine * u;
  return axes;
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

constexpr std::size_t kFewPlaces = 256;  ///< clearing the counters of a radix sort would take longer

/// Sorts keys by position. Equal positions: by number for few keys, otherwise in the order of the list. Radix
/// sort, 11 bits of the position at a time; `buffer` is overwritten.
void sort_places(std::vector<std::uint64_t>& places, std::vector<std::uint64_t>& buffer) {
  if (places.size() <= kFewPlaces) {
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

/// Sorts keys of these positions, in the same order, if they are spread evenly; otherwise returns false. A
/// counting sort into parts of equal width, then insertion. The result is that of sort_places().
bool sort_even_places(std::span<const float> positions, float low, float high,
                      std::vector<std::uint64_t>& places, std::vector<std::uint64_t>& buffer) {
  constexpr std::size_t kParts = 4096;
  constexpr std::uint32_t kCrowded = 16;
  const std::size_t n = places.size(), parts = std::min(kParts, 2 * std::bit_ceil(n));
  const float per_unit = static_cast<float>(parts - 1) / (high - low);
  if (!(high > low && std::isfinite(per_unit))) return false;
  // The part grows with the position, as rounding is monotone.
  const auto part_of = [&](float x) {
    return static_cast<std::uint32_t>(static_cast<int>((x - low) * per_unit));
  };
  std::array<std::uint32_t, kParts> begin;
  std::fill_n(begin.begin(), parts, 0u);
  for (const float x : positions) ++begin[part_of(x)];
  std::uint32_t sum = 0, crowd = 0;
  for (std::size_t i = 0; i < parts; ++i) {
    crowd = std::max(crowd, begin[i]);
    sum += std::exchange(begin[i], sum);
  }
  if (crowd > kCrowded) return false;
  buffer.resize(n);
  for (std::size_t i = 0; i < n; ++i) buffer[begin[part_of(positions[i])]++] = places[i];
  // A key moves past larger ones only, so equal ones keep their order.
  const std::uint64_t ignored = n <= kFewPlaces ? 0 : 0xffffffffu;
  for (std::size_t i = 1; i < n; ++i) {
    const std::uint64_t place = buffer[i];
    std::size_t to = i;
    for (; to > 0 && (buffer[to - 1] | ignored) > (place | ignored); --to) buffer[to] = buffer[to - 1];
    buffer[to] = place;
  }
  places.swap(buffer);
  return true;
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
  centre_.reserve(n);
  for (const std::uint32_t s : simplices_) {
    spread_.push_back(soup_.spread(s));
    centre_.push_back(soup_.centre(s));
  }
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
  scale_ = 1 / norm3(bounds.sizes());
  if (!std::isfinite(scale_)) scale_ = 1;
  for (const std::uint32_t i : along(0)) {
    GrowingBox<float> box;
    for (int k = 0; k < 4; ++k) {
      const auto x = four<float>(scale_ * (soup_.corner(simplices_[i], std::min(k, 2)) - origin_));
      std::ranges::copy(x, local_[i].corner[k]);
      box.extend(x);
    }
    std::ranges::copy(box.low, local_[i].box[0]);
    std::ranges::copy(-box.high, local_[i].box[1]);
  }
}

/// Measures the moments of the simplices of the range relative to the same centre and scale, which limits
/// cancellation.
void FittedCuts::measure() {
  if (first_spread_.empty()) first_spread_ = spread_;
  for (const std::uint32_t i : along(0)) spread_[i] = Spread(soup_.triangle(simplices_[i]), origin_, scale_);
}

/// Orders the range along a direction by the centres of boxes, rounded to float.
void FittedCuts::order_along(const Vector3d& direction, std::vector<std::uint32_t>& order) {
  places_.resize(size_);
  positions_.resize(size_);
  float low = std::numeric_limits<float>::infinity(), high = -low;
  const std::span<const std::uint32_t> some = along(0);
  for (std::uint32_t k = 0; k < size_; ++k) {
    const Vector3d seen = centre_[some[k]] - origin_;
    const float x = positions_[k] = static_cast<float>(scale_ * dot3(direction, seen));
    places_[k] = place_at(x, some[k]);
    low = x < low ? x : low;
    high = x > high ? x : high;
  }
  if (!sort_even_places(positions_, low, high, places_, sorted_)) sort_places(places_, sorted_);
  order.resize(size_);
  for (std::uint32_t k = 0; k < size_; ++k) order[k] = number_at(places_[k]);
}

/// Adds all cuts across one direction, with their estimated costs.
void FittedCuts::rank(int way) {
  // The moments of the left half grow by one simplex per step; those of the right half are the remainder.
  const std::span<const std::uint32_t> order = along(way);
  Spread left;
  for (std::uint32_t i = kTreeWidth; i < size_; i += kTreeWidth) {
    for (std::uint32_t k = i - kTreeWidth; k < i; ++k) left += spread_[order[k]];
    const std::uint32_t right = size_ - i;
    const auto [left_cost, right_cost] = ranked_costs(left, all_);
    const double cost = left_cost * leaves_for(i) + right_cost * leaves_for(right);
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
  // The candidates for a node's frame: the coordinate axes and the principal axes.
  const Matrix3d axes = estimated_axes(spread);
  BoxKernel k;
  k.which = some.data();
  k.count = some.size();
  k.bins = nullptr;
  k.local = local_.data();
  for (int i = 0; i < 3; ++i) std::ranges::copy(four<float>(axes.row(i)), k.axes[i]);
  run_box_kernel(k);
  const auto cost = [&](const float(&sides)[4]) {
    return box_cost(Vector3d(sides[0], sides[1], sides[2]) * (1 / scale_));
  };
  return std::min(cost(k.straight), cost(k.turned));
}

/// Cuts the range: partitions the order along each axis into left and right, stably.
void FittedCuts::part(const Cut& cut) {
  const std::span<const std::uint32_t> order = along(cut.way);
  // Mark the sides once, then partition each order in place; the right half goes through a buffer.
  for (std::uint32_t k = 0; k < size_; ++k) is_left_[order[k]] = k < cut.left;
  right_.resize(size_);
  for (int way = 0; way < 3; ++way) {
    if (way == cut.way) continue;  // in two parts already
    std::uint32_t* const range = coordinate_[way].data() + begin_;
    std::uint32_t left = 0, right = 0;
    // Each simplex is written to both sides, and only one of the ends moves: the sides cannot be predicted.
    for (std::uint32_t k = 0; k < size_; ++k) {
      const std::uint32_t i = range[k];
      range[left] = right_[right] = i;
      left += is_left_[i];
      right += 1u - is_left_[i];
    }
    std::copy_n(right_.begin(), right, range + left);
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

Soup::Soup(const SimplexView& body, std::span<const SimplexId> simplices_, double unit, Workers& workers)
    : simplices(simplices_.begin(), simplices_.end()), vertices(body.vertices) {
  // The unit is a power of two, at least 2^-1022. The inverse of 2^1023 is subnormal, but exact.
  to_tree = 1 / unit;
  corners.resize(simplices.size());
  box.resize(simplices.size());
  order.resize(simplices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<Box> bounds_of(shares_of(simplices.size()));
  for_each_share(simplices.size(), workers, [&](std::uint32_t begin, std::uint32_t end, std::size_t share) {
    for (std::uint32_t s = begin; s < end; ++s) {
      body.simplex(simplices[s], corners[s].data());
      // A segment is a triangle whose last two corners coincide.
      if (body.dim == 2) corners[s][2] = corners[s][1];
      box[s] = box_of(s);
      bounds_of[share].extend(box[s]);
    }
  });
  Box bounds;
  for (const Box& some : bounds_of) bounds.extend(some);
  origin_ = bounds.center();
  scale_ = 1 / norm3(bounds.sizes());
  if (!std::isfinite(scale_)) scale_ = 1;
}

void Soup::follow_order(Workers& workers) {
  box = std::vector<Box>();  // `= {}` would keep the memory
  const auto follow = [&](auto& items) {
    std::remove_reference_t<decltype(items)> moved(items.size());
    for_each_share(items.size(), workers, [&](std::uint32_t begin, std::uint32_t end, std::size_t) {
      for (std::uint32_t i = begin; i < end; ++i) moved[i] = items[order[i]];
    });
    items = std::move(moved);
  };
  follow(simplices);
  follow(corners);
  std::iota(order.begin(), order.end(), 0u);
}

Spread::Spread(const std::array<Vector3d, 3>& corners, const Vector3d& origin, double scale) {
  const Vector3d p = scale * (corners[0] - origin), q = scale * (corners[1] - origin),
                 r = scale * (corners[2] - origin);
  // Exact integrals over the triangle: mean (p + q + r) / 3, and second moments (sum^2 + p^2 + q^2 + r^2) /
  // 12.
  const double weight = norm3((q - p).cross(r - p)) + kFrameCornerWeight;
  const Vector3d sum = p + q + r;
  sums[0] = weight;
  sums.segment<3>(1) = weight / 3 * sum;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sums[4 + i] = weight / 12 * (sum[i] * sum[i] + p[i] * p[i] + q[i] * q[i] + r[i] * r[i]);
    sums[7 + i] = weight / 12 * (sum[j] * sum[k] + p[j] * p[k] + q[j] * q[k] + r[j] * r[k]);
  }
}

Matrix3d Spread::covariance() const {
  // E[x x^T] - mean mean^T.
  const Vector3d at = mean();
  Matrix3d c;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    c(i, i) = sums[4 + i] / sums[0] - at[i] * at[i];
    c(j, k) = c(k, j) = sums[7 + i] / sums[0] - at[j] * at[k];
  }
  return c;
}

Box box_in_frame(const Soup& soup, std::span<const std::uint32_t> which, const Frame& frame) {
  BoxKernel k;
  k.which = which.data();
  k.count = which.size();
  k.bins = nullptr;
  k.local = nullptr;
  k.vertices = soup.vertices.data()->data();
  k.corners = soup.corners.data()->data();
  k.scale = soup.to_tree;
  for (int i = 0; i < 3; ++i) std::ranges::copy(four<double>(frame.axes.col(i)), k.columns[i]);
  std::ranges::copy(frame.origin, k.origin);
  run_box_kernel(k);
  return {Vector3d(k.low), Vector3d(k.high)};
}

Frame principal_frame(const Soup& soup, std::span<const std::uint32_t> which, const Spread& spread,
                      const Box& bounds) {
  const Frame straight{Matrix3d::Identity(), 0.5 * (bounds.min() + bounds.max())};
  // Without extent there are no principal axes: 1 / 0 is not finite.
  const double scale = 1 / norm3(bounds.sizes());
  if (!std::isfinite(scale)) return straight;
  Spread measured = spread;
  // Small compared with the body: measure again, with a closer origin and scale.
  if (spread.variance() < kMeasureAgain) {
    measured = {};
    for (const std::uint32_t s : which) measured += Spread(soup.triangle(s), straight.origin, scale);
  }
  const Matrix3d axes = eigenvectors_of_symmetric(measured.covariance()).transpose();
  // Round the axes to float before measuring. If rounding spoils orthonormality, fall back to the coordinate
  // axes.
  const Frame principal{axes.cast<float>().cast<double>(), straight.origin};
  return principal.axes.allFinite() && is_orthonormal(principal.axes) ? principal : straight;
}

}  // namespace lrb
