// The outermost wrapper: a convex polytope with few faces around the points.
// 1. Reduce the points to those near their convex hull.
// 2. Replace each by a small tetrahedron: the convex hull of the tetrahedra is the first hull moved outward.
// 3. Simplify that hull outward with two settings (simplify_polytope()).
// 4. Keep the candidate of least volume that contains all points, tested exactly. A box is the fallback, or a
//    prism or tetrahedron for fewer than 12 faces.

#include "engine/construct/closing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/convex_hull.hpp"
#include "engine/construct/embed_check.hpp"
#include "engine/construct/front_update.hpp"
#include "engine/construct/half_spaces.hpp"
#include "engine/construct/open_front.hpp"
#include "engine/construct/outward_collapse.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::construct {

// Bridging: replaces the front of a set of components by their convex hull.
// 1. Compute the exact convex hull of the front's vertices.
// 2. Compare triangles: those in both are retained, other hull triangles are added, other front triangles are
//    covered.
// 3. Verify that the front becomes simpler and stays embedded.
// 4. The space in between, split into pockets, becomes regions; the components become one.

namespace {

using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

/// Returns the triangles of the convex hull of the slots' vertices; corners are vertices of the front.
std::vector<PointTriangle> convex_hull_of(const FrontMesh& front, const std::vector<Slot>& slots) {
  // Each vertex once, in ascending order: the result depends only on the set of slots.
  std::vector<Corner> corners;
  for (const Slot s : slots) corners.insert(corners.end(), front[s].v.begin(), front[s].v.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector3d> points;
  for (const Corner c : corners) points.push_back(front.x(c));
  std::vector<PointTriangle> triangles = convex_hull(points);
  // Map point indices back to vertices of the front.
  for (PointTriangle& t : triangles)
    for (std::uint32_t& v : t) v = corners[v];
  return triangles;
}

PointTriangle smallest_first(const PointTriangle& t) {
  // Canonical rotation: equal triangles compare equal, and the orientation is preserved.
  const int i = static_cast<int>(std::min_element(t.begin(), t.end()) - t.begin());
  return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

CapVerdict judge(const FrontMesh& front, const std::vector<PointTriangle>& added) {
  // A new tree: all of its slots are alive.
  const AabbTree tree(front);
  std::vector<CheckedTriangle> checked;
  for (const PointTriangle& t : added)
    checked.emplace_back(front.point(t[0]), front.point(t[1]), front.point(t[2]));
  for (std::size_t i = 0; i < checked.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      // Triangles of a convex hull can overlap only because of coplanar vertices, or vertices with equal
      // coordinates.
      if (!checked[i].clear_of(checked[j])) return CapVerdict::meets_itself;
    // Against the entire front, including covered triangles: a lid may intersect its floor only in shared
    // vertices and edges.
    bool clear = true;
    tree.for_each_in(checked[i].box, [&](Slot s) {
      const auto& v = front[s].v;
      clear = clear && checked[i].clear_of({front.point(v[0]), front.point(v[1]), front.point(v[2])});
    });
    if (!clear) return CapVerdict::meets_front;
  }
  return CapVerdict::accepted;
}

/// The faces of the convex hull that are not in the front, and the front's triangles that they cover.
struct Bridge {
  std::vector<PointTriangle> added;
  std::vector<Slot> removed;
};

/// Finds them. `convex`: all faces of the convex hull, ascending. Triangles in both are retained.
Bridge find_bridge(const FrontMesh& front, const std::vector<Slot>& slots,
                   std::vector<PointTriangle> convex) {
  Bridge bridge;
  std::vector<PointTriangle> kept;
  for (const Slot s : slots) {
    const PointTriangle t = smallest_first(front[s].v);
    // A triangle of the front that is on the convex hull already: no pocket beneath it.
    if (std::binary_search(convex.begin(), convex.end(), t))
      kept.push_back(t);
    else
      // It is beneath the convex hull, as the floor of a pocket.
      bridge.removed.push_back(s);
  }
  std::sort(kept.begin(), kept.end());
  std::erase_if(convex,
                [&](const PointTriangle& t) { return std::binary_search(kept.begin(), kept.end(), t); });
  bridge.added = std::move(convex);
  return bridge;
}

/// Returns true if the bridge covers some triangles of a polygon, but not all. In the complex a polygon is
/// one face, with one cell in front of it.
bool splits_polygon(const FrontMesh& front, const Bridge& bridge) {
  // Each polygon with a covered triangle must have all of its triangles covered.
  std::vector<bool> removed(front.slot_count(), false);
  for (const Slot s : bridge.removed) removed[s] = true;
  return std::any_of(bridge.removed.begin(), bridge.removed.end(), [&](Slot s) {
    const auto [first, last] = front.unit(s);
    return !std::all_of(removed.begin() + first, removed.begin() + last, [](bool r) { return r; });
  });
}

CapVerdict judge(const FrontMesh& front, const std::vector<Slot>& slots, std::size_t convex_faces,
                 const Bridge& bridge) {
  // The vertices are coplanar.
  if (convex_faces == 0) return CapVerdict::flat;
  // The same threshold as for caps: the result must have clearly fewer triangles.
  const bool worth = static_cast<double>(convex_faces) <= kLastCapWorth * static_cast<double>(slots.size());
  if (!worth || bridge.removed.empty()) return CapVerdict::too_many_faces;
  // A polygon that is not planar can have one triangle on the convex hull and another below it.
  if (splits_polygon(front, bridge)) return CapVerdict::splits_polygon;
  // The expensive exact tests come last.
  return judge(front, bridge.added);
}

}  // namespace

CapVerdict bridge_concavities(FrontMesh& front, ComplexBuilder& complex, const std::vector<bool>& joined,
                              std::uint16_t layer, ConstructProbe* probe) {
  // Step 1: the convex hull of the chosen components.
  std::vector<Slot> slots = front.alive_slots();
  std::erase_if(slots, [&](Slot s) { return !joined[front[s].component]; });
  std::vector<PointTriangle> convex = convex_hull_of(front, slots);
  // Step 2: sort the canonical triangles, so that membership is a binary search.
  for (PointTriangle& t : convex) t = smallest_first(t);
  std::sort(convex.begin(), convex.end());
  const std::size_t convex_faces = convex.size();
  const Bridge bridge = find_bridge(front, slots, std::move(convex));
  // Step 3.
  const CapVerdict verdict = judge(front, slots, convex_faces, bridge);
  if (probe) {
    probe->patch({front.point(front[slots[0]].v[0]).id, static_cast<std::uint32_t>(slots.size()), 0});
    probe->cap({static_cast<std::uint32_t>(bridge.added.size()),
                static_cast<std::uint32_t>(bridge.removed.size()), verdict, false, -1});
  }
  if (verdict != CapVerdict::accepted) return verdict;
  // Step 4: relabel first, so that lids and retained triangles share a component.
  const std::uint32_t component = front[slots[0]].component;
  for (const Slot s : slots) front.set_component(s, component);
  Sheet sheet;
  sheet.removed = bridge.removed;
  sheet.added = bridge.added;
  work_out(front, sheet);
  cover(front, complex, sheet, layer, component, probe);
  return verdict;
}

// Outward simplification of a convex polytope, in steps of decreasing size:
// 1. Collapse edges outward, as for caps (progressive hulls, Sander et al. 2000).
// 2. Take the convex hull of the result.
// 3. Tighten: coordinate descent on the volume. One vertex at a time moves to its best position with the
//    points still behind its faces.
// 4. Take the convex hull again, and repeat from 1 until there are few enough faces.

namespace {

using Vector3 = Eigen::Vector3d;

/// The first step reduces the number of faces to this; each further step removes 1 / kStepShare of the faces.
constexpr std::size_t kTightenFrom = 100, kStepShare = 4;
/// Rounds of tightening after each step, and after the last one.
constexpr int kRounds = 3, kLastRounds = 20;
constexpr double kSwell = 0.4;  ///< see BodyBounds; only keeps vertices from moving far away

/// Collapses edges of a closed surface outward, cheapest first, until it has no more than `wanted` faces, or
/// until no collapse is possible. Returns the vertices that are left. `points`: near which they stay;
/// `depth`: see OutwardCollapse::place().
std::vector<Vector3> collapse_outward(const Mesh& convex, const std::vector<Vector3>& points,
                                      std::size_t wanted, double depth) {
  using Index = OpenFront::Index;
  struct Candidate {
    double cost;
    Index u, v;
    bool operator<(const Candidate& other) const {  // orders the cheapest last, for heaps
      if (cost != other.cost) return cost > other.cost;
      return u != other.u ? u > other.u : v > other.v;
    }
  };
  const FrontMesh front(convex);
  const BodyBounds bounds(points, kSwell);
  OpenFront open(front, {});
  OutwardCollapse geometry(open, bounds, depth, kCapShapeWeight);
  OpenFront::Star star;
  Vector3 w;
  std::priority_queue<Candidate> queue;
  // Leaves the edge's star in `star` and the new vertex in `w`. Infinite if the collapse is impossible.
  const auto cost_of = [&](Index u, Index v) {
    if (!open.find_star(u, v, false, star) || !open.leaves_surface(star) || !geometry.place(star, w))
      return kInfinity;
    double area = 0;
    const double volume = geometry.volume_under(star, w, area);
    return volume + geometry.needle_cost(star, w, area);
  };
  const auto propose = [&](Index u, Index v) {
    if (const double cost = cost_of(u, v); cost < kInfinity) queue.push({cost, u, v});
  };
  std::size_t faces = convex.face_count();
  // A collapse that is impossible now may be possible after others: repeat until nothing changes.
  for (std::size_t before = 0; faces > wanted && faces != before;) {
    before = faces;
    for (Index f = 0; f < open.face_count(); ++f)
      for (int i = 0; i < 3 && open.state(f).alive; ++i)
        if (const Index u = open[f].v[i], v = open[f].v[(i + 1) % 3]; u < v) propose(u, v);
    while (faces > wanted && !queue.empty()) {
      const Candidate c = queue.top();
      queue.pop();
      if (!open.is_used(c.u) || !open.is_used(c.v)) continue;
      // The star may have changed. If its cost has risen, put it back, because others may be cheaper now.
      const double cost = cost_of(c.u, c.v);
      if (cost > c.cost) {
        if (cost < kInfinity) queue.push({cost, c.u, c.v});
        continue;
      }
      if (!geometry.is_strictly_in_front(star, w)) continue;
      faces -= star.faces.size() - star.rim.size();
      const Index tip = open.collapse(star, {}, w, {}, 0);
      const auto rim = star.rim;
      for (const auto& r : rim) propose(r.a, tip);
    }
    queue = {};
  }
  std::vector<Vector3> left;
  for (Index v = 0; v < open.vertex_count(); ++v)
    if (open.is_used(v)) left.push_back(open.x(v));
  return left;
}

/// Moves the vertices of a convex surface, so that the volume behind it decreases and `points` stay there.
class Tightening {
 public:
  Tightening(Mesh& mesh, const std::vector<Vector3>& points)
      : mesh_(mesh), points_(points), rims_(mesh.vertices.size()) {
    Eigen::AlignedBox3d box;
    for (const Vector3& p : points) box.extend(p);
    size_sq_ = squared_norm3(box.sizes());
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      const auto v = mesh.face(f);
      for (int i = 0; i < 3; ++i) rims_[v[i]].push_back({v[(i + 1) % 3], v[(i + 2) % 3]});
    }
  }

  void run(int rounds) {
    // Gauss-Seidel rounds over the vertices: every move reduces the volume.
    for (int round = 0; round < rounds; ++round) {
      double gain = 0;
      for (std::size_t v = 0; v < rims_.size(); ++v) {
        if (rims_[v].empty()) continue;
        // Only the fan of v changes, and the volume changes by the cone over its boundary loop.
        rim_.clear();
        for (const auto& [a, b] : rims_[v]) rim_.push_back({mesh_.vertices[a], mesh_.vertices[b]});
        const auto w = place();
        const double change = w ? cone_volume(*w) - cone_volume(mesh_.vertices[v]) : 0;
        // Written so that NaN counts as no gain.
        if (!(change < 0)) continue;
        mesh_.vertices[v] = *w;
        gain -= change;
      }
      // Diminishing returns: stop before the last round.
      if (gain < kLeastGain * volume_of(mesh_)) return;
    }
  }

 private:
  struct Edge {
    Vector3 a, b;
  };

  double cone_volume(const Vector3& w) const {
    double sixfold = 0;
    // The base of the cone is arbitrary, because only differences of these volumes are compared.
    for (const Edge& e : rim_) sixfold += dot3(w - rim_[0].a, (e.a - rim_[0].a).cross(e.b - rim_[0].a));
    return sixfold / 6;
  }

  /// Returns the position of least volume of the cone over the rim, or nullopt if none is feasible. The
  /// volume decreases against the sum of the rim's area vectors, so a point far in that direction is
  /// projected onto the feasible set.
  std::optional<Vector3> place() {
    Vector3 centre = Vector3::Zero(), area = Vector3::Zero();
    // Coordinates relative to the centre of the boundary loop, so that slack and depth scale with its radius.
    for (const Edge& e : rim_) centre += e.a;
    centre /= static_cast<double>(rim_.size());
    double radius_sq = 0;
    half_spaces_.clear();
    for (const Edge& e : rim_) {
      area += (e.a - centre).cross(e.b - centre);
      radius_sq = std::max(radius_sq, squared_norm3(e.a - centre));
      // The faces over this edge must have all points behind them.
      for (const Vector3& n : touching_normals(e)) half_spaces_.push_back({n, dot3(n, e.a - centre)});
    }
    // The volume is linear in w. Its gradient is the loop's area vector, so the best w is the extreme point
    // of the feasible polyhedron against that vector. Projecting a far target approximates this linear
    // programme, and stays bounded where the linear programme is unbounded.
    const double radius = std::sqrt(radius_sq), length = norm3(area);
    if (!(length > 0)) return std::nullopt;
    const auto w = nearest_point(area * (-kDepth * radius / length), half_spaces_, kPlacementSlack * radius);
    if (!w) return std::nullopt;
    return Vector3(*w + centre);
  }

  /// Returns the normals of the two planes that contain the edge a, b and touch the points. All points are
  /// behind a face a, b, w if w is in front of the plane a, b, p for each point p; only the two outermost of
  /// these planes matter.
  std::array<Vector3, 2> touching_normals(const Edge& e) const {
    const Vector3 along = e.b - e.a;
    std::array<Vector3, 2> normals = {Vector3::Zero(), Vector3::Zero()};
    // The planes through the edge form a pencil. Rotate two of them about the edge until no point is in front
    // of the first, and none behind the second. O(points) for each edge.
    for (const Vector3& p : points_) {
      const Vector3 to = p - e.a, normal = along.cross(to);
      if (squared_norm3(normal) <= kParallelSineSq * squared_norm3(along) * size_sq_)
        continue;  // on the edge
      if (dot3(normals[0], to) > 0 || normals[0].isZero(0)) normals[0] = normal;
      if (dot3(normals[1], to) < 0 || normals[1].isZero(0)) normals[1] = normal;
    }
    return {normalized3(normals[0]), normalized3(normals[1])};
  }

  /// Depth of the target that is projected, in radii of the rim.
  static constexpr double kDepth = 8;
  static constexpr double kLeastGain = 1e-3;  ///< for another round, relative to the volume

  Mesh& mesh_;
  const std::vector<Vector3>& points_;
  std::vector<std::vector<std::array<VertexId, 2>>> rims_;  ///< (vertices) edges opposite in its faces
  double size_sq_;                                          ///< squared size of the points' box
  std::vector<Edge> rim_;
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace

Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth) {
  Mesh mesh = convex;
  // Fail if a step removes no face.
  for (std::size_t before = 0; mesh.face_count() > max_faces && mesh.face_count() != before;) {
    before = mesh.face_count();
    // Large steps while there are many faces, when tightening is expensive and gains little.
    const std::size_t step =
        before > kTightenFrom ? before - kTightenFrom : std::max<std::size_t>(2, before / kStepShare);
    const std::size_t wanted = std::max<std::size_t>(max_faces, before - step);
    // The points that must stay inside are always the input's, so that errors do not accumulate over the
    // steps.
    mesh = convex_hull_mesh(collapse_outward(mesh, convex.vertices, wanted, depth));
    // Tightening needs a convex start, and may leave a surface with dents.
    Tightening(mesh, convex.vertices).run(wanted == max_faces ? kLastRounds : kRounds);
    mesh = convex_hull_mesh(mesh.vertices);
  }
  return mesh.face_count() <= max_faces ? mesh : Mesh();
}

namespace {

/// Returns a number in [0, 1); the same sequence on every machine.
double fraction(Random& random) {
  return static_cast<double>(random.below(1u << 16)) * 0x1p-16;
}

/// Returns the points on the convex hull, and possibly some within `distance` of it. All other points are
/// within that distance of the hull of those returned. (A perturbation first moves the points into general
/// position, where Quickhull is fast.)
std::vector<Vector3> outermost(std::span<const Vector3> points, double distance) {
  // A fixed seed, so that the same points are kept on every machine.
  Random random(1);
  std::vector<Vector3> moved;
  for (const Vector3& p : points) {
    const double dx = fraction(random), dy = fraction(random), dz = fraction(random);
    // Shifts of two points differ by at most distance / 2 in each coordinate, that is by 0.87 distance.
    moved.push_back(p + distance / 2 * Vector3(dx, dy, dz));
  }
  std::vector<bool> used(points.size(), false);
  const auto hull = convex_hull(moved);
  // Keep the original points of the perturbed hull's vertices. Without a hull (coplanar points) keep all.
  for (const auto& t : hull)
    for (const std::uint32_t v : t) used[v] = true;
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (used[i] || hull.empty()) out.push_back(points[i]);
  return out;
}

/// Returns four points around each point: their hull contains every point with a clearance of at least a
/// quarter of `distance`, and they are in general position.
std::vector<Vector3> tetrahedra_about(std::span<const Vector3> points, double distance) {
  static const Vector3 kCorners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  Random random(1);
  std::vector<Vector3> out;
  // The regular tetrahedron has an inradius of 0.577 distance. The jitter reduces it by at most 0.173, and
  // the points that outermost() dropped by 0.125, so that more than a quarter remains.
  for (const Vector3& p : points)
    for (const Vector3& c : kCorners) {
      const double dx = fraction(random), dy = fraction(random), dz = fraction(random);
      out.push_back(p + distance * (c + 0.1 * Vector3(dx, dy, dz)));
    }
  return out;
}

/// Returns the box or, if its 12 triangles are too many, a prism of 8 triangles or a tetrahedron around it
/// with some of its planes: of 2 and 4.5 times its volume.
Mesh box_about(const Eigen::AlignedBox3d& box, std::uint32_t max_faces) {
  std::vector<Vector3> corners;
  if (max_faces < 12) {
    const bool prism = max_faces >= 8;
    corners = prism ? std::vector<Vector3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, {2, 0, 1}, {0, 2, 1}}
                    : std::vector<Vector3>{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    for (Vector3& c : corners) c = box.min() + c.cwiseProduct(box.sizes());
    return convex_hull_mesh(corners);
  }
  // Bits 0, 1 and 2 of a corner's index choose the upper end in x, y and z.
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? box.max().x() : box.min().x(), i & 2 ? box.max().y() : box.min().y(),
                         i & 4 ? box.max().z() : box.min().z());
  Mesh mesh;
  // Two triangles per side, counter-clockwise seen from outside.
  mesh.vertices = corners;
  for (const std::array<VertexId, 3>& t : std::array<std::array<VertexId, 3>, 12>{{{0, 2, 1},
                                                                                   {1, 2, 3},
                                                                                   {4, 5, 6},
                                                                                   {5, 7, 6},
                                                                                   {0, 1, 4},
                                                                                   {1, 5, 4},
                                                                                   {2, 6, 3},
                                                                                   {3, 6, 7},
                                                                                   {0, 4, 2},
                                                                                   {2, 4, 6},
                                                                                   {1, 3, 5},
                                                                                   {3, 7, 5}}})
    mesh.add_face(t);
  return mesh;
}

}  // namespace

double volume_of(const Mesh& mesh) {
  // Divergence theorem, relative to a vertex to limit cancellation.
  double sixfold = 0;
  const Vector3 origin = mesh.vertices[0];
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto c = mesh.face(f);
    sixfold += dot3(mesh.vertices[c[0]] - origin,
                    (mesh.vertices[c[1]] - origin).cross(mesh.vertices[c[2]] - origin));
  }
  return sixfold / 6;
}

