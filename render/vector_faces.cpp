#include "render/vector_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <lrbscope/core/polygon.hpp>

namespace lrb::render {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Overlaps narrower than this many pixels of the projection (points of a figure) are invisible.
constexpr double kNarrow = 0.004;
/// Faces closer to each other than this in depth, of a range of 2, are in the same plane there.
constexpr double kSameDepth = 1e-9;
/// Opaque faces are painted this many pixels larger on each side, so that the paper does not show between
/// neighbours in programs that smooth the border of each.
constexpr double kSpread = 0.12;
/// Mean number of faces in a cell of the search grid.
constexpr double kPerCell = 2;

/// Returns twice the signed area of a polygon.
double twice_area(const std::vector<Vector2d>& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector2d &a = x[i], &b = x[(i + 1) % x.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// Returns true if a polygon is too narrow to be visible: its mean width is its area over half its perimeter.
bool is_narrow(const std::vector<Vector2d>& x) {
  if (x.size() < 3) return true;
  double around = 0;
  for (std::size_t i = 0; i < x.size(); ++i) around += (x[(i + 1) % x.size()] - x[i]).norm();
  return !(std::abs(twice_area(x)) > kNarrow * around);
}

/// Keeps the part of a convex polygon with value(x) >= 0. `edges` belongs to the corners; the new edge along
/// the cut gets -1.
template <class Value>
void clip(std::vector<Vector2d>& corners, std::vector<std::int8_t>& edges, const Value& value) {
  std::vector<Vector2d> x;
  std::vector<std::int8_t> e;
  clip_polygon(corners, value, [&](const Vector2d& corner, std::size_t i, bool, bool along_cut) {
    x.push_back(corner);
    e.push_back(along_cut ? std::int8_t{-1} : edges[i]);
  });
  corners = std::move(x);
  edges = std::move(e);
}

/// Returns the intersection of two convex polygons of positive area.
std::vector<Vector2d> intersection(const std::vector<Vector2d>& p, const std::vector<Vector2d>& q) {
  std::vector<Vector2d> out = p;
  std::vector<std::int8_t> edges(p.size(), 0);
  for (std::size_t i = 0; i < q.size() && out.size() >= 3; ++i) {
    const Vector2d a = q[i], along = q[(i + 1) % q.size()] - a;
    clip(out, edges,
         [&](const Vector2d& x) { return along.x() * (x.y() - a.y()) - along.y() * (x.x() - a.x()); });
    edges.resize(out.size());
  }
  return out;
}

/// Returns a triangle on the screen, with positive area; nullopt if it is seen edge-on.
std::optional<ScreenFace> on_screen(const DrawList& list, const Projection& projection, std::uint32_t index) {
  const DrawTriangle& t = list.triangles[index];
  std::array<Vector3d, 3> at;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d s = projection.to_screen(projection.to_eye(t.x[i]));
    at[i] = {s.x(), projection.height() - s.y(), projection.nearer(s.z(), t.nudge * kNudge)};
  }
  const Vector3d normal = (at[1] - at[0]).cross(at[2] - at[0]);
  if (!(std::abs(normal.z()) > 0)) return std::nullopt;
  ScreenFace out;
  out.triangle = index;
  // Depth is linear on the screen: z = z0 - (nx (x - x0) + ny (y - y0)) / nz.
  out.depth = {-normal.x() / normal.z(), -normal.y() / normal.z(), normal.dot(at[0]) / normal.z()};
  out.corners = {at[0].head<2>(), at[1].head<2>(), at[2].head<2>()};
  out.edges = {0, 1, 2};
  if (normal.z() < 0) {
    std::reverse(out.corners.begin(), out.corners.end());
    out.edges = {1, 0, 2};
  }
  return out;
}

AlignedBox2d box_of(const ScreenFace& f) {
  AlignedBox2d box;
  for (const Vector2d& x : f.corners) box.extend(x);
  return box;
}

/// Returns true if a face is in front of the nearest opaque face somewhere.
bool is_visible(const ScreenFace& f, const DepthImage& depths, double unit) {
  const AlignedBox2d box = box_of(f);
  const auto first = [&](double x) { return std::max(0, static_cast<int>(std::floor(x / unit - 0.5))); };
  const int x1 = std::min(depths.width - 1, static_cast<int>(std::ceil(box.max().x() / unit))),
            y1 = std::min(depths.height - 1, static_cast<int>(std::ceil(box.max().y() / unit)));
  // The rasterizer rounds corners to a fraction of a pixel, which changes depths by less than this.
  const double slack = 0.02 * unit * (std::abs(f.depth.x()) + std::abs(f.depth.y())) + 1e-6;
  constexpr double kBeside = 50;  // slack for a point that is not the centre of its pixel: a whole pixel
  bool covers = false;
  for (int y = first(box.min().y()); y <= y1; ++y)
    for (int x = first(box.min().x()); x <= x1; ++x) {
      const Vector2d at((x + 0.5) * unit, (y + 0.5) * unit);
      bool inside = true;
      for (std::size_t i = 0; inside && i < 3; ++i) {
        const Vector2d a = f.corners[i], along = f.corners[(i + 1) % 3] - a;
        inside = along.x() * (at.y() - a.y()) - along.y() * (at.x() - a.x()) >= 0;
      }
      if (!inside) continue;
      covers = true;
      if (f.depth_at(at) - slack <= depths.at(x, y)) return true;
    }
  if (covers) return false;
  // Too small or thin for the pixels: visible if one beside its corners or midpoints of edges is not nearer.
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector2d a = f.corners[i / 2],
                   at = i % 2 == 0 ? a : Vector2d(0.5 * (a + f.corners[(i / 2 + 1) % 3]));
    const int x = static_cast<int>(std::floor(at.x() / unit)),
              y = static_cast<int>(std::floor(at.y() / unit));
    if (x < 0 || y < 0 || x >= depths.width || y >= depths.height) continue;
    if (f.depth_at(at) - kBeside * slack <= depths.at(x, y)) return true;
  }
  return false;
}

/// Sorts faces for painting.
class PaintSorter {
 public:
  PaintSorter(const DrawList& list, const FaceLooks& looks, std::vector<ScreenFace> faces)
      : list_(list), looks_(looks), todo_(std::move(faces)) {
    AlignedBox2d all;
    for (const ScreenFace& f : todo_) all.extend(box_of(f));
    if (todo_.empty()) return;
    origin_ = all.min();
    const double cells = std::max(1.0, std::sqrt(static_cast<double>(todo_.size()) / kPerCell));
    cell_ = std::max(all.sizes().maxCoeff() / cells, 1e-9);
  }

