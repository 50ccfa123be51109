#pragma once
/// Makes one body at several resolutions.

#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/mesh.hpp>

namespace lrb::resolutions {

// Reduces the faces of a surface by edge collapses, cheapest first.

/// Returns the surface with at most targets[i] triangles, for each i (descending), all from one run of
/// collapses.
///
/// By the quadric error metric (Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics",
/// 1997). Unlike theirs, the surface stays embedded: an edge collapses only if its link allows it, and if the
/// new triangles, tested exactly, intersect the surface only in shared vertices and edges. The result is
/// therefore closed, of the same genus, and free of self-intersections if `mesh` is. A surface that cannot be
/// reduced to a target stays above it: a component keeps four triangles, a handle more.
///
/// `mesh` must be 3D and as MeshReport::buildable() requires. Polygons become triangles. Deterministic.
std::vector<Mesh> decimate(const Mesh& mesh, std::span<const std::uint32_t> targets);

struct ResolutionOptions {
  std::uint32_t subdivisions = 0;  ///< applied first; each replaces a face by four
  std::uint32_t most = 8;          ///< maximum number of resolutions
  std::uint32_t min_faces = 500;
};

/// Returns the numbers of triangles of the resolutions, the finest one first.
std::vector<std::uint32_t> resolution_sizes(const Mesh& mesh, const ResolutionOptions& options);

/// Returns the finest one first; each has half of the faces of the previous one. A polygon
/// mesh is triangulated. Throws InputError for a mesh that no LRB-rep can be built from.
std::vector<Mesh> resolutions(const Mesh& mesh, const ResolutionOptions& options);

/// Replaces each triangle by four and smooths the surface: Loop's scheme ("Smooth Subdivision Surfaces Based
/// on Triangles", 1987) with Warren's weights. `mesh` must consist of triangles and be closed, with two faces
/// at every edge. New vertices follow the old ones. Where parts of the surface are close to each other the
/// result may intersect itself, which check_mesh() detects.
Mesh subdivide(const Mesh& mesh);

}  // namespace lrb::resolutions
