#pragma once
/// Checks a mesh's faces one by one, and finds faces with the same corners. Exact.

#include <cstdint>
#include <vector>

#include "engine/mesh/mesh.hpp"
#include "engine/mesh/mesh_check.hpp"

namespace lrb {

/// What a face can be used for; each use includes those before it.
enum class FaceUse : std::uint8_t {
  nothing,   ///< it names a vertex that does not exist
  topology,  ///< its corners exist, but one is not finite
  points,    ///< its corners are finite, but it has no area (2D: no length), or too few different corners
  area,      ///< it is a proper face, perhaps neither planar nor convex
  convex,    ///< planar and convex (always so for triangles and segments)
};

/// Notes non-finite vertices, bad indices, repeated corners, faces without area, planarity and convexity in
/// the report. Returns what each face can be used for.
std::vector<FaceUse> check_faces(const Mesh& mesh, MeshReport& report);

/// Notes faces that have the same set of corners as an earlier one.
void check_duplicates(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report);

/// Notes vertices that no face names, and those with the coordinates of an earlier one.
void check_vertices(const Mesh& mesh, MeshReport& report);

/// Counts a finding, and keeps the element(s) if it is among the first, of which MeshReport::kept are kept.
void note(MeshReport& report, MeshFault fault, std::uint32_t first, std::uint32_t second = kNull);

/// Puts what was kept in order. Call it after the last note().
void sort_offenders(MeshReport& report);

}  // namespace lrb
