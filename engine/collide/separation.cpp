/// Finds a certificate of separation: wrappers, as coarse as possible, whose boundaries are proven disjoint,
/// and where neither wrapper contains a piece of the other.
///
/// 1. Start from the outermost wrappers.
/// 2. Compare all pairs of boundary faces. If two come within the margin, refine the larger of the regions
///    behind them.
/// 3. If a piece of one boundary is inside the other wrapper, refine there, then repeat step 2.
/// 4. Coarsen every region that the proof does not need.

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/collide/relation.hpp"
#include "engine/core/axes.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/lrb/complex.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/validate.hpp>

namespace lrb {

// Separating axis test (Gottschalk, Lin and Manocha, "OBBTree", 1996, for boxes; Ericson, "Real-Time
// Collision Detection", 2005, for triangles) with a margin: the projections onto some direction must be
// further apart than the margin.

namespace {

using Eigen::Vector3d;
using RelativeCorners = std::array<Vector3d, 3>;

RelativeCorners relative_to(const double* origin, const double* const x[3], int dim) {
  RelativeCorners c;
  for (int k = 0; k < 3; ++k) {
    const double* p = x[dim == 2 && k == 2 ? 1 : k];
    c[k] = {p[0] - origin[0], p[1] - origin[1], dim == 3 ? p[2] - origin[2] : 0};
  }
  return c;
}

/// Searches for a slab that separates two simplices. Directions need not be accurate: each is verified.
class SlabSearch {
 public:
  SlabSearch(int dim, const RelativeCorners& a, const RelativeCorners& b, double margin)
      : dim_(dim), a_(a), b_(b), margin_(margin) {}

  int directions() const { return dim_ == 3 ? 21 : 7; }

  /// Returns true if a slab wider than the margin, normal to this direction, separates the two.
  bool parts(int direction) const {
    const Vector3d d = dim_ == 3 ? in_space(direction) : in_plane(direction);
    const double length_sq = d.squaredNorm();
    // A direction that vanishes, underflows or overflows proves nothing.
    if (!std::isnormal(length_sq)) return false;
    const double least = margin_ * std::sqrt(length_sq);
    if (!std::isnormal(least)) return false;
    // Both sides are scaled by |d|, which avoids a division.
    return gap_along(d, a_, b_) > least;
  }

 private:
  static Vector3d edge(const RelativeCorners& c, int k) { return c[(k + 1) % 3] - c[k]; }
  static Vector3d normal(const RelativeCorners& c) { return edge(c, 0).cross(edge(c, 1)); }
  Vector3d between_centroids() const { return (b_[0] + b_[1] + b_[2]) - (a_[0] + a_[1] + a_[2]); }

  /// Returns a direction to try: 0 the line between the centroids, 1-2 normals, 3-11 edge x edge, 12-17 the
  /// edge normals in each plane, 18-20 the axes.
  Vector3d in_space(int i) const {
    // Face normals and edge x edge are complete for disjoint triangles in general position; the others are
    // for coplanar and degenerate ones.
    if (i == 0) return between_centroids();
    if (i < 3) return normal(i == 1 ? a_ : b_);
    if (i < 12) return edge(a_, (i - 3) / 3).cross(edge(b_, (i - 3) % 3));
    if (i < 15) return normal(a_).cross(edge(a_, i - 12));
    if (i < 18) return normal(b_).cross(edge(b_, i - 15));
    return Vector3d::Unit(i - 18);
  }
  Vector3d in_plane(int i) const {
    if (i == 0) return between_centroids();
    if (i > 4) return Vector3d::Unit(i - 5);
    // 1 and 2: normal to each segment; 3 and 4: along it, for collinear segments.
    const Vector3d e = edge(i % 2 != 0 ? a_ : b_, 0);
    return i < 3 ? Vector3d(-e.y(), e.x(), 0) : e;
  }

  int dim_;
  const RelativeCorners &a_, &b_;
  double margin_;
};

}  // namespace

bool separated_by(double margin, int dim, const double* const a[3], const double* const b[3]) {
  // Differences of nearby coordinates lose few digits, even far from the origin.
  const RelativeCorners x = relative_to(a[0], a, dim), y = relative_to(a[0], b, dim);
  const SlabSearch search(dim, x, y, margin);
  // One direction suffices. The margin is far larger than the rounding of the projections.
  for (int i = 0; i < search.directions(); ++i)
    if (search.parts(i)) return true;
  return false;
}

namespace {

using Box = Eigen::AlignedBox3d;

/// A body's wrapper in the world: its boundary faces with their boxes.
class WorldWrapper {
 public:
  WorldWrapper(QueryBody& body, double margin) : body_(body), wrapper_(body.rep()), margin_(margin) {
    add(body.rep().outermost_faces());
  }

  const LrbRep& rep() const { return body_.rep(); }
  const Wrapper& wrapper() const { return wrapper_; }
  std::size_t size() const { return faces_.size(); }
  FaceId face(std::size_t i) const { return faces_[i]; }
  bool is_there(std::size_t i) const { return wrapper_.on_boundary(faces_[i]); }
  const double* world(VertexId v) { return body_.world(v); }

