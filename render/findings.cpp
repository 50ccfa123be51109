#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "render/findings_parts.hpp"
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::render::findings {

using Eigen::Vector3d;

namespace {

/// Returns the faces connected to this one by shared vertices.
std::vector<FaceId> component(const Mesh& mesh, FaceId first) {
  DisjointSets sets(mesh.vertices.size());
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    for (const VertexId v : mesh.face(f)) sets.join(mesh.face(f)[0], v);
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    if (sets.leader(mesh.face(f)[0]) == sets.leader(mesh.face(first)[0])) faces.push_back(f);
  return faces;
}

using Mark = LegendItem::Mark;

/// The meaning of the two numbers of an affected element.
enum class About : std::uint8_t { face, two_faces, component_of_face, vertex, two_vertices, edge };

struct FaultRow {
  MeshFault fault;
  About about;
  Rgba colour;
  Mark mark;
  std::string_view name, name_2d = name;  ///< "edge(s)", "vert(ex/ices)"
};
constexpr FaultRow kFaults[] = {
    {MeshFault::open_edge, About::edge, palette::kVermillion, Mark::line, "open edge(s)", "loose end(s)"},
    {MeshFault::t_junction, About::vertex, palette::kBlue, Mark::point, "T-junction(s)"},
    {MeshFault::near_vertex, About::two_vertices, palette::kBlue, Mark::point, "pair(s) of near vertices"},
    {MeshFault::non_manifold_edge, About::edge, palette::kPurple, Mark::line,
     "edge(s) with more than two faces", "branching vert(ex/ices)"},
    {MeshFault::non_manifold_vertex, About::vertex, palette::kPurple, Mark::point,
     "vert(ex/ices) with several fans"},
    {MeshFault::flipped_face, About::two_faces, palette::kBlue, Mark::solid,
     "pair(s) of inconsistently oriented neighbours"},
    {MeshFault::duplicate_face, About::two_faces, palette::kGreen, Mark::solid, "duplicate face(s)",
     "duplicate segment(s)"},
    {MeshFault::self_intersection, About::two_faces, palette::kOrange, Mark::solid,
     "intersecting pair(s) of faces", "intersecting pair(s) of segments"},
    {MeshFault::reversed_face, About::face, palette::kBlue, Mark::solid, "reversed face(s)",
     "reversed segment(s)"},
    {MeshFault::sliver, About::face, palette::kYellow, Mark::line, "sliver(s)"},
    {MeshFault::non_planar_face, About::face, palette::kYellow, Mark::solid, "non-planar polygon(s)"},
    {MeshFault::non_convex_face, About::face, palette::kYellow, Mark::solid, "concave polygon(s)"},
    {MeshFault::folded_face, About::face, palette::kYellow, Mark::solid, "crossed polygon(s)"},
    {MeshFault::repeated_corner, About::face, palette::kYellow, Mark::solid, "face(s) with a corner twice"},
    {MeshFault::zero_area_face, About::face, palette::kYellow, Mark::line, "face(s) without area",
     "segment(s) without length"},
    {MeshFault::inside_out, About::component_of_face, palette::kSkyBlue, Mark::solid,
     "inside-out component(s)"},
    {MeshFault::duplicate_vertex, About::two_vertices, palette::kGreen, Mark::point,
     "pair(s) of coincident vertices"},
    {MeshFault::unused_vertex, About::vertex, palette::kInk, Mark::point, "unused vert(ex/ices)"}};

/// Returns the name of one or several elements.
std::string name_of(const FaultRow& row, int dim, bool one) {
  const std::string_view name = dim == 2 ? row.name_2d : row.name;
  const std::size_t open = name.find('('), close = name.find(')'), slash = std::min(name.find('/'), close);
  const std::string_view first = name.substr(open + 1, slash - open - 1);  // "s", "ex"
  const std::string_view ending = slash < close ? (one ? first : name.substr(slash + 1, close - slash - 1))
                                  : one         ? std::string_view()
                                                : first;
  return std::string(name.substr(0, open)).append(ending).append(name.substr(close + 1));
}

const FaultRow& row_of(MeshFault kind) {
  return *std::find_if(std::begin(kFaults), std::end(kFaults) - 1,
                       [&](const FaultRow& row) { return row.fault == kind; });
}

}  // namespace

Parts parts_of(const Mesh& mesh, MeshFault kind, const Element& e) {
  switch (row_of(kind).about) {
    case About::face:
      return {{FaceId(e[0])}, {}, false};
    case About::two_faces:
      return {{FaceId(e[0]), FaceId(e[1])}, {}, false};
    case About::component_of_face:
      return {component(mesh, FaceId(e[0])), {}, false};
    case About::two_vertices:
      return {{}, {VertexId(e[0]), VertexId(e[1])}, false};
    case About::edge:
      if (e[1] != kNull) return {{}, {VertexId(e[0]), VertexId(e[1])}, true};
      [[fallthrough]];
    case About::vertex:
      break;
  }
  return {{}, {VertexId(e[0])}, false};
}

std::string number_of(MeshFault kind, const Element& e) {
  const About about = row_of(kind).about;
  const bool is_edge = about == About::edge && e[1] != kNull;
  if (!is_edge && about != About::two_faces && about != About::two_vertices) return std::to_string(e[0]);
  return std::to_string(e[0]) + (is_edge ? "-" : " + ") + std::to_string(e[1]);
}

std::vector<Vector3d> corners(const Mesh& mesh, FaceId f) {
  std::vector<Vector3d> x;
  for (const VertexId v : mesh.face(f)) x.push_back(mesh.vertices[v]);
  return x;
}

Vector3d normal(const Mesh& mesh, FaceId f) {
  const std::vector<Vector3d> x = corners(mesh, f);
  Vector3d n = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < x.size(); ++i) n += (x[i] - x[0]).cross(x[i + 1] - x[0]);
  return n;
}

