// Sign of an enclosed volume, exactly: a sum of determinants (divergence theorem), first in doubles with an
// error bound, then in integers if the bound cannot decide. Doubles become integers by a common power of two.
#include "engine/mesh/volume_sign.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/multiprecision/cpp_int.hpp>

namespace lrb {
namespace {

using boost::multiprecision::cpp_int;

/// Calls visit(a, b, c) for each triangle of the faces' fans; in 2D visit(a, b, b) for each segment.
template <class Visit>
void for_each_simplex(const Mesh& mesh, std::span<const FaceId> faces, Visit visit) {
  for (const FaceId f : faces) {
    const auto c = mesh.face(f);
    if (mesh.dim == 2) {
      visit(c[0], c[1], c[1]);
      continue;
    }
    for (std::size_t i = 1; i + 1 < c.size(); ++i) visit(c[0], c[i], c[i + 1]);
  }
}

/// Returns the sign computed in doubles, if the sum is beyond what rounding can have done to it; else 0.
/// Volumes do not depend on the origin, and an origin on the body keeps the terms small.
///
/// Error, with u = 2^-53 and n terms (products of three differences): a difference has relative error u, a
/// term three of those and two of its own, and adding n terms up to n - 1; together below (n + 8) u times the
/// sum of the terms' absolute values. The bound is twice that, which covers the rounding of that very sum,
/// and underflow too: with differences below kLarge it changes a term by at most 2^-1075 kLarge, all 2^35
/// terms by less than 2^-800, and the bound is above 2^-750 where the sum is above kTiny.
int sign_by_doubles(const Mesh& mesh, std::span<const FaceId> faces) {
  const Eigen::Vector3d& origin = mesh.vertices[mesh.face(faces[0])[0]];
  double sum = 0, size = 0, n = 0, largest = 0;
  const auto term = [&](double x, double y, double z) {
    sum += x * y * z;
    size += std::abs(x * y * z);
  };
  // Determinant of three edges from the origin, expanded to six products. In 2D the third is the unit vector
  // along z.
  for_each_simplex(mesh, faces, [&](VertexId ia, VertexId ib, VertexId ic) {
    const Eigen::Vector3d a = mesh.vertices[ia] - origin, b = mesh.vertices[ib] - origin;
    const Eigen::Vector3d c = mesh.dim == 2 ? Eigen::Vector3d(0, 0, 1) : mesh.vertices[ic] - origin;
    term(a.x(), b.y(), c.z());
    term(-a.y(), b.x(), c.z());
    term(a.y(), b.z(), c.x());
    term(-a.z(), b.y(), c.x());
    term(a.z(), b.x(), c.y());
    term(-a.x(), b.z(), c.y());
    largest = std::max({largest, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
    n += 6;
  });
  static constexpr double kU = 0x1p-53, kTiny = 0x1p-700, kLarge = 0x1p200;
  const double bound = 2 * (n + 8) * kU * size;
  // Outside this range underflow or overflow could invalidate the bound. Also catches NaN.
  if (!(size > kTiny) || !(largest < kLarge)) return 0;
  if (sum > bound) return 1;
  return sum < -bound ? -1 : 0;
}

/// Doubles as integers: all coordinates multiplied by one power of two.
class IntegerPoints {
 public:
  IntegerPoints(const Mesh& mesh, std::span<const FaceId> faces) : mesh_(mesh) {
    for (const FaceId f : faces)
      for (const VertexId v : mesh.face(f))
        // The smallest exponent of a last bit among all coordinates: every coordinate is a multiple of it.
        for (const double x : mesh.vertices[v])
          if (x != 0) shift_ = std::min(shift_, std::ilogb(x) - 52);
  }

  cpp_int operator()(VertexId v, int axis) const {
    const double x = mesh_.vertices[v][axis];
    if (x == 0) return 0;
    const int exponent = std::ilogb(x) - 52;  // exponent of the last of its 53 bits
    // The 53-bit significand as an integer, then shifted to the common exponent.
    cpp_int value = static_cast<std::int64_t>(std::ldexp(x, -exponent));
    value <<= exponent - shift_;
    return value;
  }

 private:
  const Mesh& mesh_;
  int shift_ = std::numeric_limits<int>::max();
};

int sign_by_integers(const Mesh& mesh, std::span<const FaceId> faces) {
  const IntegerPoints at(mesh, faces);
  cpp_int sum = 0;
  for_each_simplex(mesh, faces, [&](VertexId a, VertexId b, VertexId c) {
    // Scaling does not change the sign, so the shift need not be undone. The origin is zero: no differences
    // are needed.
    const cpp_int xy = at(a, 0) * at(b, 1) - at(a, 1) * at(b, 0);
    if (mesh.dim == 2) {
      sum += xy;
      return;
    }
    sum += xy * at(c, 2) + (at(a, 1) * at(b, 2) - at(a, 2) * at(b, 1)) * at(c, 0) +
           (at(a, 2) * at(b, 0) - at(a, 0) * at(b, 2)) * at(c, 1);
  });
  return sum.sign();
}

}  // namespace

int volume_sign(const Mesh& mesh, std::span<const FaceId> faces) {
  if (faces.empty()) return 0;
  const int quick = sign_by_doubles(mesh, faces);
  return quick != 0 ? quick : sign_by_integers(mesh, faces);
}

}  // namespace lrb
