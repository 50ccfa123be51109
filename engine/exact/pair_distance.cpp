// The distance of two disjoint simplices, exactly (Ericson, "Real-Time Collision Detection", 2005, 5.1).
// 1. Scale all coordinates by one power of two, so that they become integers.
// 2. Candidates: corner to edge, corner to interior of a triangle, interior of an edge to interior of an
//    edge.
// Each squared distance is a fraction of two integers; every comparison is a sign of an integer.
// 3. Take the least squared distance, and enclose its root in two neighbouring doubles.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/multiprecision/cpp_int.hpp>

#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/pair_distance.hpp>

namespace lrb::exact {
namespace {

using boost::multiprecision::cpp_int;

using Whole3 = std::array<cpp_int, 3>;

Whole3 minus(const Whole3& x, const Whole3& y) {
  return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
cpp_int dot(const Whole3& x, const Whole3& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
Whole3 cross(const Whole3& x, const Whole3& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

/// num / den, den > 0.
struct Fraction {
  cpp_int num = 0, den = 1;
};

bool less(const Fraction& x, const Fraction& y) {
  // Denominators are positive, so cross multiplication keeps the order.
  return x.num * y.den < y.num * x.den;
}

/// Returns a fraction in [0, 1] as a double, within 2^-53.
double as_share(const Fraction& f) {
  constexpr unsigned kBits = 62;
  return std::ldexp(static_cast<cpp_int>((f.num << kBits) / f.den).convert_to<double>(), -int{kBits});
}

/// A point of a simplex: offset from the feature's first corner along its edges.
struct ClosestFeature {
  Feature on;
  Fraction along[2];
};

struct Nearest {
  Fraction square;
  ClosestFeature spot[2];
};

/// The smallest exponent of a last mantissa bit among the numbers seen.
struct LastBit {
  int exponent = std::numeric_limits<int>::max();
  static constexpr int kMantissaBits = 53;

  void add(double x) {
    if (x == 0) return;
    int e = 0;
    std::frexp(x, &e);
    exponent = std::min(exponent, e - kMantissaBits);
  }
  cpp_int to_integer(double x) const {
    if (x == 0) return 0;
    int e = 0;
    // x = mantissa 2^(e - 53) with an integer mantissa, and the remaining shift is not negative.
    const double mantissa = std::ldexp(std::frexp(x, &e), kMantissaBits);
    return static_cast<cpp_int>(static_cast<std::int64_t>(mantissa)) << (e - kMantissaBits - exponent);
  }
};

class Pair {
 public:
  /// `also`: another number that must be an integer after scaling.
  Pair(const double* const* a, const double* const* b, int n, double also = 0) : n_(n) {
    const double* const* const given[2] = {a, b};
    last_.add(also);
    for (const auto* simplex : given)
      for (int k = 0; k < n; ++k)
        for (int axis = 0; axis < n; ++axis) last_.add(simplex[k][axis]);
    // All coordinates are 0: any power of two is valid.
    if (last_.exponent == std::numeric_limits<int>::max()) last_.exponent = 0;
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < n; ++k)
        for (int axis = 0; axis < n; ++axis)
          x_[side][k][static_cast<std::size_t>(axis)] = last_.to_integer(given[side][k][axis]);
    find();
  }

  const Nearest& nearest() const { return nearest_; }
  /// Coordinates are integers times 2^exponent().
  int exponent() const { return last_.exponent; }
  cpp_int to_integer(double x) const { return last_.to_integer(x); }

 private:
  int edges() const { return n_ == 3 ? 3 : 1; }
  const Whole3& corner(int side, int k) const { return x_[side][k % n_]; }
  Whole3 edge(int side, int k) const { return minus(corner(side, k + 1), corner(side, k)); }

  void find() {
    // Every corner against the boundary and the interior of the other simplex. Feet on a triangle's boundary
    // are found by its edges, so the interior is open.
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < n_; ++k) {
        for (int j = 0; j < edges(); ++j) corner_to_edge(side, k, j);
        if (n_ == 3) corner_to_face(side, k);
      }
    if (n_ != 3) return;  // disjoint segments are closest at an end
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) edge_to_edge(i, j);
  }

  /// `spot`: on the simplex of `side`; `other`: on the other one.
  void consider(Fraction square, int side, ClosestFeature spot, ClosestFeature other) {
    // Keeps the first of equal distances, so that the result is reproducible.
    if (found_ && !less(square, nearest_.square)) return;
    found_ = true;
    nearest_.square = std::move(square);
    nearest_.spot[side] = std::move(spot);
    nearest_.spot[1 - side] = std::move(other);
  }

  static Feature feature(int dim, int index) {
    return {static_cast<std::uint8_t>(dim), static_cast<std::uint8_t>(index)};
  }

  void corner_to_edge(int side, int k, int j) {
    const Whole3 direction = minus(corner(side, k), corner(1 - side, j)), along = edge(1 - side, j);
    // The foot of the perpendicular is at at / length along the edge. An edge of length 0 takes the first
    // branch.
    const cpp_int at = dot(direction, along), length = dot(along, along);
    const ClosestFeature current{feature(0, k), {}};
    // Voronoi regions of the edge (Ericson 2005, 5.1.2): first end, second end, interior.
    if (at <= 0) {
      consider({dot(direction, direction), 1}, side, current, {feature(0, j), {}});
    } else if (at >= length) {
      const Whole3 from_end = minus(corner(side, k), corner(1 - side, j + 1));
      consider({dot(from_end, from_end), 1}, side, current, {feature(0, (j + 1) % n_), {}});
    } else {
      // Pythagoras: the squared distance is |direction|^2 - at^2 / length.
      consider({length * dot(direction, direction) - at * at, length}, side, current,
               {feature(1, j), {{at, length}, {}}});
    }
  }

  void corner_to_face(int side, int k) {
    const Whole3 u = edge(1 - side, 0), v = minus(corner(1 - side, 2), corner(1 - side, 0));
    const Whole3 direction = minus(corner(side, k), corner(1 - side, 0)), normal = cross(u, v);
    const cpp_int area = dot(normal, normal);
    // `area` is the squared length of the normal. If it is 0, the edges cover the triangle.
    if (area == 0) return;
    const cpp_int uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, direction),
                  vw = dot(v, direction);
    // Cramer's rule for the normal equations. Their determinant uu vv - uv^2 is |u x v|^2 (Lagrange's
    // identity).
    const cpp_int s = vv * uw - uv * vw, t = uu * vw - uv * uw;
    if (s <= 0 || t <= 0 || s + t >= area) return;
    // The distance to the plane is height / |normal|.
    const cpp_int height = dot(normal, direction);
    consider({height * height, area}, side, {feature(0, k), {}}, {feature(2, 0), {{s, area}, {t, area}}});
  }