  /// Returns nullopt if the faces have too many parts, or overlap too often.
  std::optional<std::vector<ScreenFace>> sorted() {
    const std::size_t most = kFewParts + kMaxParts * todo_.size();
    // Step 1: faces that intersect no other one. In order from the last, so that the list's order is kept.
    std::reverse(todo_.begin(), todo_.end());
    while (!todo_.empty()) {
      if (faces_.size() + todo_.size() > most || tests_ > kMaxTests) return std::nullopt;
      ScreenFace face = std::move(todo_.back());
      todo_.pop_back();
      insert(std::move(face));
    }
    // Step 2: which faces must be painted before which.
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (tests_ > kMaxTests) return std::nullopt;
      if (!faces_[i].done) order(i, [i](std::size_t j) { return j > i; });
    }
    // Step 3: the order.
    std::vector<ScreenFace> out;
    for (std::size_t i = 0; i < faces_.size(); ++i) set_ready(i);
    for (;;) {
      if (tests_ > kMaxTests) return std::nullopt;
      const std::optional<std::size_t> next = next_ready();
      if (!next && !break_cycle(faces_.size() < most)) break;
      if (!next) continue;
      faces_[*next].done = true;
      for (const std::size_t after : faces_[*next].after) release(after);
      out.push_back(std::move(faces_[*next].face));
    }
    return out;
  }

 private:
  using Colour = std::array<std::uint8_t, 5>;  ///< layer and colour as drawn
  struct Item {
    ScreenFace face;
    AlignedBox2d box;
    Colour colour{};
    std::vector<std::size_t> after, before;  ///< faces to be painted after and before it
    std::size_t waits = 0;                   ///< number of faces in `before` that are not done
    bool done = false;                       ///< painted, or replaced by its parts
    std::size_t visit = 0;                   ///< number of the last search that found it
  };
  enum class Relation : std::uint8_t { none, p_first, q_first, crossing };

  bool opaque(const ScreenFace& f) const { return list_.triangles[f.triangle].layer == Layer::opaque; }

  /// Returns the order of two faces in the area where both are visible.
  Relation relation(const ScreenFace& p, const ScreenFace& q) {
    ++tests_;
    const std::vector<Vector2d> common = intersection(p.corners, q.corners);
    if (is_narrow(common)) return Relation::none;
    double low = 0, high = 0;  // of the distance of p behind q
    for (const Vector2d& x : common) {
      const double d = p.depth_at(x) - q.depth_at(x);
      low = std::min(low, d), high = std::max(high, d);
    }
    if (low < -kSameDepth && high > kSameDepth && crosses_visibly(p, q, common)) return Relation::crossing;
    if (std::max(-low, high) <= kSameDepth) return Relation::none;
    return high > -low ? Relation::p_first : Relation::q_first;
  }

