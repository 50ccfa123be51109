#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb {

enum class FaceMeeting : std::uint8_t {
  outside_shared,  ///< beyond the vertices and edges that two faces share
  crossing,        ///< each passes through the other's interior
  /// They cross, or overlap in one plane with the same orientation. A solid that overlaps itself has such
  /// faces; a solid that only touches itself does not. (An overlap without such faces is not found: its parts
  /// would have to pass exactly through each other's boundaries everywhere.)
  overlap,
};

/// Calls found(f, g), f < g, for each pair of faces with such an intersection for which wanted(f, g) is true
/// (empty: for all pairs). Omits faces without area (reported separately), and does not test a polygon
/// against itself. Exact.
void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<void(FaceId, FaceId)>& found,
                             FaceMeeting kind = FaceMeeting::outside_shared,
                             const std::function<bool(FaceId, FaceId)>& wanted = {});

/// Returns the faces that find_self_intersections() reports, ascending. Faster, and with memory linear in the
/// number of faces if there are millions of pairs.
std::vector<FaceId> self_intersecting_faces(const Mesh& mesh, const std::vector<FaceUse>& use,
                                            Workers& workers);

/// Returns true if there is a pair with FaceMeeting::overlap; stops at the first. `wanted`: empty for all
/// faces.
bool overlaps_itself(const Mesh& mesh, const std::vector<FaceUse>& use,
                     const std::function<bool(FaceId, FaceId)>& wanted = {});

/// Returns the pairs with their kinds and segments; see <lrbscope/self_intersections.hpp>.
SelfIntersections self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use, Workers& workers,
                                     std::uint64_t max_pairs);

}  // namespace lrb
