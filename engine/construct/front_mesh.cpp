// The front as a triangle mesh with face adjacency. From a closed mesh: split polygons into triangles, pair
// opposite edges, give each fan of triangles its own vertex, label the connected components.

#include "engine/construct/front_mesh.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/mesh/polygon_shape.hpp"

namespace lrb::construct {
FrontMesh::FrontMesh(const Mesh& mesh, std::span<const FaceId> faces) {
  for (VertexId v = 0; v < mesh.vertices.size(); ++v) points_.push_back({mesh.vertices[v], v});
  add_faces(mesh, faces);
  find_neighbours();
  split_fans();
  find_components();
}

void FrontMesh::add_faces(const Mesh& mesh, std::span<const FaceId> faces) {
  // A pure triangle mesh needs no table of polygons.
  const bool polygons = mesh.face_vertices.size() != 3 * mesh.face_count();
  std::vector<std::array<VertexId, 3>> parts;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    triangulate(mesh, f, parts);
    // Triangles of a polygon are consecutive, so that unit() is an index range.
    const Slot first = slot_count();
    const FaceId number = faces.empty() ? f : faces[f];
    first_faces_ = std::max(first_faces_, number + 1);
    for (const auto& part : parts) {
      triangles_.push_back({{part[0], part[1], part[2]}, {kNull, kNull, kNull}, number, kNull});
      if (!polygons) continue;
      unit_first_.push_back(first);
      unit_size_.push_back(static_cast<std::uint32_t>(parts.size()));
    }
  }
  alive_ = slot_count();
}

void FrontMesh::find_neighbours() {
  // Counting sort of the directed edges by their start vertices. The counts are shifted by two entries, so
  // that filling the buckets leaves offsets[v] and offsets[v + 1] as the ends of bucket v.
  std::vector<std::uint32_t> offsets(points_.size() + 2, 0);
  for (const Triangle& t : triangles_)
    for (const Corner v : t.v) ++offsets[v + 2];
  for (std::size_t i = 2; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  // An edge is coded as 3 * triangle + index.
  std::vector<std::uint32_t> edges(3 * triangles_.size());
  for (Slot s = 0; s < slot_count(); ++s)
    for (std::uint32_t i = 0; i < 3; ++i) edges[offsets[triangles_[s].v[i] + 1]++] = 3 * s + i;
  const auto end_of = [&](std::uint32_t edge) { return triangles_[edge / 3].v[(edge % 3 + 1) % 3]; };
  // High-valence vertices: sort their buckets by end vertex, for binary search. Linear search would take
  // quadratic time at such a vertex.
  constexpr std::uint32_t kFew = 32;
  const auto at = [&](std::uint32_t e) { return edges.begin() + e; };
  for (Corner v = 0; v < points_.size(); ++v)
    if (offsets[v + 1] - offsets[v] > kFew)
      std::stable_sort(at(offsets[v]), at(offsets[v + 1]),
                       [&](std::uint32_t e, std::uint32_t f) { return end_of(e) < end_of(f); });
  const auto last_edge = [&](Corner from, Corner to) {
    // Small buckets: linear search from the back. Large ones: the upper bound, then one comparison.
    std::uint32_t first = offsets[from], last = offsets[from + 1];
    if (last - first > kFew)
      last = static_cast<std::uint32_t>(
          std::upper_bound(at(first), at(last), to,
                           [&](Corner end, std::uint32_t e) { return end < end_of(e); }) -
          edges.begin());
    for (std::uint32_t e = last; e-- > first;) {
      if (end_of(edges[e]) == to) return edges[e];
      if (offsets[from + 1] - first > kFew) break;
    }
    return NoId::kValue;
  };
  // The neighbour across a -> b is the triangle with the edge b -> a. The mesh is closed, so it exists.
  for (Slot s = 0; s < slot_count(); ++s) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t opposite = last_edge(triangles_[s].v[(i + 1) % 3], triangles_[s].v[i]);
      if (opposite != kNull) triangles_[s].across[i] = opposite / 3;
    }
  }
}

void FrontMesh::split_fans() {
  slot_of_.assign(points_.size(), kNull);
  degree_.assign(points_.size(), 0);
  // Each corner of each triangle is visited once: linear time.
  std::vector<bool> seen(3 * triangles_.size(), false);
  for (Slot first = 0; first < slot_count(); ++first) {
    for (int corner = 0; corner < 3; ++corner) {
      if (seen[3 * first + corner]) continue;
      const Corner old = triangles_[first].v[corner];
      Corner v = old;
      // The vertex is non-manifold: several fans touch in it. Later fans get copies with the same id, so that
      // traversals around a vertex miss no triangle.
      if (slot_of_[old] != kNull) {  // another fan has this vertex
        v = add_point(Eigen::Vector3d(points_[old].x), points_[old].id);
      }
      slot_of_[v] = first;
      // Traverse the fan around the old vertex and renumber its corner in every triangle.
      Slot s = first;
      do {
        const int i = index_of(s, old);
        seen[3 * s + i] = true;
        ++degree_[v];
        triangles_[s].v[i] = v;
        s = triangles_[s].across[(i + 2) % 3];
      } while (s != first);
    }
  }
}

void FrontMesh::find_components() {
  // Flood fill over edges with an explicit stack: the recursion depth could equal the number of triangles.
  std::vector<Slot> stack;
  for (Slot first = 0; first < slot_count(); ++first) {
    if (triangles_[first].component != kNull) continue;
    triangles_[first].component = components_;
    stack.push_back(first);
    while (!stack.empty()) {
      const Slot s = stack.back();
      stack.pop_back();
      for (const Slot t : triangles_[s].across) {
        if (triangles_[t].component != kNull) continue;
        triangles_[t].component = components_;
        stack.push_back(t);
      }
    }
    ++components_;
  }
}

FrontMesh::Corner FrontMesh::add_point(const Eigen::Vector3d& x, VertexId id) {
  points_.push_back({x, id});
  slot_of_.push_back(kNull);
  degree_.push_back(0);
  return point_count() - 1;
}

void FrontMesh::remove(std::span<const Slot> slots) {
  for (const Slot s : slots) {
    // A vertex without triangles is no longer in use.
    for (const Corner v : triangles_[s].v)
      if (--degree_[v] == 0) slot_of_[v] = kNull;
    triangles_[s].face = kNull;
  }
  alive_ -= static_cast<std::uint32_t>(slots.size());
}

void FrontMesh::add(Slot s, const Triangle& t) {
  if (s == slot_count()) triangles_.emplace_back();
  triangles_[s] = t;
  for (const Corner v : t.v) {
    slot_of_[v] = s;
    ++degree_[v];
  }
  ++alive_;
}

std::vector<FrontMesh::Slot> FrontMesh::alive_slots() const {
  std::vector<Slot> slots;
  slots.reserve(alive_);
  for (Slot s = 0; s < slot_count(); ++s)
    if (alive(s)) slots.push_back(s);
  return slots;
}

}  // namespace lrb::construct
