#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/nesting.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include "engine/mesh/self_intersections.hpp"
#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/ids.hpp>
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

/// Returns true if a face with a repeated corner is an outline that only touches itself, as at the bridge to
/// a hole: all its triangles have area.
bool is_bridged(const Mesh& mesh, FaceId f) {
  std::vector<std::array<VertexId, 3>> triangles;
  if (mesh.dim == 2 || mesh.face(f).size() <= 4 || cut_polygon(mesh, f, triangles) == PolygonCut::folded)
    return false;
  return std::none_of(triangles.begin(), triangles.end(), [&](const auto& t) {
    return exact::collinear3d(mesh.vertices[t[0]].data(), mesh.vertices[t[1]].data(),
                              mesh.vertices[t[2]].data());
  });
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
  if (planar && convex) return FaceUse::convex;
  std::vector<std::array<VertexId, 3>> triangles;
  if (cut_polygon(mesh, f, triangles) == PolygonCut::folded) note(report, MeshFault::folded_face, f);
  return FaceUse::area;
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
  const bool all_finite = std::all_of(corners.begin(), corners.end(), [&](VertexId v) { return finite[v]; });
  if (twice != kNull && !(all_finite && is_bridged(mesh, f)))
    note(report, MeshFault::repeated_corner, f, twice);
  if (!all_finite) return FaceUse::topology;
  const FaceUse use = mesh.dim == 2 ? check_segment(mesh, f, report) : check_polygon(mesh, f, report);
  // A face with a repeated corner never counts as convex: most have degenerate triangles.
  return twice == kNull ? use : std::min(use, FaceUse::area);
}

/// Notes the triangles with area whose height is tiny in relation to their longest edge.
void note_slivers(const Mesh& mesh, const std::vector<FaceUse>& use, MeshReport& report) {
  for (FaceId f = 0; f < use.size(); ++f) {
    const auto c = mesh.face(f);
    if (use[f] < FaceUse::area || c.size() != 3) continue;
    const auto& x = mesh.vertices;
    if (relative_height(x[c[0]], x[c[1]], x[c[2]]) < kSliver) note(report, MeshFault::sliver, f);
  }
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
  const FloatMode float_mode;
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

/// Notes slivers and the pairs of faces that intersect, and calls found(f) for each of these faces. Thousands
/// of copies of a triangle have millions of pairs: only the first of them is compared with other faces, and
/// the pairs of the others are counted.
template <class Found>
void note_intersections(const Mesh& mesh, std::vector<FaceUse> use, MeshReport& report, const Found& found) {
  note_slivers(mesh, use, report);
  std::unordered_map<FaceId, std::vector<FaceId>> copies_of;  // ascending, with the first one
  if (report[MeshFault::duplicate_face].count > 0) {
    const CornerSets sets(mesh, use);
    const auto& order = sets.order();
    for (std::size_t first = 0, i = 1; i < order.size(); ++i) {
      if (!sets.same(order[first], order[i])) {
        first = i;
      } else if (use[order[i]] >= FaceUse::area && mesh.face(order[i]).size() <= 3) {
        copies_of.try_emplace(order[first], 1, order[first]).first->second.push_back(order[i]);
        use[order[i]] = FaceUse::nothing;
      }
    }
  }
  std::uint64_t& count = report.findings[static_cast<std::size_t>(MeshFault::self_intersection)].count;
  // The pairs of two sets of copies, or within one. The first pairs, which are kept, are among the first
  // copies.
  const auto add = [&](std::span<const FaceId> x, std::span<const FaceId> y, bool within) {
    const std::size_t m = std::min(x.size(), report.kept + 1), n = std::min(y.size(), report.kept + 1);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = within ? i + 1 : 0; j < n; ++j)
        note(report, MeshFault::self_intersection, std::min(x[i], y[j]), std::max(x[i], y[j]));
    count += within ? x.size() * (x.size() - 1) / 2 - m * (m - 1) / 2 : x.size() * y.size() - m * n;
    for (const FaceId f : x) found(f);
    for (const FaceId f : y) found(f);
  };
  const auto all_of = [&](const FaceId& f) {
    const auto copies = copies_of.find(f);
    return copies == copies_of.end() ? std::span(&f, 1) : std::span<const FaceId>(copies->second);
  };
  for (const auto& [first, copies] : copies_of) add(copies, copies, true);
  find_self_intersections(mesh, use, [&](FaceId f, FaceId g) { add(all_of(f), all_of(g), false); });
  sort_elements(report);
  report.self_intersections_checked = true;
}

