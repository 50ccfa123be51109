// Projects a draw list to screen triangles. Clipping, snapping, lighting and the widths of lines and edges
// are computed here in double, so that the rasterizer only interpolates and pictures are reproducible.

#include "render/screen_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>

#include "render/face_look.hpp"
#include <lrbscope/core/polygon.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

// Exact painting order by binary space partitioning (Fuchs, Kedem and Naylor 1980). Large sets are halved by
// planes perpendicular to an axis, small ones are split by the planes of their own polygons.

namespace {

using Eigen::Vector3d;

/// Maximum number of polygons that are split by their own planes.
constexpr std::size_t kLeaf = 24;
/// A corner closer to a plane than this share of the scene's size counts as on it. The error is invisible.
constexpr double kOnPlane = 1e-9;
/// Axis-perpendicular planes are used while neither side keeps more than this share of the polygons.
constexpr double kWorthIt = 0.75;
/// Maximum recursion depth, for sets that splitting does not reduce (many polygons through one point).
constexpr int kMaxDepth = 64;

struct Plane {
  Vector3d normal;
  double offset;
  double height(const Vector3d& x) const { return normal.dot(x) - offset; }
};

struct Sides {
  std::vector<EyePolygon> front, on, back;
};

class Sorter {
 public:
  Sorter(bool orthographic, double tolerance, std::vector<EyePolygon>& out)
      : orthographic_(orthographic), tolerance_(tolerance), out_(out) {}

  void sort(std::vector<EyePolygon> polygons, int depth) {
    if (polygons.size() <= 1 || depth == kMaxDepth) {
      for (EyePolygon& p : polygons) out_.push_back(std::move(p));
      return;
    }
    Plane plane;
    // Axis planes keep the tree balanced; a polygon's own plane always makes progress, as it removes that
    // polygon.
    const bool by_axis = polygons.size() > kLeaf && median_plane(polygons, plane);
    if (!by_axis) plane = best_own_plane(polygons);
    Sides sides;
    for (EyePolygon& p : polygons) split(std::move(p), plane, sides);
    polygons.clear();
    // Everything on the far side of the plane is painted first. The eye is at the origin, or infinitely far
    // away along -z.
    const bool viewer_in_front = orthographic_ ? plane.normal.z() < 0 : plane.offset < 0;
    sort(std::move(viewer_in_front ? sides.back : sides.front), depth + 1);
    for (EyePolygon& p : sides.on) out_.push_back(std::move(p));
    sort(std::move(viewer_in_front ? sides.front : sides.back), depth + 1);
  }

 private:
  static Vector3d centre(const EyePolygon& p) {
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& x : p.x) sum += x;
    return sum / static_cast<double>(p.x.size());
  }

