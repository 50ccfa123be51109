#pragma once
/// Faces in a common plane as regions without volume, each hidden by one polygon.

#include <cstdint>
#include <vector>

#include "engine/construct/front_mesh.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// A mesh with some faces of another merged into polygons.
struct MergedFaces {
  Mesh mesh;
  std::vector<std::vector<FaceId>> beneath;  ///< (faces) those of the other mesh that each one covers
};

/// Merges connected faces with area and equal normals in exactly the same plane, if these are at most `most`
/// triangles of the front. The outline of a polygon may be concave, and walks edges to holes in both
/// directions. No vertex of another face is on one of its triangles (triangulate()) but their corners. Merges
/// neither `frozen` faces nor those at vertices with several fans. `front`: of the mesh itself.
MergedFaces merge_coplanar(const Mesh& mesh, const FrontMesh& front, const std::vector<bool>& frozen,
                           std::uint32_t most);

}  // namespace lrb::construct