bool holds(const Mesh& convex, const Vector3& point) {
  for (FaceId f = 0; f < convex.face_count(); ++f) {
    // Exact, so that rounding in the construction of the polytope cannot leave a point outside.
    const auto c = convex.face(f);
    const auto at = [&](int i) { return convex.vertices[c[i]].data(); };
    if (exact::orient3d(at(0), at(1), at(2), point.data()) >= 0) return false;
  }
  return true;
}

Mesh enclosing_polytope(std::span<const Vector3> points, std::uint32_t max_faces, double distance,
                        Workers& workers) {
  // The fallback, and the volume to improve on: the bounding box, grown by the distance.
  Eigen::AlignedBox3d box;
  for (const Vector3& p : points) box.extend(p);
  distance *= box.sizes().maxCoeff();
  box.min().array() -= distance;
  box.max().array() += distance;
  // Products of coordinates would overflow: no wrapper.
  if (!std::isfinite(box.volume() * box.volume())) return {};
  Mesh best = box_about(box, max_faces);
  // Steps 1 and 2.
  const Mesh convex = convex_hull_mesh(tetrahedra_about(outermost(points, distance / 8), distance));
  if (convex.face_count() == 0) return best;
  double least = volume_of(best);
  std::array<Mesh, 2> simplified;
  // Which depth yields the tighter polytope depends on the shape. Both are computed in parallel.
  workers.both([&] { simplified[0] = simplify_polytope(convex, max_faces, 2); },
               [&] { simplified[1] = simplify_polytope(convex, max_faces, 8); });
  // The order of this loop is fixed, so that the result does not depend on the number of threads.
  for (Mesh& polytope : simplified) {
    if (polytope.face_count() == 0 || volume_of(polytope) >= least) continue;
    if (!std::all_of(points.begin(), points.end(), [&](const Vector3& p) { return holds(polytope, p); }))
      continue;
    least = volume_of(polytope);
    best = std::move(polytope);
  }
  return best;
}

}  // namespace lrb::construct
