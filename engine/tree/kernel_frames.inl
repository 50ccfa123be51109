#pragma once
// Part of divide_kernel.inl and node_kernel.inl: the axes of a node, and its quantized boxes.

#include "engine/core/tolerances.hpp"
#include "engine/tree/build_kernel.hpp"
#include "engine/tree/kernel_lanes.inl"

namespace lrb {
namespace {

inline Float4 smaller(Float4 x, Float4 y) {
  return x > y ? y : x;
}
inline Float4 larger(Float4 x, Float4 y) {
  return x > y ? x : y;
}
inline Double4 smaller(Double4 x, Double4 y) {
  return x > y ? y : x;
}
inline Double4 larger(Double4 x, Double4 y) {
  return x > y ? x : y;
}
inline double larger(double x, double y) {
  return x > y ? x : y;
}
inline float lowest_of(Float8 x) {
  return -largest_of(-x);
}
inline Float4 load4(const float* x) {
  return *reinterpret_cast<const Float4*>(x);
}
inline Double4 load4(const double* x) {
  return *reinterpret_cast<const Double4*>(x);
}

/// Returns half the surface area of a box.
template <class Number>
Number half_area_of(Number x, Number y, Number z) {
  return x * y + y * z + z * x;
}

/// Returns the cost of a box to a query by the surface area heuristic: half its surface area, plus a small
/// term for its length.
template <class Number>
Number box_cost_of(Number x, Number y, Number z) {
  return half_area_of(x, y, z) + static_cast<Number>(kLengthCost) * (x * x + y * y + z * z);
}

inline double longest_of(Double4 side) {
  return larger(larger(side[0], side[1]), side[2]);
}

/// Returns the largest power of two whose product with a positive number is at most about 2.
inline double inverse_power_of_two(double x) {
  std::uint64_t bits;
  __builtin_memcpy(&bits, &x, sizeof x);
  const std::uint64_t exponent = bits >> 52 & 2047;
  bits = (exponent > 2045 ? 1 : 2046 - exponent) << 52;
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}

/// Rounds to 24 bits by Dekker's method. A conversion to float and back would be removed by GCC 12 where it
/// vectorizes both (it takes the number of lanes for the precision).
inline double rounded_to_float(double x) {
  const double c = x * 536870913;  // 2^29 + 1
  return c - (c - x);
}

// One number or eight, for find_axes().
template <class Number>
Number number(double x);
template <>
inline double number<double>(double x) {
  return x;
}
template <>
inline Float8 number<Float8>(double x) {
  return splat(static_cast<float>(x));
}
inline double root_of(double x) {
  return __builtin_sqrt(x);
}
inline Float8 root_of(Float8 x) {
  return root8(x);
}
inline double size_of(double x) {
  return __builtin_fabs(x);
}
inline Float8 size_of(Float8 x) {
  return abs8(x);
}
inline bool greater(double x, double y) {
  return x > y;
}
inline double select(bool which, double x, double y) {
  return which ? x : y;
}

/// Computes the eigenvectors of a symmetric matrix, or of eight, as rows, in any order and direction. The
/// characteristic polynomial is solved by Newton's method without trigonometric functions, which differ
/// between machines. tiny: a small positive number whose inverse is finite.
template <class Number>
void find_axes(Number xx, Number yy, Number zz, Number yz, Number zx, Number xy, double tiny,
               Number (&axes)[3][3]) {
  const auto of = [](double x) { return number<Number>(x); };
  const auto signed_as = [&](Number x, Number y) { return select(greater(of(0), y), -x, x); };
  // With q a third of the trace and p^2 a sixth of the squares of M - q I, the eigenvalues of B = (M - q I) /
  // p are the roots of x^3 - 3 x - det B.
  const Number q = (xx + yy + zz) * of(1.0 / 3);
  xx -= q, yy -= q, zz -= q;
  const Number squares = xx * xx + yy * yy + zz * zz + of(2) * (yz * yz + zx * zx + xy * xy);
  const Number unit = of(1) / larger(root_of(squares * of(1.0 / 6)), of(tiny));
  xx *= unit, yy *= unit, zz *= unit, yz *= unit, zx *= unit, xy *= unit;
  // B or -B has a root of [sqrt(3), 2], at a distance of at least sqrt(3) from the others. Half of it, c, is
  // a root of 4 c^3 - 3 c - r for a half of the determinant, r, of [0, 1]. The polynomial in r is off by
  // 5e-5, and each step squares the error.
  const Number half =
      of(0.5) * (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx));
  const Number r = select(greater(size_of(half), of(1)), of(1), size_of(half));
  Number c = of(0.86607) + r * (of(0.16533) - r * (of(0.04069) - r * of(0.00932)));
  for (int i = 0; i < 2; ++i) c -= (c * (of(4) * c * c - of(3)) - r) / (of(12) * c * c - of(3));
  const Number root = signed_as(c + c, half);
  xx -= root, yy -= root, zz -= root;
  // Its eigenvector is perpendicular to all rows: the longest of their cross products is the most precise,
  // with the largest component on the diagonal of the adjugate matrix.
  const Number x2 = yy * zz - yz * yz, y2 = zz * xx - zx * zx, z2 = xx * yy - xy * xy;
  const Number to_yz = xy * zx - xx * yz, to_zx = xy * yz - yy * zx, to_xy = yz * zx - zz * xy;
  const auto by_y = greater(size_of(y2), size_of(x2)),
             by_z = greater(size_of(z2), larger(size_of(x2), size_of(y2)));
  Number a[3] = {select(by_z, to_zx, select(by_y, to_xy, x2)), select(by_z, to_yz, select(by_y, y2, to_xy)),
                 select(by_z, z2, select(by_y, to_yz, to_zx))};
  const auto normalize = [&](Number(&x)[3]) {
    const Number inverse = of(1) / root_of(larger(x[0] * x[0] + x[1] * x[1] + x[2] * x[2], of(tiny)));
    for (Number& coordinate : x) coordinate *= inverse;
  };
  normalize(a);
  // The others are in the plane perpendicular to it, where the matrix is [a d; d b] on axes u and v.
  const auto by_x = greater(size_of(a[0]), size_of(a[1]));
  Number u[3] = {select(by_x, -a[2], of(0)), select(by_x, of(0), a[2]), select(by_x, a[0], -a[1])};
  normalize(u);
  const Number v[3] = {a[1] * u[2] - a[2] * u[1], a[2] * u[0] - a[0] * u[2], a[0] * u[1] - a[1] * u[0]};
  const auto product = [&](const Number* s, const Number* t) {
    return s[0] * (xx * t[0] + xy * t[1] + zx * t[2]) + s[1] * (xy * t[0] + yy * t[1] + yz * t[2]) +
           s[2] * (zx * t[0] + yz * t[1] + zz * t[2]);
  };
  const Number difference = of(0.5) * (product(u, u) - product(v, v)), d = product(u, v);
  // The half of the angle whose tangent is d / difference.
  const Number size = root_of(difference * difference + d * d);
  Number cosine = select(greater(size, of(1e-18)), size_of(difference) + size, of(1)),
         sine = signed_as(d, difference);
  const Number scale = of(1) / root_of(cosine * cosine + sine * sine);
  cosine *= scale, sine *= scale;
  for (int j = 0; j < 3; ++j) {
    axes[0][j] = a[j];
    axes[1][j] = cosine * u[j] + sine * v[j];
    axes[2][j] = cosine * v[j] - sine * u[j];
  }
}

/// The moments of simplices: the integrals of the point (x, y, z, 1 in `first`), and of xx, yy, zz and yz,
/// zx, xy.
template <class Vector>
struct Moments {
  Vector first{}, squares{}, products{};

