#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::render::findings {

using Eigen::Vector3d;

namespace {

using Element = std::array<std::uint32_t, 2>;

/// The parts of one affected element; empty if it has none of a kind.
struct Parts {
  std::vector<FaceId> faces;       ///< the affected faces
  std::vector<VertexId> vertices;  ///< the affected vertices
  bool edge = false;               ///< the two vertices form an edge
};

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
  const char *one, *many, *one_2d, *many_2d;
  Rgba colour;
  Mark mark;
};
constexpr const char *kFlipped = "pair of inconsistently oriented neighbours",
                     *kFlippedMany = "pairs of inconsistently oriented neighbours",
                     *kInsideOut = "inside-out component", *kInsideOutMany = "inside-out components",
                     *kCoincident = "pair of coincident vertices",
                     *kCoincidentMany = "pairs of coincident vertices";
constexpr FaultRow kFaults[] = {
    {MeshFault::open_edge, About::edge, "open edge", "open edges", "loose end", "loose ends",
     palette::kVermillion, Mark::line},
    {MeshFault::non_manifold_edge, About::edge, "edge with more than two faces",
     "edges with more than two faces", "branching vertex", "branching vertices", palette::kPurple,
     Mark::line},
    {MeshFault::non_manifold_vertex, About::vertex, "vertex with several fans", "vertices with several fans",
     "", "", palette::kPurple, Mark::point},
    {MeshFault::flipped_face, About::two_faces, kFlipped, kFlippedMany, kFlipped, kFlippedMany,
     palette::kBlue, Mark::solid},
    {MeshFault::duplicate_face, About::two_faces, "duplicate face", "duplicate faces", "duplicate segment",
     "duplicate segments", palette::kGreen, Mark::solid},
    {MeshFault::self_intersection, About::two_faces, "intersecting pair of faces",
     "intersecting pairs of faces", "intersecting pair of segments", "intersecting pairs of segments",
     palette::kOrange, Mark::solid},
    {MeshFault::non_planar_face, About::face, "non-planar polygon", "non-planar polygons", "", "",
     palette::kYellow, Mark::solid},
    {MeshFault::non_convex_face, About::face, "concave polygon", "concave polygons", "", "", palette::kYellow,
     Mark::solid},
    {MeshFault::folded_face, About::face, "crossed polygon", "crossed polygons", "", "", palette::kYellow,
     Mark::solid},
    {MeshFault::repeated_corner, About::face, "face with a corner twice", "faces with a corner twice", "", "",
     palette::kYellow, Mark::solid},
    {MeshFault::zero_area_face, About::face, "face without area", "faces without area",
     "segment without length", "segments without length", palette::kYellow, Mark::line},
    {MeshFault::inside_out, About::component_of_face, kInsideOut, kInsideOutMany, kInsideOut, kInsideOutMany,
     palette::kSkyBlue, Mark::solid},
    {MeshFault::duplicate_vertex, About::two_vertices, kCoincident, kCoincidentMany, kCoincident,
     kCoincidentMany, palette::kGreen, Mark::point},
    {MeshFault::unused_vertex, About::vertex, "unused vertex", "unused vertices", "unused vertex",
     "unused vertices", palette::kInk, Mark::point}};

const FaultRow& row_of(MeshFault kind) {
  return *std::find_if(std::begin(kFaults), std::end(kFaults) - 1,
                       [&](const FaultRow& row) { return row.fault == kind; });
}

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

/// Returns the display name of an affected element: "0-42", "3 + 80", "7".
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

/// Not of unit length; 0 in 2D.
Vector3d normal(const Mesh& mesh, FaceId f) {
  const std::vector<Vector3d> x = corners(mesh, f);
  Vector3d n = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < x.size(); ++i) n += (x[i] - x[0]).cross(x[i + 1] - x[0]);
  return n;
}

