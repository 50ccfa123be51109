#pragma once
/// One body at several resolutions.

#include <cstdint>
#include <vector>

#include "engine/mesh/mesh.hpp"

namespace lrb::resolutions {

struct ResolutionOptions {
  std::uint32_t subdivisions = 0;  ///< before anything else; each makes four faces of one
  std::uint32_t most = 8;          ///< resolutions
  std::uint32_t least_faces = 500;
};

/// The finest first; each has half of the faces of the one before (decimate.hpp). A mesh of polygons becomes
/// one of triangles. Throws InputError for a mesh that no LRB-rep can be built of.
std::vector<Mesh> resolutions(const Mesh& mesh, const ResolutionOptions& options);

}  // namespace lrb::resolutions
