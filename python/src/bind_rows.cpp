// Near pairs, contact manifolds, self-intersections and distances of points: answers with a row for each pair
// or point.
#include <algorithm>
#include <vector>

#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb::python {

void members(Archive& archive, ContactManifold& x) {
  archive(x.normal, x.points, x.pairs, x.region, x.intersects);
}

namespace {

struct NearPairs : NearPairsResult {
  std::vector<std::array<FaceId, 2>> faces;
};
void members(Archive& archive, NearPairs& x) {
  archive(x.pairs, x.found, x.counters, x.faces);
}

py::object near_pairs(py::handle a, py::handle b, py::handle pose_b, py::handle pose_a, py::handle within,
                      py::handle nearest, py::handle max_pairs, py::handle threads) {
  const Body &body_a = body(a, "a"), &body_b = body(b, "b");
  const Pose at_a = pose(pose_a, "pose_a"), at_b = pose(pose_b, "pose_b");
  if (within.is_none()) throw InputError("within: expected a finite number of at least 0, got None");
  NearPairsRequest request;
  request.within = size(within, "within");
  request.nearest = count(nearest, "nearest");
  request.max_pairs = count(max_pairs, "max_pairs");
  const unsigned n = threads_of(count(threads, "threads"));
  NearPairs found;
  {
    const py::gil_scoped_release unlocked;
    static_cast<NearPairsResult&>(found) =
        lrb::near_pairs(body_a.rep(), at_a, body_b.rep(), at_b, request, n);
  }
  for (const NearPair& pair : found.pairs)
    found.faces.push_back({body_a.rep().face_of_simplex(pair.a), body_b.rep().face_of_simplex(pair.b)});
  return py::cast(std::move(found));
}

void bind_near_pairs_result(py::module_& m) {
  py::class_<NearPairs> c(
      m, "NearPairs",
      R"(Pairs of triangles (2D: segments) within a distance: arrays with a row for each pair. Made by near_pairs().)");
  const auto of_pair = rows_of(c, "pairs", &NearPairs::pairs);
  property(c, "found",
           "int: number of all pairs within the distance; more than len() if `nearest` was given.",
           &NearPairs::found);
  of_pair("triangles", "(n, 2) uint32: a triangle of A and one of B.", kPairOf);
  property(c, "faces", "(n, 2) uint32: the faces of these triangles.", &NearPairs::faces);
  of_pair("meet", "(n,) uint8: 0 disjoint, 1 touch, 2 cross.", &NearPair::meet);
  of_pair("lower", "(n,) float64: lower ends of the distances; 0 for pairs that intersect.",
          &NearPair::lower);
  of_pair("upper", "(n,) float64: upper ends.", &NearPair::upper);
  of_pair("points",
          "(n, 2, 3) float64: the closest points of A and of B, world frame; equal if the pair intersects.",
          &NearPair::point);
  property(c, "counters", kCountersText, [](const NearPairs& p) {
    return dict_of(p.counters, {"node_pairs", "box_tests", "candidates", "pairs_exact"});
  });
}

}  // namespace

void bind_near_pairs(py::module_& m) {
  bind_near_pairs_result(m);
  define(m, R"(near_pairs(a, b, pose_b=None, pose_a=None, *, within, nearest=0, max_pairs=0, threads=0)

Finds all pairs of triangles (2D: segments) whose distance is at most `within`, exactly.

pose_b, pose_a: (4, 4). None: the identity. within: the world's unit; 0: the pairs that intersect.
nearest: return only this many pairs, in ascending order of the lower ends of their distances; 0: all, in
ascending order of their triangles. max_pairs: a query that finds more is an InputError; 0: 33554432.

Returns NearPairs.

>>> pairs = near_pairs(cube, cube, shifted(3, 0, 0), within=2)
>>> len(pairs), float(pairs.upper.max()), pairs.points[0, :, 0].tolist()
(62, 2.0, [1.0, 3.0]))",
         &near_pairs);
}

namespace {

struct Manifolds : ManifoldResult {
  std::vector<const ManifoldPoint*> points;
  std::vector<std::uint32_t> manifold_of;  ///< (|points|)