namespace {

/// An unused vertex farther from the faces than this many times their size is omitted from the picture.
constexpr double kNear = 1.0;
/// In the close-up of a vertex, faces farther away than this many times their size are omitted.
constexpr double kFar = 20;
/// Share of the default direction that is added to a normal, so that a close-up does not look flat.
constexpr double kTilt = 0.35;

/// Returns the faces at an affected element: its own, or those that use its vertices (for an edge, both of
/// them).
std::vector<FaceId> faces_at(const Mesh& mesh, const Parts& parts) {
  if (!parts.faces.empty()) return parts.faces;
  std::vector<FaceId> out;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto c = mesh.face(f);
    const auto uses = [&](VertexId v) { return std::find(c.begin(), c.end(), v) != c.end(); };
    const bool any = std::any_of(parts.vertices.begin(), parts.vertices.end(), uses);
    if (parts.edge ? std::all_of(parts.vertices.begin(), parts.vertices.end(), uses) : any) out.push_back(f);
  }
  return out;
}

bool is_inside_out(const Mesh& mesh, const MeshReport& report, FaceId f) {
  const auto& pieces = report[MeshFault::inside_out].first;
  return std::any_of(pieces.begin(), pieces.end(), [&](const Element& piece) {
    const std::vector<FaceId> faces = component(mesh, FaceId(piece[0]));
    return std::binary_search(faces.begin(), faces.end(), f);
  });
}

/// Returns a direction along a normal, tilted slightly.
ViewDirection tilted(const Vector3d& n) {
  ViewDirection view;
  view.from = n.normalized() + kTilt * ViewDirection{}.from.normalized();
  constexpr double kSteep = 0.9;  // z component of a unit vector: above this, y is up
  if (std::abs(view.from.normalized().z()) > kSteep) view.up = {0, 1, 0};
  return view;
}

