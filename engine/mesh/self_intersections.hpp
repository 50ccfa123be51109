#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// Calls found(f, g), f < g, for every two faces that meet in more than the vertices and edges they share.
/// Leaves out faces without area (they have a finding of their own), and does not test a polygon against
/// itself. Exact.
void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<void(FaceId, FaceId)>& found);

/// Does the same for pairs for which wanted(f, g) holds.
void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<bool(FaceId, FaceId)>& wanted,
                             const std::function<void(FaceId, FaceId)>& found);

/// Returns the faces that find_self_intersections() would name, ascending: faster, and with memory for the
/// faces alone, where there are millions of pairs.
std::vector<FaceId> self_intersecting_faces(const Mesh& mesh, const std::vector<FaceUse>& use,
                                            Workers& workers);

/// Calls found(f, g), f < g, for every two faces for which wanted(f, g) holds and that cross: each passes
/// through the other's interior.
void find_crossings(const Mesh& mesh, const std::vector<FaceUse>& use,
                    const std::function<bool(FaceId, FaceId)>& wanted,
                    const std::function<void(FaceId, FaceId)>& found);

/// Does the same for faces that cross, or that cover each other in one plane and face the same way: those of
/// a solid that overlaps itself do, while the faces of one that only touches itself do neither. (An overlap
/// in which no face does either is not found: its parts would have to pass exactly through each other's rims
/// everywhere.)
void find_overlaps(const Mesh& mesh, const std::vector<FaceUse>& use,
                   const std::function<bool(FaceId, FaceId)>& wanted,
                   const std::function<void(FaceId, FaceId)>& found);

/// Returns true if find_overlaps() would find a pair; ends at the first. `wanted`: null for any faces.
bool overlaps_itself(const Mesh& mesh, const std::vector<FaceUse>& use,
                     const std::function<bool(FaceId, FaceId)>& wanted = {});

}  // namespace lrb
