#pragma once
/// The outermost wrapper: a closed surface of few triangles around everything.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/core/parallel.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Returns a convex polytope of at most `max_faces` triangles (12 if fewer are asked for: a box) around the
/// points, which keep a distance of at least a quarter of `distance` times their largest extent from its
/// faces (to rounding; confirm with holds()). Empty if the coordinates are too large for that.
///
/// Moves the convex hull of the points outward, simplifies it (polytope_simplify.hpp) in a few ways, of which
/// the tightest wins, and makes the result convex. Jacobson, "Progressive Convex Hull Simplification", 2026,
/// removes half-spaces instead; but there a plane costs up to four triangles, and here one.
Mesh enclosing_polytope(std::span<const Eigen::Vector3d> points, std::uint32_t max_faces, double distance,
                        Workers& workers);

/// Returns true if the point lies strictly behind all faces of a mesh of triangles. Exact.
bool holds(const Mesh& convex, const Eigen::Vector3d& point);

/// Returns the volume behind a closed mesh of triangles; unit cubed.
double volume_of(const Mesh& mesh);

}  // namespace lrb::construct
