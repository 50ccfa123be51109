// The cells into which cuts divide a face, with a sample point in each. Slab decomposition of an arrangement
// of segments (Dobkin and Lipton 1976), in rational coordinates.
// 1. Intersect the face with each other triangle, clip the result to the face, and project it: the cuts.
// 2. Sort the abscissas of all end points and crossings of cuts. Two successive ones bound a slab.
// 3. In a slab no cut ends or crosses another: the cuts that span it divide it into trapezoids (gaps).
// 4. Unite the gaps of adjacent slabs that open to each other: the cells.
// 5. Lift the centre of one gap of each cell back to the plane of the face.

#include <algorithm>
#include <utility>

#include "engine/exact/locate.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/exact/rational.hpp"

namespace lrb::exact {
/// A named namespace, because CutFace::Parts has members of these types.
namespace cutting {

/// Maximum number of gaps per requested cell. End points and crossings of cuts divide cells into gaps, and
/// the time grows with the number of gaps. Larger: faces with a hundred cuts are decided as well, in minutes
/// each.
constexpr std::size_t kGapsPerCell = 16;

/// A point in the triangle's projection.
struct Planar {
  Rational x, y;
  friend bool operator==(const Planar&, const Planar&) = default;
  friend bool operator<(const Planar& a, const Planar& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }
};

/// A cut, from its left (or lower) to its right (or upper) end.
struct Cut {
  Planar from, to;
  friend bool operator==(const Cut&, const Cut&) = default;
  bool is_vertical() const { return from.x == to.x; }
  Rational y_at(const Rational& x) const { return from.y + (to.y - from.y) * (x - from.x) / (to.x - from.x); }
};

Rational cross(const Planar& a, const Planar& b, const Planar& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The triangle, its projection, and the cuts through it.
class CutTriangle {
 public:
  CutTriangle(const double* const tri[3], const Axes& axes) : axes_(axes), plane_(tri[0], tri[1], tri[2]) {
    for (std::size_t i = 0; i < 3; ++i) {
      exact_[i] = to_rational(tri[i]);
      corner_[i] = project(exact_[i]);
    }
    // The edges are cuts as well: they bound the outermost gaps, so that no gap is outside the triangle.
    for (std::size_t i = 0; i < 3; ++i) add(corner_[i], corner_[(i + 1) % 3]);
  }

  void cut_by(const double* const other[3]) {
    const Sides sides = sides_of(plane_, other);
    // All corners are strictly on one side of the plane: no cut.
    if (sides.all_strictly_same()) return;
    std::vector<Planar> points;
    // Collect the points of the other triangle's boundary in this plane: corners on it, and crossings of its
    // edges.
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (sides.s[i] == 0) points.push_back(project(to_rational(other[i])));
      if (sides.s[i] * sides.s[j] < 0)
        points.push_back(where_edge_cuts(to_rational(other[i]), to_rational(other[j])));
    }
    // Two points give one cut. Three points belong to a coplanar triangle, and its edges are the cuts.
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = i + 1; j < points.size(); ++j) add_clipped(points[i], points[j]);
    }
  }

  /// The first three are the triangle's edges.
  const std::vector<Cut>& cuts() const { return cuts_; }

  Planar project(const RationalVec& p) const {
    return {p[static_cast<std::size_t>(axes_.x)], p[static_cast<std::size_t>(axes_.y)]};
  }

  /// Returns the point of the triangle's plane with this projection.
  RationalPoint lift(const Planar& p) const {
    // Barycentric coordinates are preserved, because the projection is affine and injective on the plane.
    const Rational area = cross(corner_[0], corner_[1], corner_[2]);
    const Rational u = cross(corner_[0], p, corner_[2]) / area, v = cross(corner_[0], corner_[1], p) / area;
    RationalVec r;
    for (std::size_t k = 0; k < 3; ++k) {
      r[k] = exact_[0][k] + u * (exact_[1][k] - exact_[0][k]) + v * (exact_[2][k] - exact_[0][k]);
    }
    return make_point(std::move(r));
  }

 private:
  Planar where_edge_cuts(const RationalVec& p, const RationalVec& q) const {
    // hp and hq are the heights of p and q over the plane. They have opposite signs, so hp - hq is not 0.
    const Rational hp = volume_determinant(exact_[0], exact_[1], exact_[2], p);
    const Rational hq = volume_determinant(exact_[0], exact_[1], exact_[2], q);
    return project(between(p, q, hp / (hp - hq)));
  }

