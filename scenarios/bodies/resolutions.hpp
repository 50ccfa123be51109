#pragma once
/// Makes one body at several resolutions.

#include <cstdint>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::resolutions {

/// Returns the finest wrapper with at most `most` faces of those that include each region whose lids deviate
/// by no more than some bound; it is closed and encloses the body. Throws InputError if the outermost one has
/// more faces.
Wrapper wrapper_of_faces(const LrbRep& rep, std::uint32_t most);

struct ResolutionOptions {
  std::uint32_t subdivisions = 0;  ///< applied first; each replaces a face by four
  std::uint32_t most = 8;          ///< maximum number of resolutions
  std::uint32_t min_faces = 500;
};

/// Returns the numbers of triangles to aim at, the finest one first: each has half of the one before.
std::vector<std::uint32_t> resolution_sizes(const Mesh& mesh, const ResolutionOptions& options);

/// Returns the body at these sizes, the finest one first, in triangles. The coarser ones are wrappers of the
/// LRB-rep of the finest (wrapper_of_faces()): they enclose it, are closed and do not intersect themselves
/// unless it does; holes may be filled. Ends before a size without a wrapper of at least three quarters of
/// it: voids keep their faces. Deterministic. Throws InputError for a mesh that no LRB-rep can be built from.
std::vector<Mesh> resolutions(const Mesh& mesh, const ResolutionOptions& options);

/// Replaces each triangle by four and smooths the surface: Loop's scheme ("Smooth Subdivision Surfaces Based
/// on Triangles", 1987) with Warren's weights. `mesh` must consist of triangles and be closed, with two faces
/// at every edge. New vertices follow the old ones. Where parts of the surface are close to each other the
/// result may intersect itself, which check_mesh() detects.
Mesh subdivide(const Mesh& mesh);

}  // namespace lrb::resolutions
