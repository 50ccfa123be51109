#include "render/paint_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <vector>

#include <lrbscope/error.hpp>
namespace lrb::render {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Style of hidden lines and points on top in Rasterizer::draw() (rasterize.cpp): share of the width; length
/// of dashes in half widths; radius of rings to their centre line, and their width, as shares of the radius.
constexpr double kGhostWidth = 0.6, kGhostDash = 5, kRingRadius = 0.8, kRingWidth = 0.4;
/// Visible or hidden runs shorter than this many pixels of the depth image are merged with their neighbours.
constexpr double kMinRun = 1.5;

struct Less {
  bool operator()(const Vector3d& a, const Vector3d& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }
};

/// Joins segments, in any order and direction, whose ends coincide exactly.
std::vector<std::vector<Vector3d>> loops(const std::vector<std::array<Vector3d, 2>>& segments) {
  // Both ends of each segment, by their exact coordinates.
  std::multimap<Vector3d, std::size_t, Less> at;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    at.emplace(segments[i][0], i);
    at.emplace(segments[i][1], i);
  }
  std::vector<bool> used(segments.size(), false);
  std::vector<std::vector<Vector3d>> out;
  for (std::size_t start = 0; start < segments.size(); ++start) {
    if (used[start]) continue;
    std::vector<Vector3d> loop{segments[start][0]};
    // Follow unused segments from end to end until the loop closes or no segment is left.
    for (std::size_t i = start; i < segments.size();) {
      used[i] = true;
      const Vector3d end = segments[i][0] == loop.back() ? segments[i][1] : segments[i][0];
      if (end == loop.front()) break;
      loop.push_back(end);
      i = segments.size();
      const auto [first, last] = at.equal_range(end);
      for (auto it = first; it != last; ++it) {
        if (!used[it->second]) i = it->second;
      }
    }
    out.push_back(std::move(loop));
  }
  return out;
}

/// Shared by painting a flat list and painting over a picture.
class ListPainter {
 public:
  ListPainter(Canvas& canvas, const Projection& projection, const Vector2d& origin)
      : canvas_(canvas), projection_(projection), origin_(origin) {}

  Vector2d place(const Vector3d& x) const {
    const auto at = projection_.to_pixel(x);
    if (!at) throw InputError("cannot draw a scene as lines if it extends behind the camera");
    return origin_ + *at;
  }

  Canvas::Loop places(const std::vector<Vector3d>& points) const {
    Canvas::Loop out;
    out.reserve(points.size());
    for (const Vector3d& x : points) out.push_back(place(x));
    return out;
  }

  void fill(const DrawFill& f) {
    std::vector<Canvas::Loop> all;
    for (const auto& loop : loops(f.segments)) all.push_back(places(loop));
    canvas_.fill(all, f.colour);
  }

  void line(const DrawLine& l) {
    if (l.points.empty()) return;
    const Canvas::Loop points = places(l.points);
    if (l.halo.a > 0 && l.halo_width > 0)
      canvas_.stroke(points, l.closed, {l.halo, l.width + 2.0F * l.halo_width, 0});
    canvas_.stroke(points, l.closed, {l.colour, l.width, l.dash});
  }

  void point(const DrawPoint& p) {
    const auto at = projection_.to_pixel(p.x);
    if (!at) return;
    if (p.halo.a > 0 && p.halo_width > 0) canvas_.disc(origin_ + *at, p.radius + p.halo_width, p.halo);
    canvas_.disc(origin_ + *at, p.radius, p.colour);
  }

  void label(const DrawLabel& l) {
    const auto at = projection_.to_pixel(l.x);
    if (!at) return;
    canvas_.text(
        {origin_ + *at + Vector2d(l.dx, l.dy), l.text, l.height, false, l.colour, Align::centre, l.halo});
  }

 private:
  Canvas& canvas_;
  const Projection& projection_;
  Vector2d origin_;
};

/// A part of a line that is entirely visible or entirely hidden.
struct Run {
  bool seen = true;
  Canvas::Loop points;
};

