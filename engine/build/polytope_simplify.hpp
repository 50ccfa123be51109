#pragma once

#include <cstdint>

#include "engine/mesh/mesh.hpp"

namespace lrb {

/// A closed surface of at most `max_faces` triangles (or none, if that cannot be had) about a convex mesh of triangles, every
/// face of which has all the mesh's vertices behind it, to rounding; small in volume.
///
/// Edges collapse outward as in patches (patch_cap.hpp; `depth` as there). That asks for more than is needed, namely to
/// stay in front of faces that go; so what comes out is tightened: vertices are moved one by one to where volume is
/// least as long as the mesh is behind the faces about them, until it no longer pays.
Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth);

}  // namespace lrb