  Moments() = default;
  Moments(Vector first_, Vector squares_, Vector products_)
      : first(first_), squares(squares_), products(products_) {}

  /// Of one simplex, with a weight of twice its area plus a constant, so that segments and points count.
  /// Exact for the triangle: mean (p + q + r) / 3, second moments (sum^2 + p^2 + q^2 + r^2) / 12.
  template <class Scalar>
  Moments(Vector p, Vector q, Vector r, Scalar corner_weight) {
    const Vector u = q - p, v = r - p, t = p + q + r, normal = next(u) * last(v) - last(u) * next(v);
    const Vector square = normal * normal;
    const Scalar weight =
        static_cast<Scalar>(root_of(double{square[0] + square[1] + square[2]})) + corner_weight;
    first = t * (weight * static_cast<Scalar>(1.0 / 3));
    first[3] = weight;
    const Vector part = Vector{} + weight * static_cast<Scalar>(1.0 / 12);
    squares = part * (t * t + p * p + q * q + r * r);
    products = part * (next(t) * last(t) + next(p) * last(p) + next(q) * last(q) + next(r) * last(r));
  }
  void operator+=(const Moments& x) { first += x.first, squares += x.squares, products += x.products; }
  Moments operator-(const Moments& x) const {
    return {first - x.first, squares - x.squares, products - x.products};
  }
  static Vector next(Vector x) { return __builtin_shufflevector(x, x, 1, 2, 0, 3); }
  static Vector last(Vector x) { return __builtin_shufflevector(x, x, 2, 0, 1, 3); }
};

/// Some points of a node in float, relative to its origin and scaled to about 1; a multiple of eight.
struct Sample {
  static constexpr std::uint32_t kMax = 512;
  alignas(32) float x[3][kMax];
  std::uint32_t count;
};

/// cos(90 k / 16 degrees).
constexpr float kCosine[17] = {1.00000000f, 0.99518473f, 0.98078528f, 0.95694034f, 0.92387953f, 0.88192126f,
                               0.83146961f, 0.77301045f, 0.70710678f, 0.63439328f, 0.55557023f, 0.47139674f,
                               0.38268343f, 0.29028468f, 0.19509032f, 0.09801714f, 0.00000000f};

/// Turns axes about the shortest side of the box of some points, to the smallest of 16 boxes.
inline void turn_axes(const Sample& sample, double (&axes)[3][3]) {
  alignas(32) float seen[3][Sample::kMax];
  float side[3];
  for (int i = 0; i < 3; ++i) {
    const Float8 a = splat(static_cast<float>(axes[i][0])), b = splat(static_cast<float>(axes[i][1])),
                 c = splat(static_cast<float>(axes[i][2]));
    Float8 low = splat(__builtin_inff()), high = -low;
    for (std::uint32_t k = 0; k < sample.count; k += 8) {
      const Float8 y = a * load8(sample.x[0] + k) + b * load8(sample.x[1] + k) + c * load8(sample.x[2] + k);
      __builtin_memcpy(seen[i] + k, &y, sizeof y);
      low = smaller(low, y), high = larger(high, y);
    }
    side[i] = largest_of(high) - lowest_of(low);
  }
  int about = side[1] < side[0] ? 1 : 0;
  if (side[2] < side[about]) about = 2;
  const int i = (about + 1) % 3, j = (about + 2) % 3;
  // An angle in each lane.
  Float8 cosine[2], sine[2], low_x[2], high_x[2], low_y[2], high_y[2];
  for (int half = 0; half < 2; ++half) {
    for (int k = 0; k < 8; ++k) {
      cosine[half][k] = kCosine[8 * half + k];
      sine[half][k] = kCosine[16 - 8 * half - k];
    }
    low_x[half] = low_y[half] = splat(__builtin_inff());
    high_x[half] = high_y[half] = -low_x[half];
  }
  for (std::uint32_t k = 0; k < sample.count; ++k) {
    const Float8 u = splat(seen[i][k]), v = splat(seen[j][k]);
    for (int half = 0; half < 2; ++half) {
      const Float8 x = u * cosine[half] + v * sine[half], y = v * cosine[half] - u * sine[half];
      low_x[half] = smaller(low_x[half], x), high_x[half] = larger(high_x[half], x);
      low_y[half] = smaller(low_y[half], y), high_y[half] = larger(high_y[half], y);
    }
  }
  int best = 0;
  float least = __builtin_inff();
  for (int half = 0; half < 2; ++half) {
    const Float8 area =
        half_area_of(high_x[half] - low_x[half], high_y[half] - low_y[half], splat(side[about]));
    for (int k = 0; k < 8; ++k)
      if (area[k] < least) least = area[k], best = 8 * half + k;
  }
  const double c = kCosine[best], s = kCosine[16 - best], norm = 1 / __builtin_sqrt(c * c + s * s);
  for (int k = 0; k < 3; ++k) {
    const double x = axes[i][k], y = axes[j][k];
    axes[i][k] = (c * x + s * y) * norm;
    axes[j][k] = (c * y - s * x) * norm;
  }
}

/// Returns true if the rows are as orthonormal as kKernelRounding assumes; false for NaN.
inline bool are_orthonormal(const double (&axes)[3][3]) {
  for (int i = 0; i < 3; ++i) {
    double row = 0;
    for (int j = 0; j < 3; ++j) {
      const double product = axes[i][0] * axes[j][0] + axes[i][1] * axes[j][1] + axes[i][2] * axes[j][2];
      row += __builtin_fabs(product - (i == j));
    }
    if (!(row <= kFrameDefect)) return false;
  }
  return true;
}

/// The axes of a node: principal axes, turned; the coordinate axes if there are none. Rounded to float
/// before they are evaluated, as the query uses them.
struct NodeAxes {
  double row[3][3];
  bool straight = false;

