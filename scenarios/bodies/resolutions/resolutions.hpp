#pragma once
/// Makes one body at several resolutions.

#include <cstdint>
#include <vector>

#include "engine/mesh/mesh.hpp"

namespace lrb::resolutions {

struct ResolutionOptions {
  std::uint32_t subdivisions = 0;  ///< done first; each replaces a face by four
  std::uint32_t most = 8;          ///< largest number of resolutions
  std::uint32_t least_faces = 500;
};

/// Returns the finest one first; each has half of the faces of the one before (decimate.hpp). A mesh of
/// polygons becomes one of triangles. Throws InputError for a mesh that no LRB-rep can be built of.
std::vector<Mesh> resolutions(const Mesh& mesh, const ResolutionOptions& options);

}  // namespace lrb::resolutions
