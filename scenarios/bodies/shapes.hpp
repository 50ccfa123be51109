#pragma once
/// Makes bodies for tests. Unless stated otherwise a body is closed, manifold, free of self-intersections and
/// oriented outward (2D: the solid on the left of every segment). The same arguments give the same mesh.

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/core/random.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::shapes {

// LRB-reps small enough to check by hand, made without a builder.

/// Returns a box [0, 4] x [0, 4] x [0, 2] whose top has a dent [1, 3] x [1, 3], 1 deep, under a lid: one
/// region of volume 4. Triangles; real volume 28, outermost wrapper 32.
LrbRep dented_box();

/// Returns a 2D staircase under two nested lids: region 1 (layer 1) hides region 0 (layer 0). Segments; real
/// area 10, 10.5 with region 0, 16 with both.
LrbRep stairs_2d();

using RandomEngine = std::mt19937_64;

/// Draws uniformly from [0, 1). Own code, because the standard library's distributions differ between
/// implementations.
inline double uniform(RandomEngine& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}
inline double uniform(RandomEngine& random, double low, double high) {
  return low + (high - low) * uniform(random);
}

inline Eigen::Vector3d random_direction(RandomEngine& random) {
  while (true) {
    // Braces are evaluated in order, so that every compiler draws the same numbers.
    const Eigen::Vector3d d{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    if (d.norm() > 0.1 && d.norm() <= 1) return d.normalized();
  }
}

inline Eigen::Matrix3d random_rotation(RandomEngine& random, int dim = 3) {
  const double angle = uniform(random, 0, 6.283185307179586);
  return deterministic::rotation(dim == 2 ? Eigen::Vector3d::UnitZ() : random_direction(random), angle);
}

inline Eigen::AlignedBox3d box_of(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box;
}

/// Draws a random rotation, and a translation such that the distance of the boxes' centres is about `share`
/// times the sum of their radii: 1 just misses round bodies, 0 puts one inside the other.
inline Pose random_pose(RandomEngine& random, const LrbRep& a, const LrbRep& b, double share) {
  const Eigen::AlignedBox3d box_a = box_of(a), box_b = box_of(b);
  Pose p;
  p.r = random_rotation(random, a.dim());
  Eigen::Vector3d d = random_direction(random);
  if (a.dim() == 2) d = Eigen::Vector3d(d.x(), d.y(), 0).normalized();
  p.t = box_a.center() - p.r * box_b.center() +
        share * (box_a.diagonal().norm() + box_b.diagonal().norm()) / 2 * d;
  if (a.dim() == 2) p.t.z() = 0;
  return p;
}

using Point2 = Eigen::Vector2d;
using Point3 = Eigen::Vector3d;

// Boxes and other small polyhedra.
Mesh tetrahedron(double size = 1);  ///< corners at 0 and on the axes; 4 triangles
Mesh box(const Point3& low = {0, 0, 0}, const Point3& high = {1, 1, 1});       ///< 12 triangles
Mesh quad_box(const Point3& low = {0, 0, 0}, const Point3& high = {1, 1, 1});  ///< 6 quads
/// Makes the boundary of the unit cells (i, j, k), 0 <= i < nx and so on, for which `solid` returns true, in
/// triangles. Cells that share only an edge or vertex make it non-manifold.
Mesh voxels(int nx, int ny, int nz, const std::function<bool(int, int, int)>& solid, bool quads = false);
Mesh l_shape();                        ///< three unit cells in an L
Mesh comb(int teeth, int length = 4);  ///< cells in a row with a tooth of `length` cells on every second one
Mesh box_with_void();  ///< 3 x 3 x 3 cells without the central one: two components, one a void

/// Splits every triangle into four, with new vertices at the edges' midpoints.
Mesh subdivided(const Mesh& mesh);

// Round bodies.
Mesh icosphere(int level, double radius = 1, const Point3& centre = {0, 0, 0});  ///< 20 * 4^level triangles
Mesh bumpy_sphere(int level, std::uint64_t seed,
                  double amplitude = 0.2);  ///< star-shaped about 0, radius about 1
/// Makes a surface of revolution about z: `profile` lists (radius, z) from the lower pole to the upper one,
/// these two on the axis and the others not; triangles.
Mesh revolve(const std::vector<Point2>& profile, int slices);
Mesh uv_sphere(int slices, int stacks, double radius = 1);
/// Makes a thick hemispherical shell about 0, open to +z: outer radius 1, inner radius 1 - thickness.
Mesh bowl(int slices, int stacks, double thickness = 0.2);
Mesh torus(int n, int m, double major = 1, double minor = 0.4);  ///< n around the axis, m around the tube
Mesh quad_torus(int n, int m, double major = 1,
                double minor = 0.4);  ///< the same in quads (hardly ever planar)
Mesh open_cylinder(int slices);       ///< the lateral surface alone: NOT closed

Mesh icosahedron();  ///< of edges 2

// Polygons in the plane z = 0 (dim 2).
Mesh polygon(const std::vector<Point2>& corners);  ///< as given; counter-clockwise to be oriented outward
Mesh circle(int corners, double radius = 1);
Mesh star(int points, double outer = 1, double inner = 0.4);
Mesh gear(int teeth, double outer = 1, double inner = 0.8);
Mesh comb_2d(int teeth, double length = 4);
Mesh l_shape_2d();
Mesh ring_2d(int corners);  ///< a circle with a circular hole: two components

// Bodies made from others.
Mesh several(const std::vector<Mesh>& meshes);  ///< all of them, vertices and faces appended in order
Mesh turned_inside_out(Mesh mesh);
Mesh translated(Mesh mesh, const Point3& by);
Mesh scaled(Mesh mesh, double by);  ///< by > 0

}  // namespace lrb::shapes