  NodeAxes(const double* moments, const Sample& sample) {
    find_axes(moments[0], moments[1], moments[2], moments[3], moments[4], moments[5], 1e-300, row);
    turn_axes(sample, row);
    for (auto& axis : row)
      for (double& x : axis) x = rounded_to_float(x);
    if (!are_orthonormal(row)) straighten();
  }
  void straighten() {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) row[i][j] = i == j;
    straight = true;
  }
};

/// Returns the next float below or above a finite one.
inline float next_below(float x) {
  std::int32_t bits;
  __builtin_memcpy(&bits, &x, sizeof x);
  // The bits of a positive float grow with it, those of a negative one fall.
  bits = x > 0 ? bits - 1 : x < 0 ? bits + 1 : static_cast<std::int32_t>(0x80000001);
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}
inline float next_above(float x) {
  return -next_below(-x);
}

/// Boxes of up to eight children in a node's frame, rounded to float. Absent ones repeat another.
struct ChildBoxes {
  Float8 low[3], high[3];
};

/// Writes everything but `first` and `is_leaf` of a node.
inline void quantize(const ChildBoxes& boxes, const NodeAxes& axes, const double* origin, std::uint32_t count,
                     TreeNode& node) {
  __builtin_memset(static_cast<void*>(&node), 0, sizeof node);
  double low[3], high[3], far[3];
  for (int i = 0; i < 3; ++i) {
    low[i] = static_cast<double>(lowest_of(boxes.low[i]));
    high[i] = static_cast<double>(largest_of(boxes.high[i]));
    far[i] = larger(-low[i], high[i]);
  }
  // Covers the rounding of the projection (under 2^-50) and to float (2^-24), that of the enlarged ends
  // (2^-24) and of decoding (2^-22), relative to the coordinates.
  const double margin = kTreeRounding * longest_of(Double4{far[0], far[1], far[2], 0}) + kTreeRoundingUnits;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) node.frame[i][j] = static_cast<float>(axes.row[i][j]);
    node.origin[i] = origin[i];
    // The range is widened by twice the margin: boxes are enlarged by one margin, and the codes must still
    // cover them.
    const double from = low[i] - 2 * margin, to = high[i] + 2 * margin;
    const float base = node.base[i] = next_below(static_cast<float>(from));
    const float scale = node.scale[i] =
        next_above(static_cast<float>((to - static_cast<double>(base)) / kQuantizedMost));
    const Float8 x = boxes.low[i] - splat(static_cast<float>(margin)),
                 y = boxes.high[i] + splat(static_cast<float>(margin)), per_unit = splat(1 / scale);
    const auto decode = [&](Float8 q) { return splat(base) + splat(scale) * q; };
    // Start one code too high and step down until the decoded value is at or below x; the mirror image for
    // y. The float decoding itself decides, so its rounding need not be estimated. Codes are whole floats.
    const Float8 one = splat(1), most = splat(kQuantizedMost);
    const auto whole = [](Float8 q) {
      return __builtin_convertvector(__builtin_convertvector(q, Int8), Float8);
    };
    Float8 q = smaller(whole((x - splat(base)) * per_unit) + one, most),
           r = larger(whole((y - splat(base)) * per_unit) - one, Float8{});
    for (;;) {
      const Lanes above = both(greater(decode(q), x), greater(q, Float8{})),
                  below = both(greater(y, decode(r)), greater(most, r));
      if ((bits(above) | bits(below)) == 0) break;
      q = select(above, q - one, q);
      r = select(below, r + one, r);
    }
    const Int8 codes[2] = {__builtin_convertvector(q, Int8), __builtin_convertvector(r, Int8)};
    // Absent children have lo > hi.
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      node.lo[i][k] = static_cast<std::uint8_t>(k < count ? codes[0][k] : kQuantizedMost);
      node.hi[i][k] = static_cast<std::uint8_t>(k < count ? codes[1][k] : 0);
    }
  }
  node.count = static_cast<std::uint8_t>(count);
  // The origin is 0 in this frame, so the farthest corner of the common box bounds the radius.
  node.radius = next_above(
      static_cast<float>(__builtin_sqrt(far[0] * far[0] + far[1] * far[1] + far[2] * far[2]) + 2 * margin));
}

}  // namespace
}  // namespace lrb