  /// Returns false if the plane would split too many polygons.
  bool median_plane(const std::vector<EyePolygon>& polygons, Plane& plane) const {
    Vector3d lo = Vector3d::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const EyePolygon& p : polygons) {
      const Vector3d c = centre(p);
      lo = lo.cwiseMin(c), hi = hi.cwiseMax(c);
    }
    int axis = 0;
    (hi - lo).maxCoeff(&axis);
    std::vector<double> at;
    for (const EyePolygon& p : polygons) at.push_back(centre(p)[axis]);
    const auto median = at.begin() + static_cast<std::ptrdiff_t>(at.size() / 2);
    // The median centre along the longest axis.
    std::nth_element(at.begin(), median, at.end());
    plane = {Vector3d::Unit(axis), *median};
    const Count n = count(polygons, plane);
    return static_cast<double>(std::max(n.front, n.back) + n.cut) <=
           kWorthIt * static_cast<double>(polygons.size());
  }

  /// Picks, among the first few polygons, the one whose plane splits the fewest others; on a tie, the one
  /// that divides them most evenly.
  Plane best_own_plane(const std::vector<EyePolygon>& polygons) const {
    Plane best{};
    std::size_t least = std::numeric_limits<std::size_t>::max();
    // A bounded number of candidates: each costs one pass over the polygons.
    for (std::size_t i = 0; i < std::min(polygons.size(), kLeaf); ++i) {
      Plane plane{polygons[i].normal.normalized(), 0};
      plane.offset = plane.normal.dot(centre(polygons[i]));
      const Count n = count(polygons, plane);
      const std::size_t cost =
          n.cut * polygons.size() + (n.front > n.back ? n.front - n.back : n.back - n.front);
      if (cost < least) least = cost, best = plane;
    }
    return best;
  }

  struct Count {
    std::size_t front = 0, back = 0, cut = 0;
  };
  Count count(const std::vector<EyePolygon>& polygons, const Plane& plane) const {
    Count n;
    for (const EyePolygon& p : polygons) {
      // Within the tolerance a corner counts as on the plane, so rounding makes no slivers.
      const auto [low, high] = heights(p, plane);
      if (low < -tolerance_ && high > tolerance_)
        ++n.cut;
      else if (high > tolerance_)
        ++n.front;
      else if (low < -tolerance_)
        ++n.back;
    }
    return n;
  }

  static std::pair<double, double> heights(const EyePolygon& p, const Plane& plane) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3d& x : p.x) {
      const double h = plane.height(x);
      low = std::min(low, h), high = std::max(high, h);
    }
    return {low, high};
  }

  void split(EyePolygon p, const Plane& plane, Sides& sides) const {
    const auto [low, high] = heights(p, plane);
    if (low >= -tolerance_ && high <= tolerance_) {
      sides.on.push_back(std::move(p));
    } else if (low >= -tolerance_) {
      sides.front.push_back(std::move(p));
    } else if (high <= tolerance_) {
      sides.back.push_back(std::move(p));
    } else {
      EyePolygon front{{}, p.normal, p.source}, back{{}, p.normal, p.source};
      for (std::size_t i = 0; i < p.x.size(); ++i) {
        const Vector3d &a = p.x[i], &b = p.x[(i + 1) % p.x.size()];
        const double ha = plane.height(a), hb = plane.height(b);
        if (ha >= -tolerance_) front.x.push_back(a);
        if (ha <= tolerance_) back.x.push_back(a);
        if ((ha > tolerance_ && hb < -tolerance_) || (ha < -tolerance_ && hb > tolerance_)) {
          const Vector3d cut = a + (b - a) * (ha / (ha - hb));
          front.x.push_back(cut);
          back.x.push_back(cut);
        }
      }
      sides.front.push_back(std::move(front));
      sides.back.push_back(std::move(back));
    }
  }

  bool orthographic_;
  double tolerance_;
  std::vector<EyePolygon>& out_;
};

}  // namespace

std::vector<EyePolygon> back_to_front(std::vector<EyePolygon> polygons, bool orthographic) {
  std::erase_if(polygons, [](const EyePolygon& p) { return !(p.normal.squaredNorm() > 0); });
  double size = 0;
  for (const EyePolygon& p : polygons) {
    // The tolerance is relative to the largest coordinate.
    for (const Vector3d& x : p.x) size = std::max(size, x.cwiseAbs().maxCoeff());
  }
  std::vector<EyePolygon> out;
  out.reserve(polygons.size() * 2);
  Sorter(orthographic, kOnPlane * size, out).sort(std::move(polygons), 0);
  return out;
}

// Projection.

namespace {

using Eigen::Vector2d;

/// Corners are rounded to 1/256 pixel, the grid of Mesa's rasterizer, so that Mesa does not round again.
constexpr double kSnap = 256;
/// A line's halo is this share of a nudge step behind the line.
constexpr double kHaloNudge = 0.25;
/// Corners farther outside than this many picture sizes are clipped, so that float coordinates stay precise.
constexpr double kGuard = 8;
/// Margin for the soft border of lines, pixels.
constexpr double kRim = 1;

double snap(double pixels) {
  return std::nearbyint(pixels * kSnap) / kSnap;
}

/// Returns homogeneous picture coordinates relative to the centre: pixel = (x, y) / w.
Vector3d homogeneous(const Projection& p, const Vector3d& eye) {
  return {p.focal() * eye.x(), p.focal() * eye.y(), p.orthographic() ? 1.0 : eye.z()};
}

class ScreenMeshBuilder {
 public:
  ScreenMeshBuilder(const DrawList& list, const Projection& projection, double scale,
                    const Lighting& lighting, bool even_edges)
      : list_(list), p_(projection), scale_(scale), looks_(list, projection, scale, lighting, even_edges) {}

