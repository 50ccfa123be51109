#pragma once
/// A surface with fewer faces: edges collapse, cheapest first.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.hpp"

namespace lrb::resolutions {

/// The surface with at most targets[i] triangles, for each i (descending), all from one run of collapses.
///
/// Quadric error metric (Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997).
/// Unlike theirs, the surface stays embedded: a collapse is done only if its edge's link allows it, and if,
/// exactly, the triangles that it makes meet nothing of the surface in more than they share. So what comes
/// out is closed, of the same genus, and free of self-intersections where `mesh` is. What cannot go down to a
/// target stays above it: a component keeps four triangles, a handle more.
///
/// `mesh` as MeshReport::buildable() wants it, in 3D. Polygons come out as triangles. Deterministic.
std::vector<Mesh> decimate(const Mesh& mesh, std::span<const std::uint32_t> targets);

}  // namespace lrb::resolutions