  /// Returns true if both parts of the common area are wide enough to be visible.
  static bool crosses_visibly(const ScreenFace& p, const ScreenFace& q, const std::vector<Vector2d>& common) {
    for (const double sign : {1.0, -1.0}) {
      std::vector<Vector2d> part = common;
      std::vector<std::int8_t> edges(part.size(), 0);
      clip(part, edges, [&](const Vector2d& x) { return sign * (p.depth_at(x) - q.depth_at(x)); });
      if (is_narrow(part)) return false;
    }
    return true;
  }

  // ---- search grid

  template <class Visit>
  void for_cells(const ScreenFace& f, const Visit& visit) const {
    const AlignedBox2d box = box_of(f);
    const Eigen::Vector2i low = ((box.min() - origin_) / cell_).array().floor().cast<int>(),
                          high = ((box.max() - origin_) / cell_).array().floor().cast<int>();
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) visit(std::pair(x, y));
  }

  /// Returns the faces in the cells of a face, ascending.
  std::vector<std::size_t> near(const ScreenFace& f) {
    std::vector<std::size_t> out;
    const AlignedBox2d box = box_of(f);
    ++visits_;
    for_cells(f, [&](const std::pair<int, int>& cell) {
      const auto found = grid_.find(cell);
      if (found == grid_.end()) return;
      std::erase_if(found->second, [&](std::size_t i) { return faces_[i].done; });
      for (const std::size_t i : found->second) {
        if (faces_[i].visit == visits_) continue;
        faces_[i].visit = visits_;
        if (box.intersects(faces_[i].box)) out.push_back(i);
      }
    });
    std::sort(out.begin(), out.end());
    return out;
  }

  std::size_t add(ScreenFace face) {
    for_cells(face, [&](const std::pair<int, int>& cell) { grid_[cell].push_back(faces_.size()); });
    faces_.emplace_back();
    const DrawTriangle& t = list_.triangles[face.triangle];
    const Rgba c = looks_.of(t).colour;
    faces_.back().colour = {static_cast<std::uint8_t>(t.layer), c.r, c.g, c.b, c.a};
    faces_.back().box = box_of(face);
    faces_.back().face = std::move(face);
    return faces_.size() - 1;
  }

  // ---- splitting

  /// Returns the parts of a face behind and in front of another one's plane.
  static std::vector<ScreenFace> split(const ScreenFace& p, const ScreenFace& by) {
    std::vector<ScreenFace> out;
    for (const double sign : {1.0, -1.0}) {
      ScreenFace part = p;
      clip(part.corners, part.edges,
           [&](const Vector2d& x) { return sign * (p.depth_at(x) - by.depth_at(x)); });
      if (!is_narrow(part.corners)) out.push_back(std::move(part));
    }
    return out;
  }

  /// Adds a face, or makes parts of it or of a face that it intersects: rather of an opaque one, because
  /// parts of translucent ones are visible where they meet.
  void insert(ScreenFace face) {
    for (const std::size_t i : near(face)) {
      if (relation(face, faces_[i].face) != Relation::crossing) continue;
      if (opaque(face) || !opaque(faces_[i].face)) {
        std::vector<ScreenFace> parts = split(face, faces_[i].face);
        if (parts.size() < 2) continue;
        todo_.insert(todo_.end(), parts.begin(), parts.end());
        return;
      }
      std::vector<ScreenFace> parts = split(faces_[i].face, face);
      if (parts.size() < 2) continue;
      faces_[i].done = true;
      todo_.insert(todo_.end(), parts.begin(), parts.end());
    }
    add(std::move(face));
  }

  // ---- order

  /// Finds the order of a face and of those others that `wanted` holds for.
  template <class Wanted>
  void order(std::size_t i, const Wanted& wanted) {
    for (const std::size_t j : near(faces_[i].face)) {
      if (!wanted(j)) continue;
      const Relation r = relation(faces_[i].face, faces_[j].face);
      if (r == Relation::p_first) put_before(i, j);
      if (r == Relation::q_first || r == Relation::crossing) put_before(j, i);
    }
  }

  void put_before(std::size_t i, std::size_t j) {
    faces_[i].after.push_back(j);
    faces_[j].before.push_back(i);
    if (++faces_[j].waits == 1) unready(j);
  }

  void set_ready(std::size_t i) {
    if (faces_[i].waits == 0 && !faces_[i].done) ready_[faces_[i].colour].insert(i);
  }

  void unready(std::size_t i) {
    const auto found = ready_.find(faces_[i].colour);
    if (found == ready_.end()) return;
    found->second.erase(i);
    if (found->second.empty()) ready_.erase(found);
  }

  void release(std::size_t i) {
    if (faces_[i].done || faces_[i].waits == 0) return;  // a face released from a cycle
    --faces_[i].waits;
    set_ready(i);
  }

  /// Removes and returns a face that waits for no other one: of the same colour as the last, if possible, so
  /// that few runs of faces with equal colour result.
  std::optional<std::size_t> next_ready() {
    auto same = ready_.find(last_);
    if (same == ready_.end()) same = ready_.begin();
    if (same == ready_.end()) return std::nullopt;
    const std::size_t out = *same->second.begin();
    last_ = same->first;
    same->second.erase(same->second.begin());
    if (same->second.empty()) ready_.erase(same);
    return out;
  }

  /// Splits a face of a cycle, or releases one if none can be split. Returns false if all faces are done.
  bool break_cycle(bool may_split) {
    const auto waiting = std::find_if(faces_.begin(), faces_.end(), [](const Item& f) { return !f.done; });
    if (waiting == faces_.end()) return false;
    // Go from face to face that must come before, until one is met again.
    std::vector<std::size_t> path = {static_cast<std::size_t>(waiting - faces_.begin())};
    std::set<std::size_t> seen = {path[0]};
    for (;;) {
      const std::vector<std::size_t>& before = faces_[path.back()].before;
      const auto next =
          std::find_if(before.begin(), before.end(), [&](std::size_t i) { return !faces_[i].done; });
      path.push_back(*next);
      if (!seen.insert(*next).second) break;
    }
    path.erase(path.begin(), std::find(path.begin(), path.end(), path.back()));
    // One of the faces crosses the plane of another one, or they would not overlap cyclically.
    for (std::size_t k = 0; may_split && k + 1 < path.size(); ++k)
      for (std::size_t l = 0; l + 1 < path.size(); ++l) {
        if (l == k) continue;
        std::vector<ScreenFace> parts = split(faces_[path[k]].face, faces_[path[l]].face);
        if (parts.size() < 2) continue;
        replace(path[k], std::move(parts));
        return true;
      }
    faces_[path[0]].waits = 0;
    set_ready(path[0]);
    return true;
  }

  void replace(std::size_t i, std::vector<ScreenFace> parts) {
    faces_[i].done = true;
    const std::vector<std::size_t> after = faces_[i].after;
    for (const std::size_t j : after)
      if (!faces_[j].done && faces_[j].waits > 0) --faces_[j].waits;
    const std::size_t first = faces_.size();
    for (ScreenFace& part : parts) add(std::move(part));
    for (std::size_t k = first; k < faces_.size(); ++k) order(k, [k](std::size_t j) { return j < k; });
    for (const std::size_t j : after) set_ready(j);
    for (std::size_t k = first; k < faces_.size(); ++k) set_ready(k);
  }

  static constexpr std::size_t kFewParts = 10000, kMaxParts = 8;  ///< allowed in any case; per face
  static constexpr std::size_t kMaxTests = 4'000'000;             ///< of pairs: about ten seconds

  const DrawList& list_;
  const FaceLooks& looks_;
  std::vector<ScreenFace> todo_;
  std::vector<Item> faces_;
  Vector2d origin_{0, 0};
  double cell_ = 1;
  std::map<std::pair<int, int>, std::vector<std::size_t>> grid_;
  std::map<Colour, std::set<std::size_t>> ready_;  ///< faces that wait for no other one, by colour
  Colour last_{};                                  ///< of the last face
  std::size_t visits_ = 0;                         ///< number of searches
  std::size_t tests_ = 0;                          ///< number of pairs whose relation was computed
};

