// Causes of open edges of a surface that looks closed: vertices on the open edge of another face
// (T-junctions), and vertices that nearly coincide.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "engine/core/geometry.hpp"
#include "engine/mesh/box_tree.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/mesh_check.hpp>

namespace lrb {
namespace {

constexpr double kSeam = 1e-6;          // the width of a seam, relative to the diagonal of the body's box
constexpr double kMaxDiagonal = 1e150;  // squares of longer ones overflow

/// Pairs of vertices.
using OpenKeys = std::unordered_set<std::uint64_t>;

std::uint64_t seam_key(VertexId from, VertexId to) {
  return std::uint64_t{from} << 32 | to;
}

/// Returns true if a point lies on an edge, further than `width` from its ends.
bool is_on(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double width) {
  return std::sqrt(nearest_on_segment(x, a, b).distance_sq) <= width && norm3(x - a) > width &&
         norm3(x - b) > width;
}

void find_t_junctions(const Mesh& mesh, const std::vector<OpenEdge>& edges,
                      const std::vector<VertexId>& corners, double width, MeshReport& report) {
  std::vector<Box> boxes;
  for (const OpenEdge& e : edges) {
    Box box(mesh.vertices[e.from]);
    box.extend(mesh.vertices[e.to]);
    boxes.emplace_back(box.min().array() - width, box.max().array() + width);
  }
  const BoxTree tree(boxes);
  for (const VertexId v : corners) {
    bool found = false;  // the first edge is enough
    const Eigen::Vector3d& x = mesh.vertices[v];
    tree.for_each_near(
        Box(x, x), [&](const Box&) { return !found; },
        [&](std::uint32_t i) {
          const OpenEdge& e = edges[i];
          if (found || !is_on(x, mesh.vertices[e.from], mesh.vertices[e.to], width)) return;
          // Last, because a face can have very many corners: is the vertex one of them?
          found = std::ranges::count(mesh.face(e.face), v) == 0;
          if (found) note(report, MeshFault::t_junction, v, e.face);
        });
  }
}

void find_near_vertices(const Mesh& mesh, const OpenKeys& open, std::vector<VertexId> corners, double width,
                        MeshReport& report) {
  FirstAtPosition first_at(mesh.vertices);
  std::erase_if(corners, [&](VertexId v) { return first_at(v) != v; });
  std::vector<Box> boxes;
  for (const VertexId v : corners) boxes.emplace_back(mesh.vertices[v], mesh.vertices[v]);
  const BoxTree tree(boxes);
  for (std::uint32_t j = 0; j < corners.size(); ++j) {
    const VertexId v = corners[j];
    const Eigen::Vector3d& x = mesh.vertices[v];
    bool found = false;
    tree.for_each_near(
        Box(x.array() - width, x.array() + width), [&](const Box&) { return !found; },
        [&](std::uint32_t i) {
          const VertexId u = corners[i];
          if (found || i >= j || open.contains(seam_key(u, v)) || open.contains(seam_key(v, u))) return;
          found = norm3(mesh.vertices[u] - x) <= width;
          if (found) note(report, MeshFault::near_vertex, std::min(u, v), std::max(u, v));
        });
  }
}

}  // namespace

void check_seams(const Mesh& mesh, const std::vector<FaceUse>& use, std::vector<OpenEdge> edges,
                 MeshReport& report) {
  std::erase_if(edges, [&](const OpenEdge& e) { return use[e.face] < FaceUse::points; });
  if (edges.empty()) return;
  OpenKeys open;
  std::vector<VertexId> corners;
  for (const OpenEdge& e : edges) {
    open.insert(seam_key(e.from, e.to));
    corners.insert(corners.end(), {e.from, e.to});
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  Box box;
  for (const VertexId v : corners) box.extend(mesh.vertices[v]);
  const double diagonal = box.isEmpty() ? 0 : norm3(box.diagonal());
  if (!(diagonal > 0 && diagonal < kMaxDiagonal)) return;
  find_t_junctions(mesh, edges, corners, kSeam * diagonal, report);
  find_near_vertices(mesh, open, std::move(corners), kSeam * diagonal, report);
}

}  // namespace lrb