  /// Lists the points. Vectors keep their memory when the result is moved.
  void list_points() {
    for (std::uint32_t m = 0; m < manifolds.size(); ++m)
      for (const ManifoldPoint& point : manifolds[m].points) {
        points.push_back(&point);
        manifold_of.push_back(m);
      }
  }
};
void members(Archive& archive, Manifolds& x) {
  archive(x.pairs, x.manifolds, x.pose, x.next_id);
  if (archive.reads()) x.list_points();
}

py::object contact_manifolds(py::handle a, py::handle b, py::handle pose_b, py::handle pose_a,
                             py::handle margin, py::handle previous, py::handle max_pairs,
                             py::handle threads) {
  const Body &body_a = body(a, "a"), &body_b = body(b, "b");
  const Pose at_a = pose(pose_a, "pose_a"), at_b = pose(pose_b, "pose_b");
  ManifoldRequest request;
  request.margin = size(margin, "margin");
  request.max_pairs = count(max_pairs, "max_pairs");
  const unsigned n = threads_of(count(threads, "threads"));
  const ManifoldResult* before = nullptr;
  if (!previous.is_none()) {
    if (!py::isinstance<Manifolds>(previous))
      throw InputError("previous: expected the Manifolds of the previous step or None, got " +
                       described(previous));
    before = &previous.cast<const Manifolds&>();
  }
  Manifolds found;
  {
    const py::gil_scoped_release unlocked;
    static_cast<ManifoldResult&>(found) =
        lrb::contact_manifolds(body_a.rep(), at_a, body_b.rep(), at_b, request, before, n);
  }
  found.list_points();
  return py::cast(std::move(found));
}

void bind_contact_manifolds_result(py::module_& m) {
  py::class_<Manifolds> c(
      m, "Manifolds",
      R"(Contact manifolds: arrays with a row for each manifold, point or pair. Made by contact_manifolds().)");
  const auto of_point = columns_of(c, &Manifolds::points);
  const auto of_manifold = rows_of(c, "manifolds", &Manifolds::manifolds);
  of_manifold("normals",
              "(m, 3) float64: unit vectors from A to B; zero if no face of the region has an area.",
              &ContactManifold::normal);
  of_manifold("regions", "(m,) uint32: the connected region of each manifold.", &ContactManifold::region);
  of_manifold("intersects",
              "(m,) bool: a pair intersects or a depth is above 0; otherwise all contacts are speculative.",
              &ContactManifold::intersects);
  property(c, "manifold",
           "(k,) uint32: the manifold of each point, ascending; the deepest point of each comes first.",
           &Manifolds::manifold_of);
  of_point("points", "(k, 2, 3) float64: on A and on B, world frame.", &ManifoldPoint::point);
  of_point("depths", "(k,) float64: along the normal; positive if the surfaces overlap, negative for a gap.",
           &ManifoldPoint::depth);
  of_point("ids", "(k,) uint64: a point that continues one of the previous answer keeps its id.",
           &ManifoldPoint::id);
  of_point(
      "features",
      "(k, 2, 3) uint32: features of A and of B. 0, v, v: a vertex; 1, v, w: an edge; 2, t, t: a triangle.",
      [](const ManifoldPoint* p) {
        const auto row = [](const SurfaceFeatureId& f) {
          return std::array{static_cast<std::uint32_t>(f.kind), f.first, f.second};
        };
        return std::array{row(p->on[0]), row(p->on[1])};
      });
  property(c, "triangles",
           "(p, 2) uint32: all pairs of triangles that intersect or are at most `margin` apart.",
           [](const Manifolds& x) { return column(x.pairs, kPairOf); });
  property(c, "pairs",
           "list of (q,) uint32: the rows of `triangles` of each manifold; each row is in one of them.",
           [](const Manifolds& x) {
             py::list out;
             for (const ContactManifold& each : x.manifolds) out.append(column(each.pairs, std::identity()));
             return out;
           });
}

}  // namespace

void bind_contact_manifolds(py::module_& m) {
  bind_contact_manifolds_result(m);
  define(
      m,
      R"(contact_manifolds(a, b, pose_b=None, pose_a=None, *, margin=0, previous=None, max_pairs=0, threads=0)

Finds a normal and at most 4 points (2D: 2) with depths for each region of contact, for a solver.

pose_b, pose_a: (4, 4). None: the identity. margin: maximum distance of speculative contacts, pairs that do
not intersect; the world's unit. previous: the Manifolds of the previous step; points that continue its
points keep their ids. max_pairs: a query that finds more pairs is an InputError; 0: 2097152.

Returns Manifolds.

>>> m = contact_manifolds(cube, cube, shifted(0, 0, 0.875))
>>> len(m), m.normals[0].tolist(), m.depths.tolist()
(1, [0.0, 0.0, 1.0], [0.125, 0.125, 0.125, 0.125]))",
      &contact_manifolds);
}

namespace {

py::object self_intersections(py::handle of, py::handle max_pairs, py::handle threads) {
  const Body& given = body(of, "body");
  const std::uint64_t most = count(max_pairs, "max_pairs");
  const unsigned n = threads_of(count(threads, "threads"));
  SelfIntersections found;
  {
    const py::gil_scoped_release unlocked;
    found = lrb::self_intersections(given.rep(), n, most > 0 ? most : kMaxSelfIntersections);
  }
  return py::cast(std::move(found));
}

}  // namespace

void members(Archive& archive, SelfIntersections& x) {
  archive(x.pairs, x.segments, x.curves);
}

