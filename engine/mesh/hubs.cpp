#include "engine/mesh/hubs.hpp"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>

#include "engine/mesh/box_pairs.hpp"

namespace lrb {
namespace {

/// The box of all directions in which a convex face lies from its corner v: an arc of at most half a turn
/// between the directions to the neighbouring corners. At chord length c it is nowhere farther from its chord
/// than 1 - sqrt(1 - c^2 / 4), which is at most c^2 / 4. A coordinate of a computed direction is off by less
/// than 2^-50: differences of doubles and the scaling to length 1 are relative errors of a few 2^-53.
Box directions(const Mesh& mesh, FaceId f, VertexId v) {
  constexpr double kRoom = 0x1p-45;
  const auto corners = mesh.face(f);
  const std::size_t n = corners.size();
  const auto at = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  const Eigen::Vector3d centre = mesh.vertices[v];
  // Directions to both neighbours of v in the face: the ends of the arc.
  const Eigen::Vector3d p = (mesh.vertices[corners[(at + 1) % n]] - centre).stableNormalized(),
                        q = (mesh.vertices[corners[(at + n - 1) % n]] - centre).stableNormalized();
  const auto is_direction = [](const Eigen::Vector3d& d) {  // neither overflow nor a neighbour in v's place
    return d.allFinite() && std::abs(d.squaredNorm() - 1) < 0x1p-40;
  };
  // No usable direction: a box around the entire sphere, which overlaps all others.
  if (!is_direction(p) || !is_direction(q))
    return {Eigen::Vector3d::Constant(-2), Eigen::Vector3d::Constant(2)};
  // The chord's box, enlarged by the bound on the distance between arc and chord.
  Box box(p);
  box.extend(q);
  const Eigen::Vector3d room = Eigen::Vector3d::Constant((p - q).squaredNorm() / 4 + kRoom);
  return {box.min() - room, box.max() + room};
}

}  // namespace

Hubs::Hubs(const Mesh& mesh, const std::vector<FaceUse>& use) {
  if (mesh.dim == 2) return;
  // Valence of each vertex among convex faces. For others the argument about arcs does not hold.
  std::vector<std::uint32_t> degree(mesh.vertices.size(), 0);
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    if (use[f] == FaceUse::convex)
      for (const VertexId v : mesh.face(f)) ++degree[v];
  std::map<VertexId, std::uint32_t> number;
  for (VertexId v = 0; v < degree.size(); ++v) {
    if (degree[v] <= kFewNeighbours) continue;
    number.emplace(v, static_cast<std::uint32_t>(hubs.size()));
    hubs.push_back({v, {}});
  }
  if (hubs.empty()) return;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    if (use[f] != FaceUse::convex) continue;
    // Each face goes to the hub of highest valence among its corners, where most of its pairs are.
    VertexId best = kNull;
    for (const VertexId v : mesh.face(f))
      if (degree[v] > kFewNeighbours &&
          (best == kNull || degree[v] > degree[best] || (degree[v] == degree[best] && v < best)))
        best = v;
    if (best != kNull) hubs[number[best]].faces.push_back(f);
  }
}

void for_each_pair_at(const Mesh& mesh, const Hubs::Hub& hub,
                      const std::function<void(FaceId, FaceId)>& visit, Workers& workers) {
  // Pairs of arcs by a tree of boxes on the unit sphere.
  std::vector<Box> arcs;
  arcs.reserve(hub.faces.size());
  for (const FaceId f : hub.faces) arcs.push_back(directions(mesh, f, hub.vertex));
  BoxTree(arcs).for_each_pair([&](std::uint32_t i, std::uint32_t j) { visit(hub.faces[i], hub.faces[j]); },
                              workers);
}

}  // namespace lrb