  /// Returns the included region next to a boundary face, or kNull for a real face.
  RegionId region_at(FaceId f) const {
    // A pseudo face on the boundary has an included region on exactly one side; refining that region removes
    // it.
    const CellId inner = rep().inner_cell(f);
    if (is_region(inner)) return (wrapper_.included(inner) ? inner : rep().outer_cell(f)).as_region();
    return kNull;
  }

  void refine(RegionId r) {
    wrapper_.refine(r);
    add(rep().collector(r));
  }
  void coarsen(RegionId r) {
    wrapper_.coarsen(r);
    add(rep().collector(r));
  }

  /// Returns true if two boundary faces are further apart than the margin.
  bool apart(std::size_t i, WorldWrapper& other, std::size_t j) {
    // Both boxes are grown by 2 margins: if they are disjoint, the gap is wider than the margin.
    if (!boxes_[i].intersects(other.boxes_[j])) return true;
    const double *a[3], *b[3];
    // Polygons are compared as fans: every triangle with every triangle.
    for (std::uint32_t s = 0; s < simplices(faces_[i]); ++s)
      for (std::uint32_t t = 0; t < other.simplices(other.faces_[j]); ++t) {
        body_.world.corners(SimplexId(rep().first_simplex(faces_[i]) + s), a);
        other.body_.world.corners(SimplexId(other.rep().first_simplex(other.faces_[j]) + t), b);
        if (!separated_by(margin_, rep().dim(), a, b)) return false;
      }
    return true;
  }

  /// Return whether a world point is in the wrapper, and in which region (kNull if in none).
  bool holds(const double* point) {
    // Parity of the crossings of an exact ray.
    const std::vector<FaceId> boundary = wrapper_.boundary();
    return crossed(point, boundary) % 2 != 0;
  }
  RegionId region_that_holds(const double* point) {
    // Linear in the number of regions. Needed only where a piece lies inside the other wrapper.
    for (RegionId r = 0; r < rep().region_count(); ++r)
      if (wrapper_.included(r) && crossed(point, rep().collector(r)) % 2 != 0) return r;
    return kNull;
  }

 private:
  SimplexId simplices(FaceId f) const {
    return static_cast<SimplexId>(Mesh::simplices_of(rep().face(f).size(), rep().dim()));
  }

  /// Adds faces of the boundary. A face may be added twice, which is harmless.
  void add(std::span<const FaceId> faces) {
    for (const FaceId f : faces) {
      if (!wrapper_.on_boundary(f)) continue;
      Box box;
      for (const VertexId v : rep().face(f)) {
        const double* x = world(v);
        box.extend(Eigen::Vector3d(x[0], x[1], x[2]));
      }
      const Eigen::Vector3d grow = Eigen::Vector3d::Constant(2 * margin_);
      faces_.push_back(f);
      boxes_.emplace_back(box.min() - grow, box.max() + grow);
    }
  }

  int crossed(const double* point, std::span<const FaceId> faces) {
    int crossings = 0;
    const double* c[3];
    for (const FaceId f : faces)
      for (std::uint32_t i = 0; i < simplices(f); ++i) {
        // Ties are broken symbolically, so that no hit is degenerate.
        body_.world.corners(SimplexId(rep().first_simplex(f) + i), c);
        const exact::RayHit hit =
            rep().dim() == 3 ? exact::ray_crosses(point, c) : exact::ray_crosses_2d(point, c);
        crossings += hit == exact::RayHit::crosses;
      }
    return crossings;
  }

  QueryBody& body_;
  Wrapper wrapper_;
  double margin_;
  std::vector<FaceId> faces_;  ///< boundary faces, including some that were refined since
  std::vector<Box> boxes_;
};

class SeparationFinder {
 public:
  SeparationFinder(QueryContext& ctx, double margin)
      : half_{WorldWrapper(ctx[Side::a], margin), WorldWrapper(ctx[Side::b], margin)} {}

  std::optional<Separation> run() {
    // Refining in one test can make the other fail, so repeat until both pass. Terminates, because the number
    // of regions is finite.
    do {
      if (!part_boundaries()) return std::nullopt;
    } while (open_what_holds_a_piece());
    if (stuck_) return std::nullopt;
    // The wrappers are separate. Coarsen them while they stay separate.
    for (const int side : {0, 1}) take_back(side);
    Separation s;
    for (const int side : {0, 1}) {
      s.refined[side] = half_[side].wrapper().excluded();
      s.face_count[side] = static_cast<std::uint32_t>(half_[side].wrapper().boundary_size());
    }
    return s;
  }

 private:
  /// Refines until no boundary faces are within the margin. Returns false if two real faces are.
  bool part_boundaries() {
    // Every face of A is compared with every face of B once, when the later one of them is processed.
    while (done_[0] < half_[0].size() || done_[1] < half_[1].size()) {
      // Refining appends the new faces to the lists, so that they are compared as well.
      const int side = done_[0] < half_[0].size() ? 0 : 1;
      const std::size_t i = done_[side]++;
      // Skip faces that have left the boundary since they were listed.
      for (std::size_t j = 0; j < done_[1 - side] && half_[side].is_there(i); ++j)
        if (half_[1 - side].is_there(j) && !half_[side].apart(i, half_[1 - side], j) &&
            !refine_one(side, i, j))
          return false;
    }
    return true;
  }