  void edge_to_edge(int i, int j) {
    const Whole3 u = edge(0, i), v = edge(1, j), direction = minus(corner(0, i), corner(1, j)),
                 normal = cross(u, v);
    const cpp_int sine = dot(normal, normal);
    // Parallel edges: the distance is also attained at an end of one of them.
    if (sine == 0) return;
    const cpp_int uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, direction),
                  vw = dot(v, direction);
    // The closest points of the two lines. They are valid only strictly inside both edges; ends are handled
    // above.
    const cpp_int s = uv * vw - vv * uw, t = uu * vw - uv * uw;
    if (s <= 0 || t <= 0 || s >= sine || t >= sine) return;
    const cpp_int height = dot(normal, direction);
    consider({height * height, sine}, 0, {feature(1, i), {{s, sine}, {}}}, {feature(1, j), {{t, sine}, {}}});
  }

  int n_;
  LastBit last_;
  Whole3 x_[2][3];
  bool found_ = false;
  Nearest nearest_;
};

/// Sets two doubles that enclose sqrt(square) 2^exponent: equal if the root is a double, else adjacent.
void enclose_root(const Fraction& square, int exponent, double& lower, double& upper) {
  if (square.num == 0) {
    lower = upper = 0;
    return;
  }
  constexpr int kBits = 130, kMantissaBits = 53;  // of the fraction, so that its root has at least 64
  int shift = kBits - static_cast<int>(msb(square.num)) + static_cast<int>(msb(square.den));
  // An even shift, because the root of 2^shift must be a power of two.
  shift += shift & 1;
  const cpp_int above = shift > 0 ? square.num << shift : square.num;
  const cpp_int below = shift < 0 ? square.den << -shift : square.den;
  const cpp_int whole = above / below;
  // Both the quotient and the root are rounded down, so `low` is at most the true root and low + 1 is above
  // it.
  const cpp_int root = sqrt(whole);
  const int spare = static_cast<int>(msb(root)) + 1 - kMantissaBits;
  const cpp_int low = root >> spare;
  // Exact only if no step dropped a bit: the division, the root and the cut to 53 bits.
  const bool is_exact = whole * below == above && root * root == whole && (low << spare) == root;
  const int scale = exponent - shift / 2 + spare;
  const auto scaled = [scale](const cpp_int& x) { return std::ldexp(x.convert_to<double>(), scale); };
  lower = scaled(low);
  upper = is_exact ? lower : scaled(low + 1);
  constexpr int kMinNormal = -1022;  // below it, scaling rounds
  if (scale + kMantissaBits - 1 < kMinNormal) {
    lower = std::max(0.0, std::nextafter(lower, -1.0));
    upper = std::nextafter(upper, 1.0);
  }
  if (std::isinf(lower)) lower = std::numeric_limits<double>::max();
}

/// Returns a point of a simplex in doubles.
Eigen::Vector3d place(const ClosestFeature& spot, const double* const* corners, int n) {
  const auto at = [&](int k) {
    const double* x = corners[k % n];
    return Eigen::Vector3d(x[0], x[1], n == 3 ? x[2] : 0);
  };
  if (spot.on.dim == 0) return at(spot.on.index);
  // Barycentric combination. s and t are within 2^-53 of the exact parameters.
  const int first = spot.on.dim == 1 ? spot.on.index : 0;
  const double s = as_share(spot.along[0]), t = spot.on.dim == 2 ? as_share(spot.along[1]) : 0;
  return (1 - s - t) * at(first) + s * at(first + 1) + t * at(first + 2);
}

}  // namespace

PairDistance distance_of_simplices(const double* const* a, const double* const* b, int n) {
  const FloatMode float_mode;
  const Pair pair(a, b, n);
  const Nearest& nearest = pair.nearest();
  PairDistance out;
  enclose_root(nearest.square, pair.exponent(), out.lower, out.upper);
  for (int side = 0; side < 2; ++side) {
    out.point[side] = place(nearest.spot[side], side == 0 ? a : b, n);
    out.on[side] = nearest.spot[side].on;
  }
  return out;
}

int compare_distance(const double* const* a, const double* const* b, int n, double distance) {
  const FloatMode float_mode;
  const Pair pair(a, b, n, distance);
  // Compare squares: both are non-negative, so the order is the same.
  const cpp_int whole = pair.to_integer(distance);
  const Fraction &square = pair.nearest().square, given{whole * whole, 1};
  return less(square, given) ? -1 : less(given, square) ? 1 : 0;
}

}  // namespace lrb::exact
