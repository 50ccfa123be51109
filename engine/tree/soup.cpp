// The simplices of a tree in its unit, and frames that fit some of them: principal axes of the covariance of
// the surface's points, not of the vertices, so that the tessellation does not matter (Gottschalk, Lin and
// Manocha 1996).

#include "engine/tree/soup.hpp"

#include <cmath>
#include <numeric>

#include "engine/core/eigenvectors.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/pose_bounds.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

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
