#pragma once
/// Vertices in which very many faces meet.

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/core/parallel.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb {

/// More faces at a vertex than this, or more corners of a face, and comparing all with all takes too long.
inline constexpr std::uint32_t kFewNeighbours = 64;

/// The hubs of a mesh in space: vertices with more than kFewNeighbours faces that are planar and convex. Each
/// such face belongs to at most one hub, that with the most faces (then the smallest number).
struct Hubs {
  struct Hub {
    VertexId vertex;
    std::vector<FaceId> faces;  ///< ascending
  };
  std::vector<Hub> hubs;

  Hubs(const Mesh& mesh, const std::vector<FaceUse>& use);
};

/// Calls visit(f, g), f < g, for all pairs of a hub's faces that may have more in common than the hub, and
/// for a few others; from several threads at once if `workers` has them.
///
/// Two convex faces with a corner v in common that meet in another point x, too, have the whole way from v to
/// x in common. So they do exactly if the arcs meet that they cut out of a small sphere about v, and boxes of
/// these arcs tell nearly all pairs apart.
void for_each_pair_at(const Mesh& mesh, const Hubs::Hub& hub,
                      const std::function<void(FaceId, FaceId)>& visit, Workers& workers);

}  // namespace lrb
