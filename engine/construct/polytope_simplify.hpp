#pragma once

#include <cstdint>

#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Returns a convex polytope of at most `max_faces` triangles around a convex mesh of triangles, to rounding,
/// with a small volume. Empty if there is none to be found.
///
/// In each step some edges collapse outward as in patches (patch_cap.hpp; `depth` as there). That asks for
/// more than is needed, namely to stay in front of the faces that go; so afterwards vertices are moved one by
/// one to where the volume is least as long as the mesh is behind the faces around them, and the whole is
/// made convex again.
Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth);

}  // namespace lrb::construct