  ScreenMesh build() {
    for (const DrawFill& f : list_.fills) add_fill(f);
    for (int layer = 0; layer < kLayers; ++layer) add_layer(static_cast<Layer>(layer));
    return std::move(mesh_);
  }

 private:
  void add_layer(Layer layer) {
    const auto index = static_cast<std::size_t>(layer);
    // Each layer is a contiguous range of vertices: one draw call.
    mesh_.face_layers[index].first = mesh_.faces.size();
    if (layer == Layer::opaque) {
      for (const DrawTriangle& t : list_.triangles) {
        if (t.layer == layer) add_face(t, visible_part(t));
      }
    } else {
      add_blended(layer);
    }
    mesh_.face_layers[index].count = mesh_.faces.size() - mesh_.face_layers[index].first;

    mesh_.line_layers[index].first = mesh_.lines.size();
    for (const DrawLine& l : list_.lines) {
      if (l.layer == layer) add_line(l);
    }
    for (const DrawPoint& d : list_.points) {
      if (d.layer == layer) add_point(d);
    }
    mesh_.line_layers[index].count = mesh_.lines.size() - mesh_.line_layers[index].first;
  }

  /// Adds translucent faces in painting order.
  void add_blended(Layer layer) {
    std::vector<EyePolygon> polygons;
    for (std::uint32_t i = 0; i < list_.triangles.size(); ++i) {
      if (list_.triangles[i].layer != layer) continue;
      // Clip first: depth order is computed for the visible parts only.
      EyePolygon p{visible_part(list_.triangles[i]), Vector3d::Zero(), i};
      if (p.x.size() < 3) continue;
      for (std::size_t j = 1; j + 1 < p.x.size(); ++j)
        p.normal += (p.x[j] - p.x[0]).cross(p.x[j + 1] - p.x[0]);
      polygons.push_back(std::move(p));
    }
    for (const EyePolygon& p : back_to_front(std::move(polygons), p_.orthographic())) {
      add_face(list_.triangles[p.source], p.x);
    }
  }

  // ---- faces

  glm::vec3 device(const Vector3d& screen, double nudge) const {
    // Normalised device coordinates; the nudge is applied in depth, so pixels do not move.
    const double z = std::clamp(p_.nearer(screen.z(), nudge * kNudge), -1.0, 1.0);
    return to_float(Vector3d(2 * screen.x() / p_.width() - 1, 2 * screen.y() / p_.height() - 1, z));
  }

  Vector3d snapped_screen(const Vector3d& eye) const {
    Vector3d s = p_.to_screen(eye);
    s.x() = snap(s.x());
    s.y() = snap(s.y());
    return s;
  }

  /// Returns the distance from a corner to a clipping plane, positive inside.
  double inside(const Vector3d& e, int plane) const {
    const double z = p_.orthographic() ? 1.0 : e.z();
    switch (plane) {
      case 0:
        return e.z() - p_.near_depth();
      case 1:
        return kGuard * p_.width() * z - p_.focal() * e.x();
      case 2:
        return kGuard * p_.width() * z + p_.focal() * e.x();
      case 3:
        return kGuard * p_.height() * z - p_.focal() * e.y();
      default:
        return kGuard * p_.height() * z + p_.focal() * e.y();
    }
  }
  static constexpr int kPlanes = 5;

  void clip(std::vector<Vector3d>& polygon) const {
    for (int plane = 0; plane < kPlanes && !polygon.empty(); ++plane) {
      std::vector<Vector3d> out;
      clip_polygon(
          polygon, [&](const Vector3d& x) { return inside(x, plane); },
          [&](const Vector3d& x, std::size_t, bool, bool) { out.push_back(x); });
      polygon = std::move(out);
    }
  }

  /// Returns the line of an edge on the screen: (a, b, c) with a x + b y + c w = distance in pixels times w.
  static Vector3d edge_line(const Vector3d& p, const Vector3d& q) {
    // The line through two homogeneous points; scaled so that a, b is a unit normal.
    const Vector3d line = p.cross(q);
    const double norm = std::hypot(line.x(), line.y());
    return norm > 0 ? Vector3d(line / norm) : Vector3d::Zero();
  }