/// Returns " in 3 loops, of 9, 4 and 3"; lists the first few loops.
std::string loops_text(std::span<const BoundaryLoop> loops) {
  constexpr std::size_t kMax = 8;
  std::string out = " in " + group_digits(loops.size()) + (loops.size() == 1 ? " loop" : " loops");
  if (loops.size() == 1) return out;
  for (std::size_t i = 0; i < std::min(loops.size(), kMax); ++i)
    out += (i == 0 ? ", of " : i + 1 == loops.size() ? " and " : ", ") + group_digits(loops[i].edges());
  return out + (loops.size() > kMax ? ", …" : "");
}

Eigen::AlignedBox3d box_of_faces(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const VertexId v : mesh.face_vertices) box.extend(mesh.vertices[v]);
  return box;
}

/// Translates and scales points so that a mesh's faces fit into [-1, 1].
class UnitSize {
 public:
  explicit UnitSize(const Mesh& mesh) {
    const Eigen::AlignedBox3d box = box_of_faces(mesh);
    if (box.isEmpty()) return;
    centre_ = 0.5 * box.min() + 0.5 * box.max();
    const double half = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
    if (half > 0) half_ = half;
  }
  Vector3d operator()(const Vector3d& x) const { return (x - centre_) / half_; }

 private:
  Vector3d centre_ = Vector3d::Zero();
  double half_ = 1;
};

}  // namespace

std::vector<MeshFault> kinds(const MeshReport& report) {
  const auto& flat = report[MeshFault::zero_area_face].first;
  std::vector<MeshFault> out;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
    const auto kind = static_cast<MeshFault>(i);
    const auto& first = report.findings[i].first;
    if (first.empty() || kind == MeshFault::no_faces || kind == MeshFault::non_finite_vertex ||
        kind == MeshFault::index_out_of_range)
      continue;
    const auto is_flat = [&](const Element& e) {
      return std::find(flat.begin(), flat.end(), Element{e[0], kNull}) != flat.end();
    };
    if (kind == MeshFault::repeated_corner && std::all_of(first.begin(), first.end(), is_flat)) continue;
    // If all intersecting pairs are doubled faces, do not report them twice.
    const MeshFinding& doubled = report[MeshFault::duplicate_face];
    if (kind == MeshFault::self_intersection && report.findings[i].count == doubled.count &&
        first == doubled.first)
      continue;
    out.push_back(kind);
  }
  return out;
}

LegendItem key(MeshFault kind, int dim) {
  const FaultRow& style = row_of(kind);
  const bool point = dim == 2 && style.about == About::edge;
  const bool line = dim == 2 && style.mark == Mark::solid;
  return {point ? Mark::point : line ? Mark::line : style.mark, style.colour, name_of(style, dim, true)};
}

std::string caption(MeshFault kind, const MeshFinding& finding, int dim,
                    std::span<const BoundaryLoop> loops) {
  std::string out = group_digits(finding.count) + " " + name_of(row_of(kind), dim, finding.count == 1);
  if (kind == MeshFault::open_edge && !loops.empty()) return out + loops_text(loops);
  out += ": ";
  for (std::size_t i = 0; i < finding.first.size(); ++i)
    out += (i > 0 ? ", " : "") + number_of(kind, finding.first[i]);
  return out + (finding.count > finding.first.size() ? ", …" : "");
}

Mesh to_unit_size(const Mesh& mesh) {
  Mesh out = mesh;
  const UnitSize unit(mesh);
  for (Vector3d& x : out.vertices) x = unit(x);
  return out;
}

Vector3d to_unit_size(const Mesh& mesh, const Vector3d& x) {
  return UnitSize(mesh)(x);
}

CloseUp close_up_of_loop(const Mesh& mesh, const BoundaryLoop& loop) {
  CloseUp out;
  Vector3d n = Vector3d::Zero();
  const Vector3d first = mesh.vertices[loop.vertices[0]];
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const Vector3d x = mesh.vertices[loop.vertices[i]];
    out.points.push_back(x);
    // The loop has its faces on the left, so that a lid's normal points the other way. The sum is the loop's
    // area vector; the loop need not be planar.
    n += (mesh.vertices[loop.vertices[(i + 1) % loop.vertices.size()]] - first).cross(x - first);
  }
  if (!(n.norm() > 0)) return out;
  out.view = tilted(n);
  return out;
}

