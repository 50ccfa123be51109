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
#include <lrbscope/trace/answer_fields.hpp>

namespace lrb::python {

namespace {

struct NearPairs : NearPairsResult {
  std::vector<std::array<FaceId, 2>> faces;
};
void members(Archive& archive, NearPairs& x) {
  archive(static_cast<NearPairsNumbers&>(x), x.pairs, x.counters, x.faces);
}

NearPairs near_pairs(const Given& given) {
  const TwoBodies two(given);
  const Argument within = given["within"];
  if (within.is_none()) throw InputError("within: expected a finite number of at least 0, got None");
  NearPairsRequest request;
  request.within = size(within);
  request.nearest = count(given["nearest"]);
  request.max_pairs = count(given["max_pairs"]);
  const unsigned threads = threads_of(given);
  const py::gil_scoped_release unlocked;
  NearPairs found{lrb::near_pairs(two.a.rep(), two.pose_a, two.b.rep(), two.pose_b(), request, threads), {}};
  for (const NearPair& pair : found.pairs)
    found.faces.push_back({two.a.rep().face_of_simplex(pair.a), two.b.rep().face_of_simplex(pair.b)});
  return found;
}

void bind_near_pairs(py::module_& m) {
  py::class_<NearPairs> c(
      m, "NearPairs",
      R"(Pairs of triangles (2D: segments) within a distance: arrays with a row for each pair. Made by near_pairs().)");
  const auto of_pair = rows_of(c, "pairs", &NearPairs::pairs);
  for (const auto& n : NearPairsNumbers::kShown)
    property(c, n.name, (std::string("int: ") + n.meaning + ".").c_str(), n.member);
  of_pair("triangles", "(n, 2) uint32: a triangle of A and one of B.", kPairOf);
  property(c, "faces", "(n, 2) uint32: the faces of these triangles.", &NearPairs::faces);
  of_pair("meet", "(n,) uint8: 0 disjoint, 1 touch, 2 cross.", &NearPair::meet);
  of_pair("lower", "(n,) float64: lower ends of the distances; 0 for pairs that intersect.",
          &NearPair::lower);
  of_pair("upper", "(n,) float64: upper ends.", &NearPair::upper);
  of_pair("points",
          "(n, 2, 3) float64: the closest points of A and of B, world frame; equal if the pair intersects.",
          &NearPair::point);
  property(c, "counters", kCountersText, [](const NearPairs& p) { return dict_of(p.counters); });
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

Manifolds contact_manifolds(const Given& given) {
  const TwoBodies two(given);
  ManifoldRequest request;
  request.margin = size(given["margin"]);
  const Argument previous = given["previous"];
  if (!previous.is_none() && !py::isinstance<Manifolds>(previous.given))
    throw InputError("previous: expected the Manifolds of the previous step or None, got " +
                     described(previous.given));
  const ManifoldResult* const before =
      previous.is_none() ? nullptr : &previous.given.cast<const Manifolds&>();
  request.max_pairs = count(given["max_pairs"]);
  const unsigned threads = threads_of(given);
  const py::gil_scoped_release unlocked;
  Manifolds found{
      lrb::contact_manifolds(two.a.rep(), two.pose_a, two.b.rep(), two.pose_b(), request, before, threads),
      {},
      {}};
  found.list_points();
  return found;
}

void bind_contact_manifolds(py::module_& m) {
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

SelfIntersections self_intersections(const Given& given) {
  const Body& of = body(given["body"]);
  const std::uint64_t most = count(given["max_pairs"]);
  const unsigned threads = threads_of(given);
  const py::gil_scoped_release unlocked;
  return lrb::self_intersections(of.rep(), threads, most > 0 ? most : kMaxSelfIntersections);
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

using PointDistances = Sequence<PointDistance>;

PointDistances signed_distance(const Given& given) {
  const Body& of = body(given["body"]);
  const std::vector<Eigen::Vector3d> all = points(given["points"], of.rep().dim());
  const Pose placed = pose(given["pose"]);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!all[i].allFinite())
      throw InputError("points: point " + std::to_string(i) + " is not finite; expected finite coordinates");
  PointDistanceRequest request;
  request.tolerance = size(given["tolerance"]);
  request.relative_tolerance = size(given["relative_tolerance"]);
  PointDistances found;
  found.all.resize(all.size());
  // Batches, because Ctrl-C is noticed between two of them.
  constexpr std::size_t kBatch = 256;
  run_batch((all.size() + kBatch - 1) / kBatch, threads_of(given), [&](std::size_t i, unsigned) {
    const auto batch = std::span(all).subspan(i * kBatch, std::min(kBatch, all.size() - i * kBatch));
    const std::vector<PointDistance> of_batch = point_distances(of.rep(), placed, batch, request, 1);
    std::copy(of_batch.begin(), of_batch.end(), found.all.begin() + static_cast<std::ptrdiff_t>(i * kBatch));
  });
  return found;
}

void bind_signed_distance(py::module_& m) {
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

}  // namespace

void bind_rows(py::module_& m) {
  bind_near_pairs(m);
  bind_contact_manifolds(m);
  bind_self_intersections(m);
  bind_signed_distance(m);
}

}  // namespace lrb::python
