#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "render/findings_parts.hpp"
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::render::findings {
namespace {

using Eigen::Vector3d;

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
    for (const auto& [p, q] : o_.crossings) line({p, q}, style_.contact, 2, true, style_.paper);
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

  /// Returns, of two neighbouring faces with opposite orientations, the one that is known to be reversed, or
  /// the second.
  FaceId turned_of(const Element& e) const {
    const auto& reversed = report_[MeshFault::reversed_face].first;
    return FaceId(std::count(reversed.begin(), reversed.end(), Element{e[0], kNull}) > 0 ? e[0] : e[1]);
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
    if (kind == MeshFault::zero_area_face || kind == MeshFault::sliver) {
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
