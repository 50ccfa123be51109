#pragma once
/// The outermost wrapper: a closed surface of few triangles around everything.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/complex_builder.hpp"
#include "engine/construct/hull_mesh.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb::construct {

// Bridging does what patches cannot: it closes holes, fills deep concavities, joins components.

/// Covers the concavities of a set of components with the faces of their convex hull: the pockets between
/// become regions of this layer, and the components become one. `joined` (components): which ones to cover.
/// Does nothing and returns why if that would not make the surface simpler, or if faces of the convex hull
/// would meet others (vertices in one plane). Tells `probe` of the cap and its regions, if there is one.
CapVerdict bridge_concavities(HullMesh& hull, ComplexBuilder& complex, const std::vector<bool>& joined,
                              std::uint16_t layer, ConstructProbe* probe);

/// Returns a convex polytope of at most `max_faces` triangles (12 if fewer are asked for: a box) around the
/// points, which keep a distance of at least a quarter of `distance` times their largest extent from its
/// faces (to rounding; confirm with holds()). Empty if the coordinates are too large for that.
///
/// Moves the convex hull of the points outward, simplifies it (simplify_polytope()) in a few ways, of which
/// the tightest wins, and makes the result convex. Jacobson, "Progressive Convex Hull Simplification", 2026,
/// removes half-spaces instead; but there a plane costs up to four triangles, and here one.
Mesh enclosing_polytope(std::span<const Eigen::Vector3d> points, std::uint32_t max_faces, double distance,
                        Workers& workers);

/// Returns true if the point lies strictly behind all faces of a mesh of triangles. Exact.
bool holds(const Mesh& convex, const Eigen::Vector3d& point);

/// Returns the volume behind a closed mesh of triangles; unit cubed.
double volume_of(const Mesh& mesh);

/// Returns a convex polytope of at most `max_faces` triangles around a convex mesh of triangles, to rounding,
/// with a small volume. Empty if there is none to be found.
///
/// In each step some edges collapse outward as in patches (patch_cap.hpp; `depth` as there). That asks for
/// more than is needed, namely to stay in front of the faces that go; so afterwards vertices are moved one by
/// one to where the volume is least as long as the mesh is behind the faces around them, and the whole is
/// made convex again.
Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth);

}  // namespace lrb::construct
