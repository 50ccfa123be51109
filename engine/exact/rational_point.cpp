#include "engine/exact/rational_point.hpp"

#include <utility>

#include "engine/core/infinity.hpp"

namespace lrb::exact {

RationalPoint::Coordinates::Coordinates(RationalVec coordinates) : x(std::move(coordinates)) {
  // The conversion is off by an ulp at most. Step outwards until the doubles provably enclose the coordinate.
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = high[k] = x[k].convert_to<double>();
    while (to_rational(low[k]) > x[k]) low[k] = std::nextafter(low[k], -kInfinity);
    while (to_rational(high[k]) < x[k]) high[k] = std::nextafter(high[k], kInfinity);
  }
}

RationalPoint::RationalPoint(const double* p, int dim)
    : coordinates_(std::make_shared<const Coordinates>(to_rational(p, dim))) {}

RationalPoint RationalPoint::midpoint(const RationalPoint& a, const RationalPoint& b) {
  return make_point(between(a.coordinates().x, b.coordinates().x, Rational(1, 2)));
}

RationalPoint RationalPoint::combination(std::span<const RationalPoint> points,
                                         std::span<const double> weights) {
  // Weights are doubles, so sums and the quotient are exact rationals.
  RationalVec sum;
  Rational total = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Rational w = to_rational(weights[i]);
    for (std::size_t k = 0; k < 3; ++k) sum[k] += w * points[i].coordinates().x[k];
    total += w;
  }
  for (auto& s : sum) s /= total;
  return make_point(std::move(sum));
}

Eigen::Vector3d RationalPoint::rounded() const {
  return exact::rounded(coordinates_->x);
}

int orient2d(const double* a, const double* b, const RationalPoint& c) {
  return area_determinant(to_rational(a, 2), to_rational(b, 2), c.coordinates().x, 0, 1).sign();
}

int orient3d(const double* a, const double* b, const double* c, const RationalPoint& d) {
  return volume_determinant(to_rational(a), to_rational(b), to_rational(c), d.coordinates().x).sign();
}

}  // namespace lrb::exact
