#pragma once

#include <cstdint>

#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// A convex polytope of at most `max_faces` triangles about a convex mesh of triangles, to rounding; small in
/// volume. Empty if it cannot be had.
///
/// In each step some edges collapse outward as in patches (patch_cap.hpp; `depth` as there). That asks for
/// more than is needed, namely to stay in front of the faces that go; so then vertices are moved one by one
/// to where volume is least as long as the mesh is behind the faces about them, and the whole is made convex
/// again.
Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth);

}  // namespace lrb::construct
