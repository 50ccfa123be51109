#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb {

/// Calls found(f, g), f < g, for each pair of faces that intersect beyond their shared vertices and edges.
/// Omits faces without area (reported separately), and does not test a polygon against itself. Exact.
void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<void(FaceId, FaceId)>& found);

/// The same for pairs for which wanted(f, g) is true.
void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<bool(FaceId, FaceId)>& wanted,
                             const std::function<void(FaceId, FaceId)>& found);

/// Returns the faces that find_self_intersections() reports, ascending. Faster, and with memory linear in the
/// number of faces if there are millions of pairs.
std::vector<FaceId> self_intersecting_faces(const Mesh& mesh, const std::vector<FaceUse>& use,
                                            Workers& workers);

/// Calls found(f, g), f < g, for each pair of faces for which wanted(f, g) is true and that cross: each
/// passes through the other's interior.
void find_crossings(const Mesh& mesh, const std::vector<FaceUse>& use,
                    const std::function<bool(FaceId, FaceId)>& wanted,
                    const std::function<void(FaceId, FaceId)>& found);

/// As above, for faces that cross, or that overlap in one plane with the same orientation. A solid that
/// overlaps itself has such faces; a solid that only touches itself does not. (An overlap without such faces
/// is not found: its parts would have to pass exactly through each other's boundaries everywhere.)
void find_overlaps(const Mesh& mesh, const std::vector<FaceUse>& use,
                   const std::function<bool(FaceId, FaceId)>& wanted,
                   const std::function<void(FaceId, FaceId)>& found);

/// Returns true if find_overlaps() would find a pair; stops at the first. `wanted`: empty for all faces.
bool overlaps_itself(const Mesh& mesh, const std::vector<FaceUse>& use,
                     const std::function<bool(FaceId, FaceId)>& wanted = {});

/// Returns the pairs with their kinds and segments; see <lrbscope/self_intersections.hpp>.
SelfIntersections self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use, Workers& workers,
                                     std::uint64_t max_pairs);

}  // namespace lrb