/// Cuts shorter than this share of the faces' sizes are ignored: with rounded coordinates, coplanar faces
/// appear to intersect in specks.
constexpr double kMinCut = 1e-6;

using Triangle = std::array<Vector3d, 3>;

/// Returns the point in which a segment passes through a triangle.
std::optional<Vector3d> passage(const Vector3d& p, const Vector3d& q, const Triangle& b) {
  const Vector3d n = (b[1] - b[0]).cross(b[2] - b[0]);
  // Signed distances of the ends from the plane; on the same side there is no crossing.
  const double dp = n.dot(p - b[0]), dq = n.dot(q - b[0]);
  if ((dp > 0) == (dq > 0) || dp == dq) return std::nullopt;
  const Vector3d x = p + dp / (dp - dq) * (q - p);
  // Inside if to the left of all three edges. Floating point: pictures only.
  for (std::size_t k = 0; k < 3; ++k)
    if (n.dot((b[(k + 1) % 3] - b[k]).cross(x - b[k])) < 0) return std::nullopt;
  return x;
}

void add_cuts(const Triangle& a, const Triangle& b, std::vector<Vector3d>& out) {
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto x = passage(a[i], a[(i + 1) % 3], b)) out.push_back(*x);
}

/// Returns true if a segment passes through a face, in doubles.
bool passes_through(const Mesh& mesh, FaceId f, const Vector3d& from, const Vector3d& to) {
  const std::vector<Vector3d> x = corners(mesh, f);
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    if (passage(from, to, {x[0], x[i], x[i + 1]})) return true;
  return false;
}

/// Returns the segment (2D: point) in which two faces intersect, in doubles; empty if they are disjoint or
/// coplanar.
std::vector<Vector3d> cut(const Mesh& mesh, FaceId f, FaceId g) {
  const std::vector<Vector3d> x = corners(mesh, f), y = corners(mesh, g);
  std::vector<Vector3d> found;
  // Segments: Cramer's rule, parallel ones have no single point.
  if (mesh.dim == 2) {
    const Vector3d u = x[1] - x[0], v = y[1] - y[0];
    const double turn = u.cross(v).z();
    if (turn != 0) found.push_back(x[0] + (y[0] - x[0]).cross(v).z() / turn * u);
    return found;
  }
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    for (std::size_t k = 1; k + 1 < y.size(); ++k) {
      // Edges of each triangle through the other one. The cut of two triangles is a segment between two of
      // these points.
      add_cuts({x[0], x[i], x[i + 1]}, {y[0], y[k], y[k + 1]}, found);
      add_cuts({y[0], y[k], y[k + 1]}, {x[0], x[i], x[i + 1]}, found);
    }
  if (found.size() < 2) return {};
  const auto far = [](const Vector3d& from, const std::vector<Vector3d>& points) {
    return *std::max_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
      return (p - from).squaredNorm() < (q - from).squaredNorm();
    });
  };
  // The points are collinear up to rounding, so two steps find both ends.
  const Vector3d one = far(found[0], found), other = far(one, found);
  const double size = (x[1] - x[0]).norm() + (y[1] - y[0]).norm();
  if (!((other - one).norm() > kMinCut * size)) return {};
  return {one, other};
}

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
  return {point  ? Mark::point
          : line ? Mark::line
                 : style.mark,
          style.colour, dim == 2 ? style.one_2d : style.one};
}

