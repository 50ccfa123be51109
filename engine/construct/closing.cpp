// The outermost wrapper: a convex polytope with few faces around the points.
// 1. Reduce the points to those near their convex hull.
// 2. Replace each by a small tetrahedron: the hull of these is the hull moved outward.
// 3. Simplify that hull outward with two settings (polytope_simplify.hpp).
// 4. Keep the candidate of least volume that contains all points, tested exactly. A box is the fallback.

#include "engine/construct/closing.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/construct/convex_hull.hpp"
#include "engine/construct/polytope_simplify.hpp"
#include "engine/core/random.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

/// Returns a number from 0 to 1, the same sequence on every machine.
double fraction(Random& random) {
  return static_cast<double>(random.below(1u << 16)) * 0x1p-16;
}

/// Returns the points on the convex hull, and perhaps some within `distance` of it. All others are within
/// that distance of the hull of those returned. (A perturbation brings the points into general position
/// first, where Quickhull is fast.)
std::vector<Vector3> outermost(std::span<const Vector3> points, double distance) {
  // A fixed seed: the same points are kept on every machine.
  Random random(1);
  std::vector<Vector3> moved;
  for (const Vector3& p : points) {
    const double dx = fraction(random), dy = fraction(random), dz = fraction(random);
    // Shifts of two points differ by at most distance / 2 in each coordinate, that is by 0.87 distance.
    moved.push_back(p + distance / 2 * Vector3(dx, dy, dz));
  }
  std::vector<bool> used(points.size(), false);
  const auto hull = convex_hull(moved);
  // Keep the original points of the perturbed hull's vertices. Without a hull (coplanar points) keep all.
  for (const auto& t : hull)
    for (const std::uint32_t v : t) used[v] = true;
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (used[i] || hull.empty()) out.push_back(points[i]);
  return out;
}

/// Returns four points around each point: their hull holds every point with at least a quarter of `distance`
/// to spare, and they are in general position.
std::vector<Vector3> tetrahedra_about(std::span<const Vector3> points, double distance) {
  static const Vector3 kCorners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  Random random(1);
  std::vector<Vector3> out;
  // The regular tetrahedron has the inradius 0.577 distance. The jitter takes at most 0.173 of it, and the
  // points that outermost() dropped 0.125, so that more than a quarter is left.
  for (const Vector3& p : points)
    for (const Vector3& c : kCorners) {
      const double dx = fraction(random), dy = fraction(random), dz = fraction(random);
      out.push_back(p + distance * (c + 0.1 * Vector3(dx, dy, dz)));
    }
  return out;
}

Mesh box_about(const Eigen::AlignedBox3d& box) {
  std::vector<Vector3> corners;
  // Bits 0, 1 and 2 of a corner's index choose the upper end in x, y and z.
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? box.max().x() : box.min().x(), i & 2 ? box.max().y() : box.min().y(),
                         i & 4 ? box.max().z() : box.min().z());
  Mesh mesh;
  // Two triangles per side, counter-clockwise seen from outside.
  mesh.vertices = corners;
  for (const std::array<VertexId, 3>& t : std::array<std::array<VertexId, 3>, 12>{{{0, 2, 1},
                                                                                   {1, 2, 3},
                                                                                   {4, 5, 6},
                                                                                   {5, 7, 6},
                                                                                   {0, 1, 4},
                                                                                   {1, 5, 4},
                                                                                   {2, 6, 3},
                                                                                   {3, 6, 7},
                                                                                   {0, 4, 2},
                                                                                   {2, 4, 6},
                                                                                   {1, 3, 5},
                                                                                   {3, 7, 5}}})
    mesh.add_face(t);
  return mesh;
}

}  // namespace

double volume_of(const Mesh& mesh) {
  // Divergence theorem, relative to a vertex to limit cancellation.
  double sixfold = 0;
  const Vector3 origin = mesh.vertices[0];
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto c = mesh.face(f);
    sixfold += (mesh.vertices[c[0]] - origin)
                   .dot((mesh.vertices[c[1]] - origin).cross(mesh.vertices[c[2]] - origin));
  }
  return sixfold / 6;
}

bool holds(const Mesh& convex, const Vector3& point) {
  for (FaceId f = 0; f < convex.face_count(); ++f) {
    // Exact, so rounding in the construction of the polytope cannot let a point through its faces.
    const auto c = convex.face(f);
    const auto at = [&](int i) { return convex.vertices[c[i]].data(); };
    if (exact::orient3d(at(0), at(1), at(2), point.data()) >= 0) return false;
  }
  return true;
}

Mesh enclosing_polytope(std::span<const Vector3> points, std::uint32_t max_faces, double distance,
                        Workers& workers) {
  // The fallback and the yardstick: the bounding box, grown by the distance.
  Eigen::AlignedBox3d box;
  for (const Vector3& p : points) box.extend(p);
  distance *= box.sizes().maxCoeff();
  box.min().array() -= distance;
  box.max().array() += distance;
  // Products of coordinates would overflow: no wrapper.
  if (!std::isfinite(box.volume() * box.volume())) return {};
  Mesh best = box_about(box);
  // Steps 1 and 2.
  const Mesh convex = convex_hull_mesh(tetrahedra_about(outermost(points, distance / 8), distance));
  if (convex.face_count() == 0) return best;
  double least = volume_of(best);
  std::array<Mesh, 2> simplified;
  // Which depth gives the tighter polytope depends on the shape. Both run at the same time.
  workers.both([&] { simplified[0] = simplify_polytope(convex, max_faces, 2); },
               [&] { simplified[1] = simplify_polytope(convex, max_faces, 8); });
  // The order of this loop is fixed, so the result does not depend on the number of threads.
  for (Mesh& polytope : simplified) {
    if (polytope.face_count() == 0 || volume_of(polytope) >= least) continue;
    if (!std::all_of(points.begin(), points.end(), [&](const Vector3& p) { return holds(polytope, p); }))
      continue;
    least = volume_of(polytope);
    best = std::move(polytope);
  }
  return best;
}

}  // namespace lrb::construct