void check_vertices(const Mesh& mesh, MeshReport& report) {
  const FloatMode float_mode;
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

CheckedMesh::CheckedMesh(Mesh mesh, std::size_t kept)
    : mesh_(std::move(mesh)), found_(examine(mesh_, kept)) {}

CheckedMesh check(Mesh mesh, std::size_t kept) {
  return {std::move(mesh), kept};
}

/// Uses and topology do not change: each face keeps its corner set and the region that it covers, and the
/// entire component is reversed. Intersections do not change either.
std::uint32_t CheckedMesh::turn_outward() {
  const auto turned = static_cast<std::uint32_t>(found_.inside_out.size());
  turn_faces(mesh_, found_.inside_out);
  found_.inside_out.clear();
  found_.report = found_.report.when_turned();
  return turned;
}

void CheckedMesh::find_self_intersections() {
  const FloatMode float_mode;
  if (meeting_) return;
  std::vector<bool> meets(mesh_.face_count(), false);
  note_intersections(mesh_, found_.use, found_.report, [&](FaceId f) { meets[f] = true; });
  meeting_.emplace();
  for (FaceId f = 0; f < meets.size(); ++f)
    if (meets[f]) meeting_->push_back(f);
}

std::vector<FaceId> CheckedMesh::self_intersecting_faces(Workers& workers) const {
  const FloatMode float_mode;
  return meeting_ ? *meeting_ : lrb::self_intersecting_faces(mesh_, found_.use, workers);
}

namespace {

/// Reverses a face. A triangle keeps its first corner and a quad starts at its third, so that the triangles
/// of its fan keep their numbers; those of larger polygons change their numbers.
void turn(Mesh& mesh, FaceId f) {
  const auto first = mesh.face_vertices.begin() + mesh.face_offsets[f];
  const auto last = mesh.face_vertices.begin() + mesh.face_offsets[f + 1];
  if (mesh.dim == 2) {
    std::reverse(first, last);
    return;
  }
  // Reversing all except the first corner flips the orientation and keeps the fan's apex.
  std::reverse(first + 1, last);
  if (last - first == 4) std::rotate(first, first + 2, last);
}

/// Returns for each component whether it is a sheet: it has an open edge and is planar. Exact.
std::vector<bool> find_sheets(const Mesh& mesh, const MeshFindings& found) {
  // Only components with an open edge can be sheets.
  std::vector<bool> sheet = found.topology.component_open;
  if (mesh.dim == 2) sheet.assign(sheet.size(), false);
  if (std::find(sheet.begin(), sheet.end(), true) == sheet.end()) return sheet;
  // All corners of each candidate, to be tested against one plane.
  std::vector<std::vector<VertexId>> corners(sheet.size());
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t component = found.topology.component_of_face[f];
    if (component == kNull || !sheet[component]) continue;
    if (found.use[f] < FaceUse::points)
      sheet[component] = false;  // a corner is not finite
    else
      corners[component].insert(corners[component].end(), mesh.face(f).begin(), mesh.face(f).end());
  }
  // Exact: three corners that span a plane, and all others in it.
  for (std::size_t i = 0; i < sheet.size(); ++i) {
    const auto plane = sheet[i] ? spanning_corners(mesh, corners[i]) : std::nullopt;
    sheet[i] = plane && is_planar(mesh, corners[i], *plane);
  }
  return sheet;
}

}  // namespace

MeshFindings examine(const Mesh& mesh, std::size_t kept) {
  const FloatMode float_mode;
  MeshFindings found;
  MeshReport& report = found.report;
  report.kept = kept;
  if (mesh.face_count() == 0) ++report.findings[static_cast<std::size_t>(MeshFault::no_faces)].count;
  // Faces one by one, then duplicates, then vertices.
  found.use = check_faces(mesh, report);
  check_duplicates(mesh, found.use, report);
  check_vertices(mesh, report);
  // Adjacency of faces: components, closedness, genus.
  found.topology = analyse_topology(mesh, found.use, report);
  check_seams(mesh, found.use, found.topology.open_edges, report);
  report.components = found.topology.components;
  report.closed = found.topology.closed;
  report.bounds_solid = report.closed || found.topology.cycle;
  report.genus = found.topology.genus;
  // Orientation of closed components by nesting depth; each is identified by its first face.
  found.inside_out = wrongly_facing_components(mesh, found.use, found.topology);
  for (const auto& faces : found.inside_out) note(report, MeshFault::inside_out, faces.front());
  // Open components that lie in one plane bound nothing.
  found.sheet = find_sheets(mesh, found);
  const auto& open = found.topology.component_open;
  report.open_components = static_cast<std::uint32_t>(std::count(open.begin(), open.end(), true));
  report.sheets = static_cast<std::uint32_t>(std::count(found.sheet.begin(), found.sheet.end(), true));
  sort_elements(report);
  return found;
}