  /// Refines the larger of the regions behind two faces within the margin. Returns false if both faces are
  /// real.
  bool refine_one(int side, std::size_t i, std::size_t j) {
    const RegionId r = half_[side].region_at(half_[side].face(i)),
                   q = half_[1 - side].region_at(half_[1 - side].face(j));
    // Two real faces within the margin: no refinement can separate them.
    if (r == kNull && q == kNull) return false;
    // The larger region hides more empty space.
    const bool first = q == kNull || (r != kNull && size_of(side, r) >= size_of(1 - side, q));
    first ? half_[side].refine(r) : half_[1 - side].refine(q);
    return true;
  }
  double size_of(int side, RegionId r) const { return std::abs(region_volume(half_[side].rep(), r)); }

  /// Returns a vertex of a piece of one boundary inside the other wrapper, or kNull if no piece is.
  VertexId piece_inside(int inner) {
    const std::vector<FaceId> boundary = half_[inner].wrapper().boundary();
    // One vertex per piece is enough: the boundaries do not intersect, so that a piece is inside or outside
    // as a whole.
    for (const VertexId v : piece_vertices(half_[inner].rep(), boundary))
      if (half_[1 - inner].holds(half_[inner].world(v))) return v;
    return kNull;
  }
  bool nested() { return piece_inside(0) != kNull || piece_inside(1) != kNull; }

  /// Refines a region that contains a piece of the other boundary. Returns true if it refined one.
  bool open_what_holds_a_piece() {
    for (const int inner : {0, 1}) {
      const VertexId v = piece_inside(inner);
      if (v == kNull) continue;
      // If v is in a region of the other wrapper, refine that region; if in the other solid, v's own wrapper.
      if (!open_down_to(1 - inner, half_[1 - inner].region_that_holds(half_[inner].world(v))) &&
          !refine_at(inner, v)) {
        // No region is left to refine: there is no certificate.
        stuck_ = true;
        return false;
      }
      return true;
    }
    return false;
  }

  bool open_down_to(int side, CellId cell) {
    if (cell == kNull) return false;
    // Collect the regions from the inside outward, then refine them from the outside inward.
    std::vector<RegionId> path;
    for (; is_region(cell) && half_[side].wrapper().included(cell);
         cell = half_[side].rep().parent(cell.as_region()))
      path.push_back(cell.as_region());
    for (; !path.empty(); path.pop_back()) half_[side].refine(path.back());
    return true;
  }

  /// Refines a region of `side` at the boundary vertex v, which is in the other body's solid: v is then not
  /// one of the body's own vertices, because the bodies are separate. Returns false if no region has v.
  bool refine_at(int side, VertexId v) {
    for (std::size_t i = 0; i < half_[side].size(); ++i) {
      if (!half_[side].is_there(i)) continue;
      const FaceId f = half_[side].face(i);
      // Any pseudo face at v will do: refining its region moves the boundary towards the body.
      const auto corners = half_[side].rep().face(f);
      if (std::find(corners.begin(), corners.end(), v) == corners.end()) continue;
      const RegionId r = half_[side].region_at(f);
      if (r == kNull) continue;
      half_[side].refine(r);
      return true;
    }
    return false;
  }

  /// Coarsens every region that the proof does not need. One pass suffices: wrappers only grow, so that a
  /// region that could not be restored still cannot.
  void take_back(int side) {
    const std::vector<RegionId> refined = half_[side].wrapper().excluded();
    // The latest refinement first.
    for (auto r = refined.rbegin(); r != refined.rend(); ++r) {
      const std::size_t before = half_[side].size();
      // The lids that reappear are appended, and only they need a test.
      half_[side].coarsen(*r);
      if (!are_clear(side, before) || nested()) half_[side].refine(*r);
    }
  }

  /// Returns true if the boundary faces from index `first` on are separated from all of the other's.
  bool are_clear(int side, std::size_t first) {
    for (std::size_t i = first; i < half_[side].size(); ++i)
      for (std::size_t j = 0; j < half_[1 - side].size(); ++j)
        if (half_[side].is_there(i) && half_[1 - side].is_there(j) &&
            !half_[side].apart(i, half_[1 - side], j))
          return false;
    return true;
  }

  WorldWrapper half_[2];
  std::size_t done_[2] = {0, 0};  ///< number of faces of each that were compared with the other's
  bool stuck_ = false;
};

}  // namespace

std::optional<Separation> find_separation(QueryContext& ctx) {
  for (const Side side : {Side::a, Side::b})
    if (!ctx[side].rep().closed() || ctx[side].rep().self_intersecting()) return std::nullopt;
  const double margin = wrapper_margin(ctx[Side::a].world.pose(), ctx[Side::a].rep().tree(),
                                       ctx[Side::b].world.pose(), ctx[Side::b].rep().tree());
  return SeparationFinder(ctx, margin).run();
}

}  // namespace lrb