std::vector<Vector3d> whole(const Mesh& mesh, const MeshReport& report) {
  std::vector<Vector3d> out;
  for (const VertexId v : mesh.face_vertices) out.push_back(mesh.vertices[v]);
  const Eigen::AlignedBox3d box = box_of_faces(mesh);
  for (const Element& e : report[MeshFault::unused_vertex].first)
    if (box.exteriorDistance(mesh.vertices[e[0]]) <= kNear * box.diagonal().norm())
      out.push_back(mesh.vertices[e[0]]);
  return out;
}

CloseUp close_up(const Mesh& mesh, const MeshReport& report, MeshFault kind,
                 std::span<const BoundaryLoop> loops) {
  if (kind == MeshFault::open_edge && !loops.empty()) return close_up_of_loop(mesh, loops[0]);
  // Step 1: the affected faces, and an average normal.
  const Parts parts = parts_of(mesh, kind, report[kind].first.front());
  const std::vector<FaceId> at = faces_at(mesh, parts);
  const bool is_ambiguous = kind == MeshFault::flipped_face || kind == MeshFault::duplicate_face ||
                            kind == MeshFault::reversed_face;
  CloseUp out;
  Vector3d n = Vector3d::Zero(), centroid = Vector3d::Zero();
  std::set<VertexId> own(parts.vertices.begin(), parts.vertices.end());
  for (const FaceId f : at) {
    const Vector3d m = normal(mesh, f);
    // Opposite normals would cancel: flip to agree with the sum so far.
    n += is_ambiguous && n.dot(m) < 0 ? -m : m;
    if (!parts.faces.empty()) own.insert(mesh.face(f).begin(), mesh.face(f).end());
  }
  // Step 2: the neighbourhood, which gives context.
  std::set<VertexId> around = own;
  if (kind != MeshFault::self_intersection && kind != MeshFault::inside_out)
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      const auto c = mesh.face(f);
      if (std::any_of(c.begin(), c.end(), [&](VertexId v) { return own.contains(v); }))
        around.insert(c.begin(), c.end());
    }
  for (const VertexId v : own) centroid += mesh.vertices[v] / static_cast<double>(own.size());
  for (const VertexId v : around) out.points.push_back(mesh.vertices[v]);
  if (kind == MeshFault::unused_vertex) {
    const std::vector<Vector3d> all = whole(mesh, {});
    if (box_of_faces(mesh).exteriorDistance(out.points[0]) <= kFar * box_of_faces(mesh).diagonal().norm())
      out.points.insert(out.points.end(), all.begin(), all.end());
  }
  if (kind == MeshFault::inside_out || kind == MeshFault::unused_vertex) return out;
  // Step 3: look from outside, at an angle.
  if (!at.empty() && is_inside_out(mesh, report, at[0])) n = -n;
  if (is_ambiguous && n.dot(centroid) < 0) n = -n;
  if (!(n.norm() > 0)) n = centroid;
  if (!(n.norm() > 0)) return out;
  out.view = tilted(n);
  return out;
}

std::vector<LegendItem> legend(const MeshReport& report, int dim, StyleName style_name) {
  const Style& style = style_of(style_name);
  std::vector<LegendItem> out;
  if (dim == 3) {
    out.push_back({Mark::solid, style.front, "front of a face"});
    out.push_back({Mark::solid, style.back, "back of a face"});
  }
  for (const MeshFault kind : kinds(report)) {
    out.push_back(key(kind, dim));
    out.back().colour = style.of(out.back().colour);
    if (kind == MeshFault::self_intersection) {
      out.back().text = dim == 2 ? "self-intersecting segment" : "intersecting face";
      out.push_back({out.back().mark, palette::kSkyBlue, "face intersected by it"});
      out.push_back({dim == 3 ? Mark::line : Mark::point, style.contact, "intersection"});
    }
  }
  return out;
}

}  // namespace lrb::render::findings
