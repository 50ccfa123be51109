// Causes of open edges of a surface that looks closed: vertices on the open edge of another face
// (T-junctions), and vertices that nearly coincide, which can be welded.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/core/geometry.hpp"
#include "engine/mesh/box_tree.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/parallel.hpp>

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

/// Calls visit(u, v) for vertices of open edges, u before v, at most `width` apart, that no open edge joins,
/// until it returns true for this v. `corners`: ascending.
template <class Visit>
void for_each_near_pair(const Mesh& mesh, const OpenKeys& open, std::span<const VertexId> corners,
                        double width, const Visit& visit) {
  std::vector<Box> boxes;
  for (const VertexId v : corners) boxes.emplace_back(mesh.vertices[v], mesh.vertices[v]);
  const BoxTree tree(boxes);
  for (std::uint32_t j = 0; j < corners.size(); ++j) {
    const VertexId v = corners[j];
    const Eigen::Vector3d& x = mesh.vertices[v];
    bool done = false;
    tree.for_each_near(
        Box(x.array() - width, x.array() + width), [&](const Box&) { return !done; },
        [&](std::uint32_t i) {
          const VertexId u = corners[i];
          if (done || i >= j || open.contains(seam_key(u, v)) || open.contains(seam_key(v, u))) return;
          done = norm3(mesh.vertices[u] - x) <= width && visit(u, v);
        });
  }
}

/// The ends of open edges of usable faces, ascending, and the edges themselves.
struct OpenCorners {
  OpenKeys keys;
  std::vector<VertexId> corners;
  OpenCorners(const std::vector<OpenEdge>& edges, const std::vector<FaceUse>& use) {
    for (const OpenEdge& e : edges) {
      if (use[e.face] < FaceUse::points) continue;
      keys.insert(seam_key(e.from, e.to));
      corners.insert(corners.end(), {e.from, e.to});
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  }
};

/// The faults that a weld must not add: all that an edit of corners can cause. Whether a component faces
/// inwards is known only once a weld has closed it.
constexpr MeshFault kOfWelds[] = {MeshFault::repeated_corner,    MeshFault::zero_area_face,
                                  MeshFault::folded_face,        MeshFault::duplicate_face,
                                  MeshFault::non_manifold_edge,  MeshFault::flipped_face,
                                  MeshFault::non_manifold_vertex};

[[noreturn]] void reject_weld(const Mesh& mesh, double distance, const std::string& what) {
  throw InputError(mesh.name + ": a weld of vertices " + io::number_text(distance) +
                   " apart would spoil it: " + what + "; choose a smaller distance");
}

/// Returns in words the first fault that a welded mesh has elsewhere than the mesh, or an empty string.
std::string added_fault(const Mesh& mesh, const Mesh& welded) {
  const MeshReport before_all = examine(mesh, kMaxId).report, after_all = examine(welded, kMaxId).report;
  // Vertices that were merged have other numbers in the welded mesh.
  std::vector<VertexId> became(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.face_vertices.size(); ++i)
    if (mesh.face_vertices[i] < became.size()) became[mesh.face_vertices[i]] = welded.face_vertices[i];
  for (const MeshFault fault : kOfWelds) {
    MeshFinding before = before_all[fault], after = after_all[fault];
    const bool is_edge = fault == MeshFault::non_manifold_edge;
    for (auto& [first, second] : before.first) {
      if (is_edge || fault == MeshFault::non_manifold_vertex) first = became[first].value();
      if (is_edge || fault == MeshFault::repeated_corner) second = became[second].value();
      if (is_edge && first > second) std::swap(first, second);
    }
    std::sort(before.first.begin(), before.first.end());
    if (!std::includes(before.first.begin(), before.first.end(), after.first.begin(), after.first.end()))
      return io::in_words(name_of(fault)) + " (" + std::to_string(after.count) + " in place of " +
             std::to_string(before.count) + (after.count > before.count ? ")" : " elsewhere)");
  }
  return {};
}

}  // namespace

void check_seams(const Mesh& mesh, const std::vector<FaceUse>& use, std::vector<OpenEdge> edges,
                 MeshReport& report) {
  std::erase_if(edges, [&](const OpenEdge& e) { return use[e.face] < FaceUse::points; });
  if (edges.empty()) return;
  auto [open, corners] = OpenCorners(edges, use);
  Box box;
  for (const VertexId v : corners) box.extend(mesh.vertices[v]);
  const double diagonal = box.isEmpty() ? 0 : norm3(box.diagonal());
  if (!(diagonal > 0 && diagonal < kMaxDiagonal)) return;
  find_t_junctions(mesh, edges, corners, kSeam * diagonal, report);
  FirstAtPosition first_at(mesh.vertices);
  std::erase_if(corners, [&](VertexId v) { return first_at(v) != v; });
  for_each_near_pair(mesh, open, corners, kSeam * diagonal, [&](VertexId u, VertexId v) {
    note(report, MeshFault::near_vertex, std::min(u, v), std::max(u, v));
    return true;
  });
}

CheckedMesh weld_corners(const CheckedMesh& mesh, double distance, WeldedCorners& done) {
  const FloatMode float_mode;
  if (mesh.mesh().dim != 3)
    throw InputError(mesh.mesh().name + ": expected a 3D mesh to weld, found a 2D one");
  Mesh out = mesh.mesh();
  const OpenCorners open(mesh.topology().open_edges, mesh.use());
  Box box;
  for (const VertexId v : open.corners) box.extend(out.vertices[v]);
  const double most = std::min(box.isEmpty() ? kMaxDiagonal : norm3(box.diagonal()), kMaxDiagonal);
  if (!(distance > 0 && distance <= most))
    throw InputError(mesh.mesh().name + ": weld: expected a length above 0 and at most " +
                     io::number_text(most, 3) + ", the size of all open edges, found " +
                     io::number_text(distance));
  done = {};
  // 1. Move each corner to one before it, within the distance, that has not moved itself.
  std::vector<bool> moved(out.vertices.size());
  for_each_near_pair(mesh.mesh(), open.keys, open.corners, distance, [&](VertexId u, VertexId v) {
    if (moved[u]) return false;
    moved[v] = true;
    ++done.welded;
    done.farthest = std::max(done.farthest, norm3(out.vertices[u] - out.vertices[v]));
    out.vertices[v] = out.vertices[u];
    return true;
  });
  // 2. Merge corners with equal coordinates, and prove that no face, edge or vertex became worse.
  join_corners(out);
  CheckedMesh welded = check(std::move(out));
  if (std::ranges::any_of(kOfWelds, [&](MeshFault fault) { return welded.report()[fault].count > 0; }))
    if (const std::string added = added_fault(mesh.mesh(), welded.mesh()); !added.empty())
      reject_weld(mesh.mesh(), distance, added);
  Workers workers(0);
  const std::vector<FaceId> before = mesh.self_intersecting_faces(workers);
  for (const FaceId f : welded.self_intersecting_faces(workers))
    if (!std::binary_search(before.begin(), before.end(), f))
      reject_weld(mesh.mesh(), distance, "face " + std::to_string(f) + " would intersect another one");
  return welded;
}

}  // namespace lrb
