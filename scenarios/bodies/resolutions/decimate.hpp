#pragma once
/// Reduces the faces of a surface: edges collapse, cheapest first.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.hpp"

namespace lrb::resolutions {

/// Returns the surface with at most targets[i] triangles, for each i (descending), all from one run of
/// collapses.
///
/// By the quadric error metric (Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics",
/// 1997). Unlike theirs, the surface stays embedded: an edge collapses only if its link allows it, and if the
/// new triangles, tested exactly, meet nothing of the surface in more than what they share. The result is
/// therefore closed, of the same genus, and free of self-intersections where `mesh` is. A surface that cannot
/// be reduced to a target stays above it: a component keeps four triangles, a handle more.
///
/// `mesh` must be 3D and as MeshReport::buildable() requires. Polygons come out as triangles. Deterministic.
std::vector<Mesh> decimate(const Mesh& mesh, std::span<const std::uint32_t> targets);

}  // namespace lrb::resolutions