/// Paints faces in runs of one colour that do not overlap, each as one path, and then their edges.
class FacePainter {
 public:
  FacePainter(Canvas& canvas, const DrawList& list, const FaceLooks& looks, const Vector2d& origin)
      : canvas_(canvas), list_(list), looks_(looks), origin_(origin) {}

  void paint(const std::vector<ScreenFace>& faces) {
    // An edge of several faces is painted once, with the last of them: the others would cover it again.
    std::map<Segment, std::size_t> last;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const FaceLook look = look_of(faces[i]);
      for (std::size_t k = 0; k < faces[i].corners.size(); ++k)
        if (is_drawn(faces[i], look, k)) last[segment(faces[i], k)] = i;
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const ScreenFace& f = faces[i];
      const FaceLook look = look_of(f);
      const bool opaque = list_.triangles[f.triangle].layer == Layer::opaque;
      if (!run_.empty() && (look.colour != colour_ || opaque != opaque_ || overlaps_run(f))) paint_run();
      colour_ = look.colour, opaque_ = opaque;
      run_.push_back(&f);
      for (std::size_t k = 0; k < f.corners.size(); ++k)
        if (is_drawn(f, look, k) && last.at(segment(f, k)) == i)
          edges_[{pack(look.edge_colour), look.edge_width}].push_back(
              {origin_ + f.corners[k], origin_ + f.corners[(k + 1) % f.corners.size()]});
    }
    paint_run();
  }

 private:
  using Segment = std::array<double, 4>;

  FaceLook look_of(const ScreenFace& f) const { return looks_.of(list_.triangles[f.triangle]); }

  static bool is_drawn(const ScreenFace& f, const FaceLook& look, std::size_t k) {
    return f.edges[k] >= 0 && (look.edges >> f.edges[k] & 1) != 0 && look.edge_colour.a > 0;
  }

  /// Returns the ends of an edge, the smaller one first.
  static Segment segment(const ScreenFace& f, std::size_t k) {
    const Vector2d &a = f.corners[k], &b = f.corners[(k + 1) % f.corners.size()];
    const bool swapped = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
    return swapped ? Segment{b.x(), b.y(), a.x(), a.y()} : Segment{a.x(), a.y(), b.x(), b.y()};
  }

  static std::uint32_t pack(Rgba c) {
    return static_cast<std::uint32_t>(c.r) << 24 | c.g << 16 | c.b << 8 | c.a;
  }
  static Rgba unpack(std::uint32_t c) {
    const auto byte = [c](int shift) { return static_cast<std::uint8_t>(c >> shift & 255); };
    return {byte(24), byte(16), byte(8), byte(0)};
  }

  bool overlaps_run(const ScreenFace& f) const {
    constexpr std::size_t kLongest = 4096;  // bounds the time of this test
    if (run_.size() >= kLongest) return true;
    const AlignedBox2d box = box_of(f);
    return std::any_of(run_.begin(), run_.end(), [&](const ScreenFace* g) {
      return box.intersects(box_of(*g)) && !is_narrow(intersection(f.corners, g->corners));
    });
  }

  void paint_run() {
    std::vector<Canvas::Loop> loops;
    for (const ScreenFace* f : run_) {
      Canvas::Loop loop;
      for (const Vector2d& x : f->corners) loop.push_back(origin_ + x);
      loops.push_back(std::move(loop));
    }
    if (colour_.a > 0 && !loops.empty()) canvas_.fill(loops, colour_, opaque_ ? kSpread : 0);
    for (const auto& [pen, lines] : edges_) canvas_.strokes(lines, {unpack(pen.first), pen.second, 0});
    run_.clear();
    edges_.clear();
  }

  Canvas& canvas_;
  const DrawList& list_;
  const FaceLooks& looks_;
  Vector2d origin_;
  // The run that is collected: its faces, their colour, and its edges by colour and width.
  std::vector<const ScreenFace*> run_;
  Rgba colour_;
  bool opaque_ = true;
  std::map<std::pair<std::uint32_t, double>, std::vector<Canvas::Loop>> edges_;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> visible_faces(const DrawList& list, const Projection& projection,
                                                        const DepthImage& depths) {
  const double unit = projection.width() / depths.width;
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < list.triangles.size(); ++i) {
    const DrawTriangle& t = list.triangles[i];
    if (t.layer == Layer::on_top) return std::nullopt;
    for (const Vector3d& x : t.x)
      if (!projection.to_pixel(x)) return std::nullopt;
    const std::optional<ScreenFace> face = on_screen(list, projection, i);
    if (face && is_visible(*face, depths, unit)) out.push_back(i);
  }
  return out;
}

std::optional<std::vector<ScreenFace>> painting_order(const DrawList& list, const Projection& projection,
                                                      const FaceLooks& looks,
                                                      const std::vector<std::uint32_t>& triangles) {
  std::vector<ScreenFace> faces;
  for (const std::uint32_t i : triangles) {
    std::optional<ScreenFace> face = on_screen(list, projection, i);
    if (face && !is_narrow(face->corners)) faces.push_back(std::move(*face));
  }
  return PaintSorter(list, looks, std::move(faces)).sorted();
}

void paint_faces(Canvas& canvas, const DrawList& list, const std::vector<ScreenFace>& faces,
                 const FaceLooks& looks, const Vector2d& origin) {
  FacePainter(canvas, list, looks, origin).paint(faces);
}

}  // namespace lrb::render