MeshReport check_mesh(const Mesh& mesh, bool self_intersections) {
  MeshFindings found = examine(mesh);
  if (self_intersections) note_intersections(mesh, found.use, found.report, [](FaceId) {});
  return std::move(found.report);
}

void turn_faces(Mesh& mesh, const std::vector<std::vector<FaceId>>& components) {
  for (const auto& faces : components)
    for (const FaceId f : faces) turn(mesh, f);
}

std::uint32_t orient_outward(Mesh& mesh) {
  const FloatMode float_mode;
  const auto wrong = examine(mesh).inside_out;
  turn_faces(mesh, wrong);
  return static_cast<std::uint32_t>(wrong.size());
}

namespace {

/// The kinds of elements that the two numbers of a finding refer to.
enum class ElementKind : std::uint8_t {
  none,
  vertex,
  face,
  face_and_vertex,
  vertex_and_face,
  two_faces,
  two_vertices,
  edge,
  component
};

struct FaultRow {
  std::string_view name, text;
  bool build, query;
};

constexpr std::array<FaultRow, kMeshFaultCount> kFaults = {{
#define MESH_FAULT(name, text, build, query) {#name, text, build, query},
    LRB_MESH_FAULTS(MESH_FAULT)
#undef MESH_FAULT
}};

struct Help {
  MeshFault fault;
  ElementKind kind;
  std::string_view advice;
  std::string_view text_2d = {};    ///< where it differs: in 2D, vertices take the role of edges
  std::string_view advice_2d = {};  ///< where it differs
};

constexpr std::array<Help, kMeshFaultCount> kHelp = {{
    {MeshFault::no_faces, ElementKind::none, "export the mesh with its faces", "the mesh has no segments"},
    {MeshFault::non_finite_vertex, ElementKind::vertex, "replace it by a finite number"},
    {MeshFault::index_out_of_range, ElementKind::face_and_vertex, "correct the index or add the vertex",
     "a segment has a vertex index out of range"},
    {MeshFault::repeated_corner, ElementKind::face_and_vertex, "remove the corner or the face",
     "a segment uses a vertex twice"},
    {MeshFault::zero_area_face, ElementKind::face, "collapse or remove it", "a segment has no length"},
    {MeshFault::sliver, ElementKind::face, "collapse its shortest edge, or flip its longest one"},
    {MeshFault::non_planar_face, ElementKind::face, "triangulate it to choose its triangles"},
    {MeshFault::non_convex_face, ElementKind::face, "triangulate it to choose its triangles"},
    {MeshFault::folded_face, ElementKind::face,
     "it is read as a fan of triangles from its first corner, which goes beyond it; triangulate it"},
    {MeshFault::duplicate_face, ElementKind::two_faces, "remove one of them",
     "two segments have the same ends"},
    {MeshFault::open_edge, ElementKind::edge, "close the hole (lrbscope close)",
     "a vertex has only one segment", "add a segment (l) that joins it to another end"},
    {MeshFault::t_junction, ElementKind::vertex_and_face, "make the vertex a corner of the face"},
    {MeshFault::near_vertex, ElementKind::two_vertices,
     "merge them if the surface should be connected there (lrbscope close --weld LENGTH)"},
    {MeshFault::non_manifold_edge, ElementKind::edge, "separate the parts or remove inner faces",
     "a vertex has more than two segments",
     "separate the parts: one copy of the vertex for each pair of segments"},
    {MeshFault::flipped_face, ElementKind::two_faces,
     "reverse one of them: list its corners in the opposite order",
     "two adjacent segments are inconsistently oriented"},
    {MeshFault::reversed_face, ElementKind::face, "list its corners in the opposite order",
     "a segment is reversed against the rest of its outline", "exchange its ends"},
    {MeshFault::non_manifold_vertex, ElementKind::vertex, "duplicate the vertex, one copy per fan"},
    {MeshFault::inside_out, ElementKind::component, "it can be flipped without loss"},
    {MeshFault::self_intersection, ElementKind::two_faces, "inside and outside are then decided by parity",
     "two segments intersect outside their shared ends"},
    {MeshFault::duplicate_vertex, ElementKind::two_vertices,
     "merge them if the surface should be connected there (lrbscope close --weld LENGTH)"},
    {MeshFault::unused_vertex, ElementKind::vertex, "it can be removed without loss",
     "a vertex is not used by any segment"},
}};

const Help& help_for(MeshFault fault) {
  return *std::find_if(kHelp.begin(), kHelp.end() - 1, [&](const Help& row) { return row.fault == fault; });
}

std::string shown(ElementKind kind, const std::array<std::uint32_t, 2>& element) {
  const std::string first = std::to_string(element[0]), second = std::to_string(element[1]);
  switch (kind) {
    case ElementKind::face_and_vertex:
      return first + " (vertex " + second + ")";
    case ElementKind::vertex_and_face:
      return first + " (face " + second + ")";
    case ElementKind::two_faces:
    case ElementKind::two_vertices:
      return first + " and " + second;
    case ElementKind::edge:
      return element[1] == kNull ? first : first + "-" + second;
    default:
      return first;
  }
}

std::string_view noun(ElementKind kind, int dim) {
  switch (kind) {
    case ElementKind::vertex:
    case ElementKind::vertex_and_face:
    case ElementKind::two_vertices:
      return "vertex";
    case ElementKind::edge:
      return dim == 2 ? "vertex" : "edge (by its vertices)";
    case ElementKind::component:
      return "component (by its first face)";
    default:
      return dim == 2 ? "segment" : "face";
  }
}

/// Returns the advice on open edges, which depends on whether there is a hole at all.
std::string advice_on_openings(const MeshReport& report) {
  if (report[MeshFault::t_junction].count + report[MeshFault::near_vertex].count > 0)
    return "fix the T-junctions and near vertices, which leave slits";
  const std::uint32_t sheets = report.sheets, open = report.open_components;
  // Only sheets: closing them would create a body without volume.
  if (sheets > 0 && sheets == open)
    return sheets == 1 ? "this is a sheet, which does not bound a solid"
                       : "these are " + std::to_string(sheets) + " sheets, which do not bound a solid";
  const std::string close(help_for(MeshFault::open_edge).advice);
  if (sheets == 0) return close;
  return close + ", but " + std::to_string(sheets) + " of the " + std::to_string(open) + " open components " +
         (sheets == 1 ? "is a sheet, which does" : "are sheets, which do") + " not bound a solid";
}

std::string line_for(const Mesh& mesh, MeshFault fault, const MeshReport& report) {
  const MeshFinding& finding = report[fault];
  const Help& help = help_for(fault);
  const bool is_2d = mesh.dim == 2;
  std::string line = mesh.name.empty() ? "mesh" : mesh.name;
  line.append(": ");
  line.append(is_2d && !help.text_2d.empty() ? help.text_2d : kFaults[static_cast<std::size_t>(fault)].text);
  // Number of findings, then the first affected elements in file order.
  if (help.kind != ElementKind::none) {
    line.append(" (").append(std::to_string(finding.count)).append(finding.count == 1 ? " time" : " times");
    line.append("): ").append(noun(help.kind, mesh.dim)).append(" ");
    const std::size_t some = std::min(finding.first.size(), MeshFinding::kShown);
    for (std::size_t i = 0; i < some; ++i)
      line.append(i == 0 ? "" : ", ").append(shown(help.kind, finding.first[i]));
    if (finding.count > some) line.append(", ...");
    line.append(", counted from 0 in file order");
  }
  line.append("; ");
  // In 2D an open edge is a loose end, for which the advice on sheets does not apply.
  if (fault == MeshFault::open_edge && !is_2d) return line + advice_on_openings(report);
  return line.append(is_2d && !help.advice_2d.empty() ? help.advice_2d : help.advice);
}

}  // namespace

std::string_view name_of(MeshFault fault) {
  return kFaults[static_cast<std::size_t>(fault)].name;
}

bool MeshReport::buildable() const {
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0 && !kFaults[i].build) return false;
  return true;
}

bool MeshReport::queryable() const {
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0 && !kFaults[i].query) return false;
  return true;
}

MeshReport MeshReport::when_turned() const {
  MeshReport turned = *this;
  turned.findings[static_cast<std::size_t>(MeshFault::inside_out)] = {};
  return turned;
}

MeshReport MeshReport::shortened() const {
  MeshReport few = *this;
  for (MeshFinding& f : few.findings) f.first.resize(std::min(f.first.size(), MeshFinding::kShown));
  return few;
}

std::string MeshReport::line(MeshFault fault, const Mesh& mesh) const {
  return line_for(mesh, fault, *this);
}

std::vector<std::string> MeshReport::lines(const Mesh& mesh) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0) out.push_back(line(static_cast<MeshFault>(i), mesh));
  return out;
}

std::vector<std::string> MeshReport::obstacles(const Mesh& mesh) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i)
    if (findings[i].count > 0 && !kFaults[i].build) out.push_back(line(static_cast<MeshFault>(i), mesh));
  return out;
}

}  // namespace lrb