  void add_clipped(const Planar& p, const Planar& q) {
    // Clip the segment by the three edge lines (Cyrus and Beck 1978). axes_.turn makes the inner side
    // positive.
    RationalInterval part;
    for (std::size_t i = 0; i < 3 && !part.empty; ++i) {
      const Planar &a = corner_[i], &b = corner_[(i + 1) % 3];
      part.keep_positive(axes_.turn * cross(a, b, p), axes_.turn * cross(a, b, q));
    }
    if (part.empty) return;
    const auto at = [&](const Rational& t) { return Planar{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)}; };
    add(at(part.low), at(part.high));
  }

  void add(const Planar& p, const Planar& q) {
    if (p == q) return;  // a point cuts nothing
    Cut cut = p < q ? Cut{p, q} : Cut{q, p};
    // Two faces that share an edge contribute the same cut twice. Removing duplicates is worthwhile, because
    // the time is cubic in the number of cuts.
    if (std::find(cuts_.begin(), cuts_.end(), cut) == cuts_.end()) cuts_.push_back(std::move(cut));
  }

  Axes axes_;
  PlaneSide plane_;
  std::array<RationalVec, 3> exact_;
  std::array<Planar, 3> corner_;
  std::vector<Cut> cuts_;
};

/// Adds the abscissa of the crossing of two cuts (ends of overlapping cuts are events anyway).
void add_crossing(const Cut& a, const Cut& b, std::vector<Rational>& events) {
  // No crossing if both ends of b are strictly on one side of a, or if the cuts are collinear.
  const Rational b_from = cross(a.from, a.to, b.from), b_to = cross(a.from, a.to, b.to);
  if (b_from * b_to > 0 || (b_from == 0 && b_to == 0)) return;
  // The same with a and b exchanged. The cuts are not parallel here, so a_from - a_to is not 0.
  const Rational a_from = cross(b.from, b.to, a.from), a_to = cross(b.from, b.to, a.to);
  if (a_from * a_to > 0) return;
  events.push_back(a.from.x + (a.to.x - a.from.x) * a_from / (a_from - a_to));
}

std::vector<Rational> events_of(const std::vector<Cut>& cuts) {
  std::vector<Rational> events;
  // Test all pairs of cuts: quadratic, small compared with sorting the cuts in each slab.
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    events.push_back(cuts[i].from.x);
    events.push_back(cuts[i].to.x);
    for (std::size_t j = 0; j < i; ++j) add_crossing(cuts[i], cuts[j], events);
  }
  std::sort(events.begin(), events.end());
  events.erase(std::unique(events.begin(), events.end()), events.end());
  return events;
}

/// A cut that spans a slab. The layers of a slab are in ascending order; coincident cuts are listed once, by
/// the first of them.
struct Layer {
  Rational y;  ///< at the centre of the slab
  std::size_t cut;
};

std::vector<Layer> layers_between(const std::vector<Cut>& cuts, const Rational& left, const Rational& right) {
  std::vector<Layer> layers;
  // No two cuts cross inside the slab, so their order at its centre is their order everywhere in it.
  const Rational midpoint = (left + right) / 2;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (!cuts[i].is_vertical() && cuts[i].from.x <= left && cuts[i].to.x >= right) {
      layers.push_back({cuts[i].y_at(midpoint), i});
    }
  }
  // Coincident cuts have the same ordinate, and the one of lowest index is kept.
  std::sort(layers.begin(), layers.end(),
            [](const Layer& a, const Layer& b) { return a.y != b.y ? a.y < b.y : a.cut < b.cut; });
  const auto same = [](const Layer& a, const Layer& b) { return a.y == b.y; };
  layers.erase(std::unique(layers.begin(), layers.end(), same), layers.end());
  return layers;
}

/// A trapezoid of a slab, between two cuts. The gaps of one cell are linked to the first of them.
struct Gap {
  std::size_t below, above;
  Planar midpoint;
  std::size_t link;
};