double length_of(const Run& run) {
  double sum = 0;
  for (std::size_t i = 1; i < run.points.size(); ++i) sum += (run.points[i] - run.points[i - 1]).norm();
  return sum;
}

/// Finds the parts of lines and points on top that faces hide.
class HiddenLines {
 public:
  HiddenLines(const Projection& projection, const DepthImage& depths)
      : projection_(projection), depths_(depths), unit_(projection.width() / depths.width) {}

  /// Returns the runs of a line, in order, in pixels of the projection.
  std::vector<Run> runs(const DrawLine& l) const {
    // A line is tested as if it were moved towards the viewer by half its width: lines along faces are
    // visible.
    const double heights = l.nudge * kNudge + (0.5 * l.width + l.halo_width) / projection_.height();
    std::vector<Run> out;
    const std::size_t n = l.points.size(), segments = l.closed && n > 2 ? n : n - 1;
    for (std::size_t i = 0; i < segments; ++i) add_segment(l.points[i], l.points[(i + 1) % n], heights, out);
    return joined(std::move(out));
  }

  bool seen(const DrawPoint& p) const {
    // Behind the eye there is no depth to compare with.
    const Vector3d eye = projection_.to_eye(p.x);
    if (!in_front(eye)) return true;
    return seen(projection_.to_screen(eye),
                p.nudge * kNudge + (p.radius + p.halo_width) / projection_.height());
  }

 private:
  bool in_front(const Vector3d& eye) const {
    return projection_.orthographic() || eye.z() >= projection_.near_depth();
  }

  bool seen(const Vector3d& screen, double heights) const {
    // Nearest pixel of the depth image; nothing is hidden outside it.
    const int x = static_cast<int>(std::floor(screen.x() / unit_));
    const int y = static_cast<int>(std::floor((projection_.height() - screen.y()) / unit_));
    if (x < 0 || y < 0 || x >= depths_.width || y >= depths_.height) return true;
    return projection_.nearer(screen.z(), heights) <= depths_.at(x, y);
  }

  /// Adds a segment, which stays straight on the screen, split where its visibility changes.
  void add_segment(const Vector3d& from, const Vector3d& to, double heights, std::vector<Run>& out) const {
    const Vector3d a = projection_.to_eye(from), b = projection_.to_eye(to);
    if (!in_front(a) || !in_front(b)) return;
    const Vector3d p = projection_.to_screen(a), q = projection_.to_screen(b);
    const auto place = [&](double t) {
      const Vector3d at = p + t * (q - p);
      return Vector2d(at.x(), projection_.height() - at.y());
    };
    // Two samples for each pixel of the depth image. Straight lines stay straight, so the parameter is
    // linear.
    const int steps = 1 + static_cast<int>(2 * (q - p).head<2>().norm() / unit_);
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) / steps;
      const bool now = seen(p + t * (q - p), heights);
      // The visibility changes: end the run halfway between the samples, and start the next one there.
      if (out.empty() || out.back().seen != now) {
        const Vector2d cut = place(i == 0 ? 0 : static_cast<double>(i) / steps);
        if (!out.empty() && i > 0) out.back().points.push_back(cut);
        out.push_back({now, {cut}});
      }
    }
    out.back().points.push_back(place(1));
  }

  /// Merges runs that are too short with their neighbours.
  std::vector<Run> joined(std::vector<Run> runs) const {
    std::vector<Run> out;
    // Runs below the resolution of the depth image are noise, as at the silhouette of a face.
    for (Run& run : runs) {
      if (runs.size() > 1 && length_of(run) < kMinRun * unit_ && !out.empty()) run.seen = out.back().seen;
      if (!out.empty() && out.back().seen == run.seen) {
        out.back().points.insert(out.back().points.end(), run.points.begin(), run.points.end());
      } else {
        out.push_back(std::move(run));
      }
    }
    return out;
  }

  const Projection& projection_;
  const DepthImage& depths_;
  double unit_;  ///< pixels of the projection per pixel of the depth image
};

