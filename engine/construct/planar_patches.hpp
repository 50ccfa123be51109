#pragma once
/// Faces in a common plane as regions without volume, hidden by few polygons.

#include <cstdint>
#include <vector>

#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// A mesh with patches of another one's faces replaced by polygons.
struct MergedFaces {
  struct Origin {
    FaceId face;                   ///< of the other mesh, if the face has no region
    std::uint32_t region = kNull;  ///< number in `floors`
  };
  Mesh mesh;
  std::vector<Origin> origin;               ///< (faces)
  std::vector<std::vector<FaceId>> floors;  ///< (regions) the faces of the other mesh that were replaced
};

/// Replaces connected faces with area and equal normals in exactly the same plane by polygons of at most
/// `most` triangles, with the vertices of the outline alone. Outlines may be concave, and have holes:
/// polygons walk edges to these in both directions. No vertex of another face is on one of their triangles
/// (triangulate()) but their corners. Replaces neither `frozen` faces nor those at vertices with several
/// fans.
MergedFaces merge_coplanar(const Mesh& mesh, const std::vector<bool>& frozen, std::uint32_t most);

}  // namespace lrb::construct