  /// Returns the visible part of a triangle in the eye's frame. It has fewer than three corners if nothing is
  /// visible.
  std::vector<Vector3d> visible_part(const DrawTriangle& t) const {
    std::vector<Vector3d> polygon;
    for (const Vector3d& x : t.x) polygon.push_back(p_.to_eye(x));
    // Most triangles are entirely inside, and are not copied.
    const bool crosses = std::any_of(polygon.begin(), polygon.end(), [&](const Vector3d& e) {
      for (int plane = 0; plane < kPlanes; ++plane) {
        if (inside(e, plane) < 0) return true;
      }
      return false;
    });
    if (crosses) clip(polygon);
    return polygon;
  }

  /// Adds a convex part of a triangle, given in the eye's frame.
  void add_face(const DrawTriangle& t, const std::vector<Vector3d>& polygon) {
    if (polygon.size() < 3) return;
    const FaceLook look = looks_.of(t);
    FaceVertex v;
    v.colour = to_bytes(look.colour);
    v.id = t.id;
    v.half_width = to_float(0.5 * look.edge_width);
    v.edge_colour = to_bytes(look.edge_colour);
    // An opaque face stays opaque under its edges: blend them here, exactly.
    if (t.layer == Layer::opaque && t.edges != 0)
      v.edge_colour = to_bytes(over(look.edge_colour, with_alpha(look.colour, 255)));
    // Distances to the edges of the whole triangle are stored at each corner; the shader draws edges from
    // these.
    const std::array<Vector3d, 3> h = {homogeneous(p_, p_.to_eye(t.x[0])), homogeneous(p_, p_.to_eye(t.x[1])),
                                       homogeneous(p_, p_.to_eye(t.x[2]))};
    const std::array<Vector3d, 3> lines = {edge_line(h[0], h[1]), edge_line(h[1], h[2]),
                                           edge_line(h[2], h[0])};
    corners_.clear();
    for (const Vector3d& e : polygon) {
      const Vector3d at = homogeneous(p_, e);
      v.x = device(snapped_screen(e), t.nudge);
      for (int i = 0; i < 3; ++i) {
        // Bit i: edge i is drawn.
        v.edge[i] = (look.edges >> i & 1) != 0 ? to_float(std::abs(lines[i].dot(at) / at.z())) : kNoEdge;
      }
      corners_.push_back(v);
    }
    // A clipped triangle is convex: a fan covers it.
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
      mesh_.faces.insert(mesh_.faces.end(), {corners_[0], corners_[i], corners_[i + 1]});
    }
  }

  // ---- fills

  void add_fill(const DrawFill& fill) {
    if (fill.segments.empty()) return;
    FillRange range;
    FaceVertex v;
    v.edge = glm::vec3(kNoEdge);
    v.edge_colour = v.colour = to_bytes(fill.colour);
    v.id = fill.id;
    range.fan.first = mesh_.faces.size();
    const auto corner = [&](const Vector3d& x) {
      const Vector3d e = p_.to_eye(x);
      Vector3d s = snapped_screen(e);
      s.z() = 0;
      return device(s, 0);
    };
    // One triangle per segment with a common pivot; overlaps cancel in the even-odd count.
    const glm::vec3 pivot = corner(fill.segments[0][0]);
    glm::vec2 low(1), high(-1);
    for (const auto& [a, b] : fill.segments) {
      for (const glm::vec3& x : {pivot, corner(a), corner(b)}) {
        v.x = x;
        mesh_.faces.push_back(v);
        low = glm::min(low, glm::vec2(x));
        high = glm::max(high, glm::vec2(x));
      }
    }
    range.fan.count = mesh_.faces.size() - range.fan.first;
    // The covering rectangle, limited to the picture.
    low = glm::clamp(low, -1.0F, 1.0F);
    high = glm::clamp(high, -1.0F, 1.0F);
    range.cover.first = mesh_.faces.size();
    for (const glm::vec2 at : {low, {high.x, low.y}, high, low, high, {low.x, high.y}}) {
      v.x = {at, 0};
      mesh_.faces.push_back(v);
    }
    range.cover.count = 6;
    mesh_.fills.push_back(range);
  }

  // ---- lines and points

