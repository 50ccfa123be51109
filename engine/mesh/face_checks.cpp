#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "engine/exact/predicates.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/vertex_buckets.hpp"
#include "engine/mesh/vertex_merger.hpp"
#include <lrbscope/mesh_check.hpp>

namespace lrb {
namespace {

/// Returns a vertex that a face lists twice, or kNull if there is none.
VertexId repeated_corner(std::span<const VertexId> corners, std::vector<VertexId>& sorted) {
  if (corners.size() == 3) {  // nearly every face is a triangle
    if (corners[0] == corners[1] || corners[0] == corners[2]) return corners[0];
    return corners[1] == corners[2] ? corners[1] : kNull;
  }
  // Polygons: sort a copy and find equal neighbours, O(n log n).
  sorted.assign(corners.begin(), corners.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? kNull : *twice;
}

FaceUse check_segment(const Mesh& mesh, FaceId f, MeshReport& report) {
  const auto corners = mesh.face(f);
  // 2D bodies are in the plane z = 0, so x and y decide.
  if (corners.size() == 2 && mesh.vertices[corners[0]].head<2>() != mesh.vertices[corners[1]].head<2>())
    return FaceUse::convex;
  note(report, MeshFault::zero_area_face, f);
  return FaceUse::points;
}

FaceUse check_polygon(const Mesh& mesh, FaceId f, MeshReport& report) {
  const auto corners = mesh.face(f);
  // Exact: if no three corners span a plane, the face has no area.
  const auto triple = spanning_corners(mesh, corners);
  if (!triple) {
    note(report, MeshFault::zero_area_face, f);
    return FaceUse::points;
  }
  if (corners.size() == 3) return FaceUse::convex;
  // Triangles are planar and convex; larger polygons are tested exactly.
  const bool planar = is_planar(mesh, corners, *triple), convex = is_convex(mesh, corners);
  if (!planar) note(report, MeshFault::non_planar_face, f);
  if (!convex) note(report, MeshFault::non_convex_face, f);
  return planar && convex ? FaceUse::convex : FaceUse::area;
}

FaceUse check_face(const Mesh& mesh, FaceId f, const std::vector<bool>& finite,
                   std::vector<VertexId>& scratch, MeshReport& report) {
  const auto corners = mesh.face(f);
  // Indices first: all checks below read the vertices.
  for (const VertexId v : corners) {
    if (v < mesh.vertices.size()) continue;
    note(report, MeshFault::index_out_of_range, f, v);
    return FaceUse::nothing;
  }
  const VertexId twice = repeated_corner(corners, scratch);
  if (twice != kNull) note(report, MeshFault::repeated_corner, f, twice);
  if (!std::all_of(corners.begin(), corners.end(), [&](VertexId v) { return finite[v]; }))
    return FaceUse::topology;
  const FaceUse use = mesh.dim == 2 ? check_segment(mesh, f, report) : check_polygon(mesh, f, report);
  // A repeated corner makes triangles of the face degenerate, so the face never counts as convex.
  return twice == kNull ? use : std::min(use, FaceUse::area);
}

/// Faces ordered by their sorted corners: equal faces become neighbours, in the order of their numbers.
class CornerSets {
 public:
  CornerSets(const Mesh& mesh, const std::vector<FaceUse>& use) : offsets_(mesh.face_offsets) {
    // The sorted corners identify the set, independent of the first corner and the direction.
    sorted_ = mesh.face_vertices;
    for (FaceId f = 0; f < mesh.face_count(); ++f)
      std::sort(sorted_.begin() + offsets_[f], sorted_.begin() + offsets_[f + 1]);
    // By the smallest corner first, which leaves few faces to compare.
    VertexBuckets<FaceId> by_smallest(mesh.vertices.size(), [&](const auto& visit) {
      for (FaceId f = 0; f < mesh.face_count(); ++f)
        if (use[f] != FaceUse::nothing && offsets_[f] != offsets_[f + 1]) visit(sorted_[offsets_[f]], f);
    });
    by_smallest.for_each_group([&](VertexId, std::span<FaceId> faces) {
      // Ties by face number: the first of several equal faces comes first.
      std::sort(faces.begin(), faces.end(), [&](FaceId f, FaceId g) {
        const auto x = set(f), y = set(g);
        const auto difference =
            std::lexicographical_compare_three_way(x.begin(), x.end(), y.begin(), y.end());
        return difference != 0 ? difference < 0 : f < g;
      });
    });
    order_ = std::move(by_smallest.items());
  }

  const std::vector<FaceId>& order() const { return order_; }
  bool same(FaceId f, FaceId g) const { return std::ranges::equal(set(f), set(g)); }

 private:
  std::span<const VertexId> set(FaceId f) const {
    return {sorted_.data() + offsets_[f], offsets_[f + 1] - offsets_[f]};
  }

  const std::vector<std::uint32_t>& offsets_;
  std::vector<VertexId> sorted_;
  std::vector<FaceId> order_;
};

void sort_elements(MeshFinding& finding, std::size_t most) {
  std::sort(finding.first.begin(), finding.first.end());
  finding.first.resize(std::min(finding.first.size(), most));
}

}  // namespace

void note(MeshReport& report, MeshFault fault, std::uint32_t first, std::uint32_t second) {
  MeshFinding& finding = report.findings[static_cast<std::size_t>(fault)];
  ++finding.count;
  const std::array<std::uint32_t, 2> element = {first, second};
  auto& kept = finding.first;
  // Once `most` elements are kept, the first `most` are sorted and smaller ones are appended. At 2 `most`
  // they are sorted and truncated again: amortised O(log most) per element.
  const std::size_t most = report.kept;
  if (kept.size() >= most && !(element < kept[most - 1])) return;
  kept.push_back(element);
  if (kept.size() == most || kept.size() == 2 * most) sort_elements(finding, most);
}

void sort_elements(MeshReport& report) {
  for (MeshFinding& finding : report.findings) sort_elements(finding, report.kept);
}

std::vector<FaceUse> check_faces(const Mesh& mesh, MeshReport& report) {
  std::vector<bool> finite(mesh.vertices.size());
  for (VertexId v = 0; v < mesh.vertices.size(); ++v) {
    finite[v] = mesh.vertices[v].allFinite();
    if (!finite[v]) note(report, MeshFault::non_finite_vertex, v);
  }
  std::vector<FaceUse> use(mesh.face_count());
  std::vector<VertexId> scratch;
  for (FaceId f = 0; f < use.size(); ++f) use[f] = check_face(mesh, f, finite, scratch, report);
  return use;
}

void check_duplicates(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report) {
  const CornerSets sets(mesh, use);
  const auto& order = sets.order();
  // Runs of equal sets: each later face is a duplicate of the first one in its run.
  for (std::size_t first = 0, i = 1; i < order.size(); ++i) {
    if (sets.same(order[first], order[i]))
      note(report, MeshFault::duplicate_face, order[first], order[i]);
    else
      first = i;
  }
}

void check_vertices(const Mesh& mesh, MeshReport& report) {
  // Unused vertices. Those merged into others are not reported.
  std::vector<bool> used(mesh.vertices.size());
  for (const VertexId v : mesh.face_vertices)
    if (v < used.size()) used[v] = true;
  const auto& x = mesh.vertices;
  const auto is_joined = [&](VertexId v) {
    return std::binary_search(mesh.joined.begin(), mesh.joined.end(), v);
  };
  FirstAtPosition first_at(x);
  for (VertexId v = 0; v < used.size(); ++v) {
    if (!used[v] && is_joined(v)) continue;
    if (!used[v]) note(report, MeshFault::unused_vertex, v);
    if (!x[v].allFinite()) continue;
    const VertexId first = first_at(v);
    if (first != v) note(report, MeshFault::duplicate_vertex, first, v);
  }
}

}  // namespace lrb
