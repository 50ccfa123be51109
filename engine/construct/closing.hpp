#pragma once
/// The outermost wrapper: a closed surface of few triangles around everything.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/complex_builder.hpp"
#include "engine/construct/front_mesh.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb::construct {

/// Bridging does what patches cannot: it closes holes, fills deep concavities and connects components. Covers
/// the concavities of a set of components with the faces of their convex hull: the pockets in between become
/// regions of this layer, and the components become one. `joined` (components): the components to cover.
/// Changes nothing, and returns the reason, if the front would not become simpler, or if faces of the convex
/// hull would intersect others (coplanar vertices). Reports the cap and its regions to `probe`, if not null.
CapVerdict bridge_concavities(FrontMesh& front, ComplexBuilder& complex, const std::vector<bool>& joined,
                              std::uint16_t layer, ConstructProbe* probe);

/// Returns a convex polytope of at most max(max_faces, 4) triangles around the points, or an empty mesh if
/// the coordinates are too large. The points keep a distance of at least a quarter of `distance` times their
/// largest extent from its faces (up to rounding; confirm with holds()).
///
/// Moves the convex hull of the points outward, simplifies it in two ways (simplify_polytope()), makes the
/// results convex, and keeps the tighter one. Jacobson, "Progressive Convex Hull Simplification",
/// 2026, removes half-spaces instead, but a plane there costs up to four triangles, and here one.
Mesh enclosing_polytope(std::span<const Eigen::Vector3d> points, std::uint32_t max_faces, double distance,
                        Workers& workers);

/// Returns true if the point is strictly behind all faces of a triangle mesh. Exact.
bool holds(const Mesh& convex, const Eigen::Vector3d& point);

/// Returns the volume behind a closed triangle mesh; mesh units cubed.
double volume_of(const Mesh& mesh);

/// Returns a convex polytope of at most `max_faces` triangles around a convex triangle mesh, up to rounding,
/// with a small volume, or an empty mesh if none is found.
///
/// In each step some edges collapse outward (outward_collapse.hpp; `depth` is described there). This
/// requires more than necessary: the new vertex is in front of all faces that are removed. Therefore each
/// vertex is then moved to the position of least volume with the input still behind the faces around it, and
/// the result is made convex again.
Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth);

}  // namespace lrb::construct