  void add_line(const DrawLine& l) {
    if (l.points.empty()) return;
    // The halo goes first and slightly behind its line.
    const double nudge = l.nudge + lift(l.layer, 0.5 * l.width + l.halo_width);
    if (l.halo.a > 0 && l.halo_width > 0) {
      add_polyline(l, l.halo, l.width + 2 * l.halo_width, kNeverDashed, nudge - kHaloNudge);
    }
    add_polyline(l, l.colour, l.width, l.dash, nudge);
  }

  /// Returns the number of nudge steps that bring the full width of a line in front of the face that it
  /// follows, if the face is seen at 45 degrees or more; a dot is as thick as it is wide. `half_width` is in
  /// pixels of the final image. Opaque lines are not moved: of two, the wider one must not hide the later
  /// one.
  double lift(Layer layer, double half_width) const {
    return layer == Layer::opaque ? 0 : half_width * scale_ / p_.height() / kNudge;
  }

  void add_polyline(const DrawLine& l, Rgba colour, double width, double dash, double nudge) {
    LineVertex v;
    v.colour = to_bytes(colour);
    v.half_width = to_float(0.5 * width * scale_);
    v.dash = to_float(dash > 0 ? dash * scale_ : dash);
    double before = 0;
    const std::size_t n = l.points.size(), segments = l.closed && n > 2 ? n : std::max<std::size_t>(n - 1, 1);
    for (std::size_t i = 0; i < segments; ++i) {
      // Dashes continue around corners.
      v.dash_start = to_float(before);
      before += add_segment(l.points[i], l.points[n == 1 ? 0 : (i + 1) % n], v, nudge);
    }
  }

  void add_point(const DrawPoint& d) {
    LineVertex v;
    const double nudge = d.nudge + lift(d.layer, d.radius + d.halo_width);
    if (d.halo.a > 0 && d.halo_width > 0) {
      v.colour = to_bytes(d.halo);
      v.half_width = to_float((d.radius + d.halo_width) * scale_);
      add_segment(d.x, d.x, v, nudge - kHaloNudge);
    }
    v.colour = to_bytes(d.colour);
    v.half_width = to_float(d.radius * scale_);
    add_segment(d.x, d.x, v, nudge);
  }

  /// Returns the segment's length on the screen.
  double add_segment(const Vector3d& from, const Vector3d& to, LineVertex v, double nudge) {
    Vector3d a = p_.to_eye(from), b = p_.to_eye(to);
    // Clip the segment to the guard region.
    for (int plane = 0; plane < kPlanes; ++plane) {
      const double da = inside(a, plane), db = inside(b, plane);
      if (da < 0 && db < 0) return 0;
      if (da < 0) a += (b - a) * (da / (da - db));
      if (db < 0) b += (a - b) * (db / (db - da));
    }
    // A rectangle around the segment, with a margin for round ends and a soft border.
    const Vector3d sa = snapped_screen(a), sb = snapped_screen(b);
    const Vector2d d = (sb - sa).head<2>();
    const double length = d.norm();
    const Vector2d u = length > 0 ? Vector2d(d / length) : Vector2d::UnitX();
    const Vector2d side(-u.y(), u.x());
    const double reach = v.half_width + kRim;
    v.length = to_float(length);
    std::array<LineVertex, 4> corner;
    for (int i = 0; i < 4; ++i) {
      const double along = i == 1 || i == 2 ? length + reach : -reach, across = i < 2 ? -reach : reach;
      const Vector2d at = sa.head<2>() + along * u + across * side;
      v.at = to_float(Vector2d(along, across));
      // Beyond the ends the depth stays constant: a round end must not sink into the face it ends on.
      v.x = device({at.x(), at.y(), along < 0 ? sa.z() : sb.z()}, nudge);
      corner[i] = v;
    }
    mesh_.lines.insert(mesh_.lines.end(), {corner[0], corner[1], corner[2], corner[0], corner[2], corner[3]});
    return length;
  }

  const DrawList& list_;
  const Projection& p_;
  double scale_;
  FaceLooks looks_;
  ScreenMesh mesh_;
  std::vector<FaceVertex> corners_;
};

}  // namespace

ScreenMesh make_screen_mesh(const DrawList& list, const Projection& projection, double scale,
                            const Lighting& lighting, bool even_edges) {
  return ScreenMeshBuilder(list, projection, scale, lighting, even_edges).build();
}

}  // namespace lrb::render