std::string caption(MeshFault kind, const MeshFinding& finding, int dim,
                    std::span<const BoundaryLoop> loops) {
  const FaultRow& style = row_of(kind);
  const bool one = finding.count == 1;
  std::string out = group_digits(finding.count) + " " +
                    (dim == 2 ? (one ? style.one_2d : style.many_2d) : (one ? style.one : style.many));
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
  const bool is_ambiguous = kind == MeshFault::flipped_face || kind == MeshFault::duplicate_face;
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

namespace {

/// Share by which the colour of a flipped face's neighbour fades.
constexpr double kNeighbourPale = 0.6;
/// Alpha of faces in front of the subject of a close-up.
constexpr std::uint8_t kVeil = 50;
/// Faces hide an element if they are within this share of the distance to it; its own faces are not.
constexpr double kJustBefore = 0.999;

class FindingsListBuilder {
 public:
  FindingsListBuilder(const Mesh& mesh, const MeshReport& report, const Camera& camera,
                      const Options& options)
      : mesh_(mesh), report_(report), camera_(camera), o_(options) {}

  DrawList run() {
    std::vector<MeshFault> all = kinds(report_);
    // Components come last: faults of their single faces must stay visible on them.
    std::stable_partition(all.begin(), all.end(), [](MeshFault k) { return k != MeshFault::inside_out; });
    for (const MeshFault kind : all)
      for (const Element& e : report_[kind].first) choose_colours(kind, e);
    veiled_ = o_.focus && (*o_.focus == MeshFault::inside_out || is_hidden(*o_.focus));
    mesh_.dim == 2 ? segments() : faces();
    std::vector<MeshFault> marked = kinds(report_);
    // The subject of the picture is drawn last, over the others.
    std::stable_partition(marked.begin(), marked.end(),
                          [&](MeshFault k) { return !o_.focus || k != *o_.focus; });
    for (const MeshFault kind : marked)
      if (has_loops(kind))
        rims();
      else
        for (const Element& e : report_[kind].first) mark(kind, e);
    Eigen::AlignedBox3d scene = bounds(out_);
    projection_.emplace(camera_, o_.width, o_.height, scene);
    char letter = 'b';
    for (const MeshFault kind : kinds(report_)) {
      if (!o_.focus)
        point_at(kind, std::string(1, letter++));
      else if (*o_.focus == kind && has_loops(kind))
        number_rims();
      else if (*o_.focus == kind)
        for (const Element& e : report_[kind].first)
          if (o_.near.isEmpty() || o_.near.contains(place(kind, e)))
            label(place(kind, e), number_of(kind, e), 0);
    }
    return std::move(out_);
  }

 private:
  Rgba colour(MeshFault kind) const { return style_.of(key(kind, mesh_.dim).colour); }

  bool has_loops(MeshFault kind) const { return kind == MeshFault::open_edge && !o_.loops.empty(); }

  void rims() {
    for (const BoundaryLoop& loop : o_.loops) {
      std::vector<Vector3d> points;
      for (const VertexId v : loop.vertices) points.push_back(mesh_.vertices[v]);
      if (loop.is_loop) points.push_back(points[0]);
      line(points, colour(MeshFault::open_edge), 4, true);
    }
  }

  void number_rims() {
    for (std::size_t i = 0; i < o_.loops.size(); ++i) {
      const Vector3d x = on_rim(o_.loops[i]);
      if (o_.near.isEmpty() || o_.near.contains(x)) label(x, std::to_string(i), 0);
    }
  }

  Vector3d on_rim(const BoundaryLoop& loop) const {
    return (mesh_.vertices[loop.vertices[0]] + mesh_.vertices[loop.vertices[1]]) / 2;
  }

  /// Chooses the fault that colours a face: the first it has, except that the subject of a close-up has
  /// priority.
  void choose_colours(MeshFault kind, const Element& e) {
    const bool first = o_.focus && *o_.focus == kind;
    const auto give = [&](FaceId f, Rgba c) {
      if (first && !chosen_.contains(f)) {
        chosen_.insert(f);
        colours_[f] = c;
      } else {
        colours_.emplace(f, c);
      }
    };
    if (kind == MeshFault::zero_area_face) return;
    if (kind == MeshFault::inside_out && o_.focus && !first)
      return;  // it would hide the subject of the picture
    if (kind == MeshFault::self_intersection) {
      give(FaceId(e[0]), palette::kOrange);
      give(FaceId(e[1]), palette::kSkyBlue);
      return;
    }
    if (kind == MeshFault::flipped_face) {
      const FaceId turned = turned_of(e);
      give(turned, colour(kind));
      give(FaceId(turned == e[0] ? e[1] : e[0]), style_.pale(colour(kind), kNeighbourPale));
      return;
    }
    for (const FaceId f : parts_of(mesh_, kind, e).faces) give(f, colour(kind));
  }

  /// Returns, of two neighbouring faces with opposite orientations, the one that disagrees with more
  /// neighbours.
  FaceId turned_of(const Element& e) const {
    std::map<FaceId, int> times;
    for (const Element& other : report_[MeshFault::flipped_face].first) {
      ++times[FaceId(other[0])];
      ++times[FaceId(other[1])];
    }
    const FaceId first(e[0]), second(e[1]);
    return times[first] > times[second] ? first : second;
  }

  bool seen_from_back(FaceId f) const {
    const Vector3d n = normal(mesh_, f);
    return n.dot(camera_.orthographic ? camera_.eye - camera_.target
                                      : camera_.eye - mesh_.vertices[mesh_.face(f)[0]]) < 0;
  }

  /// Returns true if faces lie between the eye and the first affected element.
  bool is_hidden(MeshFault kind) const {
    const Vector3d to = camera_.eye + kJustBefore * (place(kind, report_[kind].first.front()) - camera_.eye);
    for (FaceId f = 0; f < mesh_.face_count() && mesh_.dim == 3; ++f)
      if (!colours_.contains(f) && passes_through(mesh_, f, camera_.eye, to)) return true;
    return false;
  }

  void faces() {
    const std::uint8_t thin = out_.edge_style({with_alpha(palette::kInk, 90), 0.9F * o_.scale});
    const std::uint8_t strong = out_.edge_style({palette::kInk, 1.8F * o_.scale});
    for (FaceId f = 0; f < mesh_.face_count(); ++f) {
      const auto c = colours_.find(f);
      DrawTriangle t;
      t.colour = seen_from_back(f) ? style_.back : style_.front;
      t.edge_style = thin;
      t.edges = 7;
      if (c != colours_.end()) {
        t.colour = c->second;
        t.edge_style = strong;
        t.nudge = 1;  // drawn over another face in the same position
      } else if (veiled_) {
        t.layer = Layer::translucent;
        t.colour.a = kVeil;
      }
      t.id = f;
      out_.add_polygon(corners(mesh_, f), t);
    }
  }

  void segments() {
    for (const bool marked : {false, true})
      for (FaceId f = 0; f < mesh_.face_count(); ++f) {
        const auto c = colours_.find(f);
        if ((c != colours_.end()) == marked)
          line(corners(mesh_, f), marked ? c->second : style_.faint, marked ? 5.0F : 2.0F, marked);
      }
  }

  void line(const std::vector<Vector3d>& points, Rgba colour, float width, bool strong,
            std::optional<Rgba> halo = std::nullopt) {
    DrawLine l;
    l.points = points;
    l.colour = colour;
    l.width = width * o_.scale;
    if (strong) {
      l.halo = halo.value_or(style_.ink);
      l.halo_width = 1.2F * o_.scale;
      l.layer = Layer::on_top;
    }
    out_.lines.push_back(std::move(l));
  }

  void dot(const Vector3d& x, Rgba colour, float radius) {
    DrawPoint p;
    p.x = x;
    p.colour = colour;
    p.radius = radius * o_.scale;
    p.halo = colour == style_.ink ? style_.paper : style_.ink;
    p.halo_width = 1.4F * o_.scale;
    p.layer = Layer::on_top;
    out_.points.push_back(p);
  }

  /// Draws edges, vertices, zero-area faces and cuts, which face colours cannot show.
  void mark(MeshFault kind, const Element& e) {
    const Parts parts = parts_of(mesh_, kind, e);
    if (parts.edge) line({mesh_.vertices[e[0]], mesh_.vertices[e[1]]}, colour(kind), 5, true);
    if (!parts.edge && !parts.vertices.empty()) dot(mesh_.vertices[e[0]], colour(kind), 6);
    if (kind == MeshFault::zero_area_face) {
      std::vector<Vector3d> x = corners(mesh_, FaceId(e[0]));
      const bool one_place = std::all_of(x.begin(), x.end(), [&](const Vector3d& p) { return p == x[0]; });
      if (one_place) return dot(x[0], colour(kind), 6);
      x.push_back(x[0]);
      line(x, colour(kind), 4, true);
    }
    if (kind == MeshFault::self_intersection) {
      const std::vector<Vector3d> x = cut(mesh_, FaceId(e[0]), FaceId(e[1]));
      if (x.size() == 1) dot(x[0], style_.contact, 5);
      if (x.size() == 2) line(x, style_.contact, 4, true, style_.paper);
    }
  }

  Vector3d place(MeshFault kind, const Element& e) const {
    if (has_loops(kind)) return on_rim(o_.loops[0]);
    const Parts parts = parts_of(mesh_, kind, e);
    std::vector<Vector3d> x;
    for (const VertexId v : parts.vertices) x.push_back(mesh_.vertices[v]);
    if (x.empty()) {
      if (kind == MeshFault::self_intersection) x = cut(mesh_, FaceId(e[0]), FaceId(e[1]));
      if (x.empty()) x = corners(mesh_, FaceId(e[0]));
    }
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& p : x) sum += p / static_cast<double>(x.size());
    return sum;
  }

  /// Writes a kind's letter at its first affected element.
  void point_at(MeshFault kind, const std::string& letter) {
    const Vector3d x = place(kind, report_[kind].first.front());
    dot(x, colour(kind), 5);
    label(x, letter, 1);
  }

  /// Puts a label above its point, unless it would cover another label or leave the picture.
  void label(const Vector3d& x, const std::string& text, int sideways) {
    const auto at = projection_->to_pixel(x);
    if (!at) return;
    DrawLabel l;
    l.x = x;
    l.text = text;
    l.colour = style_.ink;
    l.halo = style_.paper;
    l.height = 17 * o_.scale;
    const double half = 0.3 * l.height * static_cast<double>(text.size()) + 2, rise = 0.6 * l.height;
    for (const auto& [dx, dy] : {std::pair{sideways, -1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {0, 1}}) {
      l.dx = static_cast<float>(dx * (half + 6));
      l.dy = 1.1F * static_cast<float>(dy) * l.height;
      const Eigen::Vector2d c = *at + Eigen::Vector2d(l.dx, l.dy);
      const Eigen::AlignedBox2d box(c - Eigen::Vector2d(half, rise), c + Eigen::Vector2d(half, rise));
      const bool in = box.min().minCoeff() >= 0 && box.max().x() <= o_.width && box.max().y() <= o_.height;
      const bool free =
          std::none_of(taken_.begin(), taken_.end(), [&](const auto& b) { return b.intersects(box); });
      if (!in || !free) continue;
      taken_.push_back(box);
      out_.labels.push_back(l);
      return;
    }
  }

  const Mesh& mesh_;
  const MeshReport& report_;
  const Camera& camera_;
  const Options& o_;
  const Style& style_ = style_of(o_.style);
  DrawList out_;
  std::map<FaceId, Rgba> colours_;
  std::set<FaceId> chosen_;
  bool veiled_ = false;  ///< faces without a fault are translucent
  std::optional<Projection> projection_;
  std::vector<Eigen::AlignedBox2d> taken_;
};

}  // namespace

DrawList list(const Mesh& mesh, const MeshReport& report, const Camera& camera, const Options& options) {
  return FindingsListBuilder(mesh, report, camera, options).run();
}

}  // namespace lrb::render::findings