void bind_self_intersections(py::module_& m) {
  py::class_<SelfIntersections> c(m, "SelfIntersections",
                                  "Pairs of faces in which a body intersects itself: arrays with a row for "
                                  "each pair. Made by self_intersections().");
  const auto of_pair = rows_of(c, "pairs", &SelfIntersections::pairs);
  of_pair("faces", "(n, 2) uint32: the faces, ascending.", kPairOf);
  of_pair("kind", "(n,) uint8: 0 touch, 1 cross, 2 overlap in an area of one plane.",
          &SelfIntersection::kind);
  of_pair("shared", "(n,) uint32: number of corners in common.", &SelfIntersection::shared);
  of_pair("curve", "(n,) uint32: connected component of the segments.", &SelfIntersection::curve);
  of_pair("first_segment", "(n,) uint32: index of the pair's first segment in `segments`.",
          &SelfIntersection::first_segment);
  of_pair("segment_counts", "(n,) uint32: number of the pair's segments.", &SelfIntersection::segments);
  property(c, "segments",
           "(m, 2, 3) float64: ends of the segments of all pairs, body frame; equal for points.",
           &SelfIntersections::segments);
  property(c, "curves", "int: number of connected components of the segments.", &SelfIntersections::curves);
  define(m, R"(self_intersections(body, *, max_pairs=0, threads=0)

Finds all pairs of faces of a body that intersect beyond the corners and edges that they share, exactly.

max_pairs: a body with more is an InputError; 0: 16777216.

Returns SelfIntersections.

>>> len(self_intersections(cube))
0)",
         &self_intersections);
}

namespace {

using PointDistances = Sequence<PointDistance>;

py::object signed_distance(py::handle of, py::handle points, py::handle at, py::handle tolerance,
                           py::handle relative_tolerance, py::handle threads) {
  const Body& given = body(of, "body");
  const Pose placed = pose(at, "pose");
  const std::vector<Eigen::Vector3d> all = python::points(points, "points", given.rep().dim());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!all[i].allFinite())
      throw InputError("points: point " + std::to_string(i) + " is not finite; expected finite coordinates");
  PointDistanceRequest request;
  request.tolerance = size(tolerance, "tolerance");
  request.relative_tolerance = size(relative_tolerance, "relative_tolerance");
  PointDistances found;
  found.all.resize(all.size());
  // Batches, because Ctrl-C is noticed between two of them.
  constexpr std::size_t kBatch = 256;
  run_batch(
      (all.size() + kBatch - 1) / kBatch, threads_of(count(threads, "threads")),
      [&](std::size_t i, unsigned) {
        const auto batch = std::span(all).subspan(i * kBatch, std::min(kBatch, all.size() - i * kBatch));
        const std::vector<PointDistance> of_batch = point_distances(given.rep(), placed, batch, request, 1);
        std::copy(of_batch.begin(), of_batch.end(),
                  found.all.begin() + static_cast<std::ptrdiff_t>(i * kBatch));
      });
  return py::cast(std::move(found));
}

void bind_point_distances(py::module_& m) {
  py::class_<PointDistances> c(
      m, "PointDistances",
      R"(Signed distances of n points to a body, as proven intervals. Made by signed_distance().)");
  const auto of_point = rows_of(c, "points", &PointDistances::all);
  of_point("lower", "(n,) float64: lower ends of the signed distances; negative inside.",
           &PointDistance::signed_lower);
  of_point("upper", "(n,) float64: upper ends.", &PointDistance::signed_upper);
  of_point("side",
           "(n,) int8: -1 inside, 0 on the surface, 1 outside; 2 unknown, because the body is not closed.",
           [](const PointDistance& p) -> std::int8_t {
             if (!p.side) return 2;
             return p.side == Where::inside ? -1 : p.side == Where::outside ? 1 : 0;
           });
  of_point("points", "(n, 3) float64: the closest points of the surface, world frame.",
           [](const PointDistance& p) { return p.closest.point; });
  of_point("faces", "(n,) uint32: the faces of these points; 4294967295 for a body without faces.",
           [](const PointDistance& p) { return p.closest.face; });
}

}  // namespace

void bind_signed_distance(py::module_& m) {
  bind_point_distances(m);
  define(m, R"(signed_distance(body, points, pose=None, *, tolerance=0, relative_tolerance=0, threads=0)

Finds the signed distance of points to the surface of a body, as proven intervals, negative inside.

points: (n, 3) float, world frame; (n, 2) for a body in 2D. pose: (4, 4), of the body; None: the identity.
tolerance (the world's unit), relative_tolerance: maximum width of the intervals. 0, 0: about 1e-12 of the
body's size. A point is inside if a ray from it crosses the surface an odd number of times; a body that is not
closed has no inside.

Returns PointDistances.

>>> d = signed_distance(cube, [[0.5, 0.5, 0.75], [2, 0.5, 0.5]])
>>> d.side.tolist(), d.upper.round(9).tolist()
([-1, 1], [-0.25, 1.0]))",
         &signed_distance);
}

}  // namespace lrb::python