/// The slabs from left to right, with their gaps grouped into cells.
class Slabs {
 public:
  /// Divides the projection into slabs; stops at more than `limit` gaps.
  Slabs(const std::vector<Cut>& cuts, std::size_t limit) : cuts_(cuts) {
    events_ = events_of(cuts);
    std::size_t previous = 0;
    // Work from left to right. The gaps of the current slab are linked to those of the previous one only.
    for (std::size_t e = 0; e + 1 < events_.size() && gaps_.size() <= limit; ++e) {
      const std::size_t first = gaps_.size();
      first_gap_.push_back(first);
      add_gaps(events_[e], events_[e + 1]);
      join_neighbours(previous, first, events_[e]);
      previous = first;
    }
    first_gap_.push_back(gaps_.size());
    whole_ = gaps_.size() <= limit;
  }

  bool whole() const { return whole_; }

  /// Returns the first gap of the cell that borders on the cut `edge` (an edge of the triangle) at a point
  /// that is not on other cuts. Near such a point there is only one cell, and every slab that reaches the
  /// point has a gap of it along the edge; a vertical edge bounds the first slab or the last.
  std::size_t gap_beside(std::size_t edge, const Planar& p) const {
    const bool vertical = cuts_[edge].is_vertical();
    // Find a slab that contains p, then the gap of that slab that touches the edge at p.
    for (std::size_t e = 0; e + 1 < events_.size(); ++e) {
      if (p.x < events_[e] || p.x > events_[e + 1]) continue;
      for (std::size_t i = first_gap_[e]; i < first_gap_[e + 1]; ++i) {
        const Gap& gap = gaps_[i];
        if (vertical ? cuts_[gap.below].y_at(p.x) < p.y && p.y < cuts_[gap.above].y_at(p.x)
                     : gap.below == edge || gap.above == edge)
          return first_of(i);
      }
    }
    return gaps_.size();
  }

  /// Returns the first gap of each cell.
  std::vector<std::size_t> cells() const {
    std::vector<std::size_t> r;
    // A gap that links to itself is the first of its cell.
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
      if (gaps_[i].link == i) r.push_back(i);
    }
    return r;
  }

  /// Returns one point of each cell.
  std::vector<Planar> midpoints() const {
    std::vector<Planar> r;
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
      if (gaps_[i].link == i) r.push_back(gaps_[i].midpoint);
    }
    return r;
  }

 private:
  /// The open part of a gap at one end of its slab.
  struct Opening {
    Rational low, high;
  };

  void add_gaps(const Rational& left, const Rational& right) {
    // Consecutive cuts bound a gap. Its centre is on no cut, because the gap is convex and has an interior.
    const std::vector<Layer> layers = layers_between(cuts_, left, right);
    for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
      const Planar midpoint{(left + right) / 2, (layers[i].y + layers[i + 1].y) / 2};
      gaps_.push_back({layers[i].cut, layers[i + 1].cut, midpoint, gaps_.size()});
    }
  }

  std::size_t first_of(std::size_t i) const {
    // Union-find without path compression. Links lead to lower indices only, so the root is the cell's first
    // gap.
    while (gaps_[i].link != i) i = gaps_[i].link;
    return i;
  }

  std::vector<Opening> openings(std::size_t begin, std::size_t end, const Rational& x) const {
    std::vector<Opening> r;
    for (std::size_t i = begin; i < end; ++i) {
      r.push_back({cuts_[gaps_[i].below].y_at(x), cuts_[gaps_[i].above].y_at(x)});
    }
    return r;
  }

  /// Unites gaps across x, where the slab of the gaps [left, boundary) borders on the slab of [boundary,
  /// end): gaps that open to each other belong to one cell. Both lists are in ascending order, so one merge
  /// finds all such pairs.
  void join_neighbours(std::size_t left, std::size_t boundary, const Rational& x) {
    const std::vector<Opening> l = openings(left, boundary, x), r = openings(boundary, gaps_.size(), x);
    const std::vector<const Cut*> walls = walls_at(x);
    // Merge of two sorted lists of intervals on the line at x: linear in the number of gaps.
    for (std::size_t i = 0, j = 0; i < l.size() && j < r.size();) {
      const Rational &low = std::max(l[i].low, r[j].low), &high = std::min(l[i].high, r[j].high);
      // The openings overlap in more than a point, and no vertical cut closes the overlap: one cell.
      if (low < high && !walled_off(walls, low, high)) {
        const std::size_t a = first_of(left + i), b = first_of(boundary + j);
        gaps_[std::max(a, b)].link = std::min(a, b);
      }
      // Advance past the opening that ends first: it cannot overlap any later opening of the other side.
      if (l[i].high <= r[j].high)
        ++i;
      else
        ++j;
    }
  }

  /// Returns the vertical cuts at x in ascending order.
  std::vector<const Cut*> walls_at(const Rational& x) const {
    std::vector<const Cut*> walls;
    for (const Cut& c : cuts_) {
      if (c.is_vertical() && c.from.x == x) walls.push_back(&c);
    }
    std::sort(walls.begin(), walls.end(), [](const Cut* a, const Cut* b) { return a->from.y < b->from.y; });
    return walls;
  }

  /// Returns true if the walls cover the interval from low to high.
  static bool walled_off(const std::vector<const Cut*>& walls, Rational low, const Rational& high) {
    // Move `low` up over the walls that begin at or below it. The walls are sorted, so one pass is enough.
    for (const Cut* c : walls) {
      if (c->from.y <= low) low = std::max(low, c->to.y);
    }
    return low >= high;
  }

  const std::vector<Cut>& cuts_;
  std::vector<Rational> events_;        ///< abscissas of the slab boundaries
  std::vector<std::size_t> first_gap_;  ///< (slabs + 1)
  std::vector<Gap> gaps_;
  bool whole_ = false;
};

}  // namespace cutting

