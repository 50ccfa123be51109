#pragma once
/// Makes bodies for tests. Unless its comment says otherwise a body is closed, manifold, free of
/// self-intersections and oriented outward (2D: the solid on the left of every segment). The same arguments
/// give the same mesh.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/mesh/mesh.hpp"

namespace lrb::shapes {

using Point2 = Eigen::Vector2d;
using Point3 = Eigen::Vector3d;

// Boxes and the like.
Mesh tetrahedron(double size = 1);  ///< corners at 0 and on the axes; 4 triangles
Mesh box(const Point3& low = {0, 0, 0}, const Point3& high = {1, 1, 1});       ///< 12 triangles
Mesh quad_box(const Point3& low = {0, 0, 0}, const Point3& high = {1, 1, 1});  ///< 6 quads
/// Makes the boundary of the unit cells (i, j, k), 0 <= i < nx and so on, for which `solid` holds, in
/// triangles. Cells that meet only in an edge or vertex make it non-manifold.
Mesh voxels(int nx, int ny, int nz, const std::function<bool(int, int, int)>& solid, bool quads = false);
Mesh l_shape();                        ///< three unit cells in an L
Mesh comb(int teeth, int length = 4);  ///< a row of cells with a tooth of `length` cells on every second one
Mesh box_with_void();                  ///< 3 x 3 x 3 cells without the middle one: two components, one a void

// Round bodies.
Mesh icosphere(int level, double radius = 1, const Point3& centre = {0, 0, 0});  ///< 20 * 4^level triangles
Mesh bumpy_sphere(int level, std::uint64_t seed,
                  double amplitude = 0.2);  ///< star-shaped about 0, radius about 1
/// Makes a surface of revolution about z: `profile` lists (radius, z) from the lower pole to the upper one,
/// both on the axis and the others off it; triangles.
Mesh revolve(const std::vector<Point2>& profile, int slices);
Mesh uv_sphere(int slices, int stacks, double radius = 1);
/// Makes a thick hemispherical shell about 0, open to +z: outer radius 1, inner radius 1 - thickness.
Mesh bowl(int slices, int stacks, double thickness = 0.2);
Mesh torus(int n, int m, double major = 1, double minor = 0.4);  ///< n round the axis, m round the tube
Mesh quad_torus(int n, int m, double major = 1,
                double minor = 0.4);  ///< the same in quads (hardly ever planar)
Mesh open_cylinder(int slices);       ///< the mantle alone: NOT closed

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