/// Paints a hidden or visible run of a line, in the corresponding width and dashes.
void paint_run(Canvas& canvas, const DrawLine& l, const Run& run, bool closed) {
  const double share = run.seen ? 1 : kGhostWidth;
  const double dash = run.seen || l.dash > 0 ? l.dash : kGhostDash * 0.5 * l.width;
  if (l.halo.a > 0 && l.halo_width > 0)
    canvas.stroke(run.points, closed, {l.halo, share * (l.width + 2.0F * l.halo_width), 0});
  canvas.stroke(run.points, closed, {l.colour, share * l.width, dash});
}

void paint_ring(Canvas& canvas, const Vector2d& at, const DrawPoint& p) {
  constexpr int kCorners = 32;
  Canvas::Loop ring;
  // A hidden point is a ring: a polygon indistinguishable from a circle at this size.
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    ring.push_back(at + kRingRadius * p.radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  canvas.stroke(ring, true, {p.colour, kRingWidth * p.radius, 0});
}

}  // namespace

void paint_flat(Canvas& canvas, const DrawList& list, const Projection& projection, const Vector2d& origin) {
  if (!list.triangles.empty()) throw InputError("cannot draw a scene with depth as a flat scene");
  ListPainter painter(canvas, projection, origin);
  // Without depth, the order of painting is the order of the layers.
  for (const DrawFill& f : list.fills) painter.fill(f);
  for (int layer = 0; layer < kLayers; ++layer) {
    for (const DrawLine& l : list.lines)
      if (l.layer == static_cast<Layer>(layer)) painter.line(l);
    for (const DrawPoint& p : list.points)
      if (p.layer == static_cast<Layer>(layer)) painter.point(p);
  }
  for (const DrawLabel& l : list.labels) painter.label(l);
}

DrawList under_lines(DrawList list) {
  std::erase_if(list.lines, [](const DrawLine& l) { return l.layer == Layer::on_top; });
  std::erase_if(list.points, [](const DrawPoint& p) { return p.layer == Layer::on_top; });
  list.labels.clear();
  return list;
}

void paint_visible_lines(Canvas& canvas, const DrawList& list, const Projection& projection,
                         const DepthImage& depths, const Vector2d& origin) {
  const HiddenLines hidden(projection, depths);
  ListPainter painter(canvas, projection, origin);
  for (const Layer layer : {Layer::opaque, Layer::translucent}) {
    for (const DrawLine& l : list.lines) {
      if (l.layer != layer || l.points.size() < 2) continue;
      std::vector<Run> runs = hidden.runs(l);
      for (Run& run : runs) {
        if (!run.seen) continue;
        for (Vector2d& x : run.points) x += origin;
        paint_run(canvas, l, run, l.closed && runs.size() == 1);
      }
    }
    for (const DrawPoint& p : list.points)
      if (p.layer == layer && hidden.seen(p)) painter.point(p);
  }
}

void paint_over(Canvas& canvas, const DrawList& list, const Projection& projection, const DepthImage& depths,
                const Vector2d& origin) {
  const HiddenLines hidden(projection, depths);
  for (const bool seen : {false, true}) {  // visible parts go over hidden ones
    for (const DrawLine& l : list.lines) {
      if (l.layer != Layer::on_top || l.points.size() < 2) continue;
      std::vector<Run> runs = hidden.runs(l);
      for (Run& run : runs) {
        if (run.seen != seen) continue;
        for (Vector2d& x : run.points) x += origin;
        paint_run(canvas, l, run, l.closed && runs.size() == 1);
      }
    }
  }
  ListPainter painter(canvas, projection, origin);
  // Points cover lines, and labels cover both.
  for (const DrawPoint& p : list.points) {
    if (p.layer != Layer::on_top) continue;
    if (hidden.seen(p)) {
      painter.point(p);
    } else if (const auto at = projection.to_pixel(p.x)) {
      paint_ring(canvas, origin + *at, p);
    }
  }
  for (const DrawLabel& l : list.labels) painter.label(l);
}

}  // namespace lrb::render