using namespace cutting;

struct CutFace::Parts {
  CutTriangle triangle;
  std::unique_ptr<Slabs> slabs;
  std::vector<std::size_t> cells;  ///< the first gap of each cell

  Parts(const double* const tri[3], const Axes& axes) : triangle(tri, axes) {}
};

std::optional<CutFace> CutFace::make(const double* const tri[3],
                                     std::span<const std::array<const double*, 3>> others,
                                     std::size_t limit) {
  const Axes axes = axes_for(tri[0], tri[1], tri[2]);
  if (axes.turn == 0) return std::nullopt;
  const auto parts = std::make_shared<Parts>(tri, axes);
  for (const auto& other : others) {
    parts->triangle.cut_by(other.data());
    // The triangle's own edges do not count against the limit.
    if (parts->triangle.cuts().size() > limit + 3) return std::nullopt;
  }
  parts->slabs = std::make_unique<Slabs>(parts->triangle.cuts(), kGapsPerCell * limit);
  if (!parts->slabs->whole()) return std::nullopt;
  parts->cells = parts->slabs->cells();
  CutFace face;
  for (const Planar& p : parts->slabs->midpoints()) face.samples_.push_back(parts->triangle.lift(p));
  face.parts_ = parts;
  return face;
}

std::size_t CutFace::cell_beside(int edge, const RationalPoint& p) const {
  const std::size_t gap =
      parts_->slabs->gap_beside(static_cast<std::size_t>(edge), parts_->triangle.project(p.coordinates().x));
  // Cells are listed in ascending order of their first gaps.
  const auto cell = std::lower_bound(parts_->cells.begin(), parts_->cells.end(), gap);
  return static_cast<std::size_t>(cell - parts_->cells.begin());
}

namespace {

/// Adds the parameters at which the line of the segment p, q intersects the edge lines of a triangle that is
/// coplanar with the segment. Returns false if the triangle has no area.
bool add_shares_in_plane(const RationalVec& p, const RationalVec& q, const double* const t[3],
                         std::vector<Rational>& shares) {
  const Axes axes = axes_for(t[0], t[1], t[2]);
  if (axes.turn == 0) return false;
  // A coordinate in which p and q differ gives the parameter of a point on their line.
  const std::size_t k = p[0] != q[0] ? 0 : p[1] != q[1] ? 1 : 2;
  for (int i = 0; i < 3; ++i) {
    const RationalVec a = to_rational(t[i]), b = to_rational(t[(i + 1) % 3]);
    const Rational at_p = area_determinant(a, b, p, axes.x, axes.y);
    const Rational at_q = area_determinant(a, b, q, axes.x, axes.y);
    // The edge is collinear with the segment: the segment is cut at both ends of the edge.
    if (at_p == 0 && at_q == 0) {
      shares.push_back((a[k] - p[k]) / (q[k] - p[k]));
      shares.push_back((b[k] - p[k]) / (q[k] - p[k]));
    } else if (at_p != at_q) {
      shares.push_back(at_p / (at_p - at_q));
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<RationalPoint>> sample_edge(
    const double* from, const double* to, std::span<const std::array<const double*, 3>> triangles) {
  const RationalVec p = to_rational(from), q = to_rational(to);
  if (p == q) return std::nullopt;
  std::vector<Rational> all, shares{Rational(0)};
  for (const auto& t : triangles) {
    const RationalVec a = to_rational(t[0]), b = to_rational(t[1]), c = to_rational(t[2]);
    const Rational at_p = volume_determinant(a, b, c, p), at_q = volume_determinant(a, b, c, q);
    // The plane crosses the segment's line in one point. Equal heights: the line is parallel to it or in it.
    if (at_p != at_q)
      all.push_back(at_p / (at_p - at_q));
    else if (at_p == 0 && !add_shares_in_plane(p, q, t.data(), all))
      return std::nullopt;
  }
  // Keep the parameters in (0, 1), each once. One sample is taken at the centre of each part.
  std::sort(all.begin(), all.end());
  for (const Rational& t : all)
    if (t > shares.back() && t < 1) shares.push_back(t);
  shares.emplace_back(1);
  std::vector<RationalPoint> samples;
  for (std::size_t i = 0; i + 1 < shares.size(); ++i)
    samples.push_back(make_point(between(p, q, (shares[i] + shares[i + 1]) / 2)));
  return samples;
}

std::optional<std::vector<RationalPoint>> sample_cells(const double* const tri[3],
                                                       std::span<const std::array<const double*, 3>> others,
                                                       std::size_t limit) {
  std::vector<RationalPoint> samples;
  const Axes axes = axes_for(tri[0], tri[1], tri[2]);
  if (axes.turn == 0) return samples;
  CutTriangle triangle(tri, axes);
  for (const auto& other : others) {
    triangle.cut_by(other.data());
    // Stop early: the time below is cubic in the number of cuts.
    if (triangle.cuts().size() > limit + 3) return std::nullopt;  // 3: its own edges
  }
  const Slabs slabs(triangle.cuts(), kGapsPerCell * limit);
  const std::vector<Planar> midpoints = slabs.midpoints();
  if (!slabs.whole() || midpoints.size() > limit) return std::nullopt;
  for (const Planar& p : midpoints) samples.push_back(triangle.lift(p));
  return samples;
}

std::optional<std::vector<RationalPoint>> sample_cells_2d(
    const double* const seg[2], std::span<const std::array<const double*, 2>> others, std::size_t limit) {
  std::vector<RationalPoint> samples;
  const int axis = seg[0][0] != seg[1][0] ? 0 : 1;
  if (seg[0][axis] == seg[1][axis]) return samples;
  const RationalVec s = to_rational(seg[0], 2), e = to_rational(seg[1], 2);
  // Cuts are parameters along the segment. Only those strictly between its ends divide it.
  std::vector<Rational> cuts{Rational(0), Rational(1)};
  const auto add = [&](const Rational& t) {
    if (t > 0 && t < 1) cuts.push_back(t);
  };
  for (const auto& other : others) {
    const int side0 = orient2d(seg[0], seg[1], other[0]), side1 = orient2d(seg[0], seg[1], other[1]);
    // The other segment is strictly on one side of this one's line: no cut.
    if (side0 * side1 > 0) continue;
    const RationalVec p = to_rational(other[0], 2), q = to_rational(other[1], 2);
    // Collinear: the ends of the other segment cut this one.
    if (side0 == 0 && side1 == 0) {
      const auto k = static_cast<std::size_t>(axis);
      add((p[k] - s[k]) / (e[k] - s[k]));
      add((q[k] - s[k]) / (e[k] - s[k]));
    } else {
      // Not collinear: its line cuts this one where the signed area changes sign.
      const Rational hs = area_determinant(p, q, s, 0, 1), he = area_determinant(p, q, e, 0, 1);
      add(hs / (hs - he));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  if (cuts.size() > limit + 1) return std::nullopt;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    samples.push_back(make_point(between(s, e, (cuts[i] + cuts[i + 1]) / 2)));
  }
  return samples;
}

}  // namespace lrb::exact
