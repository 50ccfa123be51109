// Contact manifolds: known contacts, and the guarantees for all kinds of bodies.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/world_box.hpp>

using namespace lrb;
using Eigen::Vector3d;
using shapes::RandomEngine;

namespace {

using test::closed;

ManifoldRequest with_margin(double margin) {
  ManifoldRequest request;
  request.margin = margin;
  return request;
}

/// Returns the distance of a point from a feature of a body.
double distance_to_feature(const LrbRep& rep, const Pose& pose, const SurfaceFeatureId& f,
                           const Vector3d& p) {
  const auto at = [&](std::uint32_t v) { return pose.apply(rep.vertices()[v]); };
  if (f.kind == FeatureKind::vertex) return (p - at(f.first)).norm();
  if (f.kind == FeatureKind::edge) return test::point_segment(p, at(f.first), at(f.second));
  const test::Points s = test::simplex_points(rep, pose, SimplexId(f.first));
  if (s.size() == 2) return test::point_segment(p, s[0], s[1]);
  // A triangle without area is a segment.
  return std::min({test::point_triangle(p, s), test::point_segment(p, s[0], s[1]),
                   test::point_segment(p, s[1], s[2]), test::point_segment(p, s[2], s[0])});
}

double size_of(const LrbRep& rep, const Pose& pose) {
  const Eigen::AlignedBox3d box = world_box(rep, pose);
  return std::max(box.sizes().norm(),
                  box.corner(box.BottomLeftFloor).norm() + box.corner(box.TopRightCeil).norm());
}

struct ManifoldsSeen {
  int manifolds = 0, points = 0, deep = 0, gaps = 0;
};

/// Checks what holds for all bodies.
void check(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, double margin,
           ManifoldsSeen& seen) {
  CAPTURE(margin);
  const ManifoldResult r = contact_manifolds(a, pose_a, b, pose_b, with_margin(margin));
  NearPairsRequest request;
  request.within = margin;
  const NearPairsResult near = near_pairs(a, pose_a, b, pose_b, request);
  // All pairs, each in one manifold.
  REQUIRE(r.pairs.size() == near.pairs.size());
  std::vector<int> times(r.pairs.size(), 0);
  std::set<std::uint64_t> ids;
  std::set<std::uint32_t> meeting, overlapping;  // regions
  const double rounding = 1e-9 * std::max(size_of(a, pose_a), size_of(b, pose_b));
  for (const ContactManifold& m : r.manifolds) {
    bool intersects = false;
    for (const std::uint32_t i : m.pairs) {
      ++times[i];
      CHECK(r.pairs[i].a == near.pairs[i].a);
      CHECK(r.pairs[i].b == near.pairs[i].b);
      intersects = intersects || r.pairs[i].meet != exact::Meet::disjoint;
    }
    if (intersects) meeting.insert(m.region);
    if (m.points[0].depth > 0) overlapping.insert(m.region);
    CHECK(m.intersects == (intersects || m.points[0].depth > 0));
    CHECK(!m.points.empty());
    CHECK(m.points.size() <= (a.dim() == 3 ? 4 : 2));
    CHECK((m.normal.isZero() || std::abs(m.normal.norm() - 1) < 1e-12));
    CHECK(std::is_sorted(m.points.begin(), m.points.end(),
                         [](const ManifoldPoint& x, const ManifoldPoint& y) { return x.depth > y.depth; }));
    for (const ManifoldPoint& p : m.points) {
      ids.insert(p.id);
      // On both surfaces, and apart along the normal by the depth.
      CHECK(distance_to_feature(a, pose_a, p.on[0], p.point[0]) <= rounding);
      CHECK(distance_to_feature(b, pose_b, p.on[1], p.point[1]) <= rounding);
      CHECK((p.point[0] - p.point[1] - p.depth * m.normal).norm() <= rounding);
      CHECK(p.depth >= -margin - rounding);
      seen.deep += p.depth > rounding;
      seen.gaps += p.depth < -rounding;
      ++seen.points;
    }
    ++seen.manifolds;
  }
  CHECK(std::includes(meeting.begin(), meeting.end(), overlapping.begin(), overlapping.end()));
  for (const int n : times) CHECK(n == 1);
  CHECK(ids.size() == r.next_id);
}

/// A plate [-2, 2]^2 below z = 0, with n x n squares on top, moved up and down by `bump`.
Mesh fine_plate(int n, double bump = 0) {
  Mesh mesh = shapes::voxels(n, n, 1, [](int, int, int) { return true; });
  for (Vector3d& x : mesh.vertices) {
    const int i = static_cast<int>(x.x()), j = static_cast<int>(x.y());
    const double height = i % n == 0 || j % n == 0 ? 0 : bump * std::sin(1.3 * i) * std::cos(0.9 * j);
    x = {-2 + 4 * x.x() / n, -2 + 4 * x.y() / n, x.z() == 1 ? height : -0.5};
  }
  return mesh;
}

const Mesh kPlate = shapes::box({-2, -2, -0.5}, {2, 2, 0}),
           kBox = shapes::box({-0.5, -0.5, 0}, {0.5, 0.5, 1});

/// Checks that B's corners at the given locations are the only points, all of one manifold.
void check_corners(const ManifoldResult& r, std::vector<Vector3d> corners, const Vector3d& normal,
                   double depth) {
  CAPTURE(depth);
  REQUIRE(r.manifolds.size() == 1);
  const ContactManifold& m = r.manifolds[0];
  CHECK((m.normal - normal).norm() <= 1e-15);
  REQUIRE(m.points.size() == corners.size());
  for (const ManifoldPoint& p : m.points) {
    CHECK(p.on[1].kind == FeatureKind::vertex);
    CHECK(p.depth == doctest::Approx(depth).epsilon(1e-12));
    const auto nearest = std::min_element(corners.begin(), corners.end(), [&](const auto& x, const auto& y) {
      return (x - p.point[1]).norm() < (y - p.point[1]).norm();
    });
    REQUIRE(nearest != corners.end());
    CHECK((*nearest - p.point[1]).norm() < 1e-12);
    corners.erase(nearest);
  }
}

TEST_CASE("manifold of a box on a plate: its four corners, at any gap and depth, on coarse and fine plates") {
  const LrbRep box = closed(kBox), plates[] = {closed(kPlate), closed(fine_plate(40))};
  for (const LrbRep& plate : plates)
    for (const double depth : {0.125, 0.0078125, 0.0, -0.0078125})
      for (const double margin : {0.0, 0.015625}) {
        CAPTURE(depth);
        CAPTURE(margin);
        const ManifoldResult r =
            contact_manifolds(plate, {}, box, Pose::translation({0.1, 0.2, -depth}), with_margin(margin));
        if (-depth > margin) {
          CHECK(r.manifolds.empty());
          continue;
        }
        check_corners(r, {{-0.4, -0.3, -depth}, {0.6, -0.3, -depth}, {-0.4, 0.7, -depth}, {0.6, 0.7, -depth}},
                      {0, 0, 1}, depth);
        CHECK(r.manifolds[0].intersects == (depth >= 0));
      }
}

TEST_CASE("manifold of two crossing edges: their normal, and one point on each") {
  const LrbRep cube = closed(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const Pose pose_a = Pose::rotation({1, 0, 0}, std::numbers::pi / 4);
  for (const double angle : {0.0, 0.1, -0.2})
    for (const double depth : {0.01, -0.01}) {
      CAPTURE(angle);
      CAPTURE(depth);
      // B's lower edge is along y, turned by `angle` about z.
      Pose pose_b = Pose::rotation({0, 0, 1}, angle);
      pose_b.r = pose_b.r * Pose::rotation({0, 1, 0}, std::numbers::pi / 4).r;
      pose_b.t = {0.1, 0.05, std::sqrt(2.0) - depth};
      const ManifoldResult r = contact_manifolds(cube, pose_a, cube, pose_b, with_margin(0.02));
      REQUIRE(r.manifolds.size() == 1);
      CHECK((r.manifolds[0].normal - Vector3d(0, 0, 1)).norm() < 1e-12);
      const ManifoldPoint& p = r.manifolds[0].points[0];
      CHECK(p.depth == doctest::Approx(depth));
      CHECK(p.on[0].kind == FeatureKind::edge);
      CHECK(p.on[1].kind == FeatureKind::edge);
    }
}

TEST_CASE("manifolds: two regions that a third one connects are one region, in any order of faces") {
  // A rod through a plate, with a blind hole from above. The rod's wall connects its lower and upper curve of
  // intersection, and the plate connects the upper one with that of the hole.
  const Mesh rod =
      shapes::revolve({{0, -1}, {0.4, -1}, {0.4, -0.25}, {0.4, 0.5}, {0.2, 0.5}, {0.2, -0.1}, {0, -0.1}}, 24);
  const LrbRep plate = closed(fine_plate(40));
  const auto group_of = [&](FaceId f) {
    double radius = 0, low = 1;
    for (const VertexId v : rod.face(f)) {
      radius = std::max(radius, rod.vertices[v].head<2>().norm());
      low = std::min(low, rod.vertices[v].z());
    }
    return radius < 0.3 ? 0 : low > -0.5 ? 1 : 2;
  };
  std::array order{0, 1, 2};
  do {
    CAPTURE(order[0]);
    CAPTURE(order[1]);
    Mesh sorted;
    sorted.vertices = rod.vertices;
    for (const int group : order)
      for (FaceId f = 0; f < rod.face_count(); ++f)
        if (group_of(f) == group) sorted.add_face(rod.face(f));
    const ManifoldResult r =
        contact_manifolds(closed(sorted), Pose::translation({0.013, 0.017, 0}), plate, {}, with_margin(0));
    REQUIRE(!r.manifolds.empty());
    for (const ContactManifold& m : r.manifolds) CHECK(m.region == 0);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("manifold of overlapping corners: the axis of least depth alone, at any depth") {
  const LrbRep box = closed(shapes::box()), quads = closed(shapes::quad_box());
  for (const double depth : {0.25, 0.0625, 0.001})
    for (const double margin : {0.0, 0.002})
      for (const LrbRep* b : {&box, &quads}) {
        CAPTURE(depth);
        CAPTURE(margin);
        const ManifoldResult r =
            contact_manifolds(box, {}, *b, Pose::translation({1 - depth, 0.125, 0.25}), with_margin(margin));
        REQUIRE(r.manifolds.size() == 1);
        CHECK(r.manifolds[0].normal == Vector3d(1, 0, 0));
        CHECK(r.manifolds[0].points.size() == 4);
        for (const ManifoldPoint& p : r.manifolds[0].points) {
          CHECK(p.depth == doctest::Approx(depth));
          for (const Vector3d& x : p.point) {
            CHECK((x.y() == doctest::Approx(0.125) || x.y() == 1));
            CHECK((x.z() == doctest::Approx(0.25) || x.z() == 1));
          }
        }
      }
  // The far side of a ball is no other manifold.
  const ManifoldResult r =
      contact_manifolds(box, {}, closed(shapes::icosphere(0)), Pose::translation({-0.3125, -0.75, 0.0625}));
  REQUIRE(r.manifolds.size() == 1);
  CHECK((r.manifolds[0].normal - Vector3d(0, -1, 0)).norm() < 1e-12);
  CHECK(r.manifolds[0].points[0].depth == doctest::Approx(std::sqrt((5 + std::sqrt(5.0)) / 10) - 0.75));
}

TEST_CASE("manifolds have all pairs and points on both surfaces, for all kinds of bodies and poses") {
  RandomEngine random(1);
  const LrbRep bodies[] = {
      closed(shapes::quad_box()),
      closed(shapes::icosphere(2)),
      closed(shapes::torus(12, 8)),
      closed(shapes::box_with_void(), 0.3),
      closed(hard::cog(12)),
      closed(hard::nested(3)),
      test::open_body(shapes::open_cylinder(8)),
      LrbRep::without_regions(
          shapes::several({shapes::quad_box(), shapes::translated(shapes::quad_box(), {0.5, 0.25, 0.125})}),
          true, true)};
  ManifoldsSeen seen;
  for (const LrbRep& a : bodies)
    for (const LrbRep& b : bodies)
      for (int round = 0; round < 5; ++round) {
        CAPTURE(a.real_face_count());
        CAPTURE(b.real_face_count());
        CAPTURE(round);
        const Pose pose_a{shapes::random_rotation(random), 3 * shapes::random_direction(random)};
        Pose pose_b{shapes::random_rotation(random),
                    pose_a.t + shapes::uniform(random, 0, 2.5) * shapes::random_direction(random)};
        if (round == 3) pose_b.r *= 0.5;
        if (round == 4) pose_b.r.col(1) *= -1;  // mirrored
        const double margins[] = {0, 0.02, 0.1, 0.05, 0};
        check(a, pose_a, b, pose_b, margins[round], seen);
      }
  check(bodies[1], {}, bodies[1], {}, 0, seen);  // identical
  // Three normals, one of them of pairs that do not intersect.
  check(bodies[0], {}, bodies[0], Pose::translation({0.9, 0.8, 0.7}), 0.5, seen);
  // Gaps of a few roundings have no depth above 0.
  const LrbRep plate = closed(kPlate), box = closed(kBox);
  for (int i = 0; i < 60; ++i) {
    const Pose at{shapes::random_rotation(random), 3 * shapes::random_direction(random)};
    check(plate, at, box, {at.r, at.apply({0.1, 0.2, shapes::uniform(random, 0, 4e-15)})}, 1e-12, seen);
  }
  CHECK(seen.manifolds > 300);
  CHECK(seen.deep > 300);
  CHECK(seen.gaps > 100);
}

namespace {

/// Contacts of small sets of triangles (every fourth: segments in the plane) on a grid.
ManifoldsSeen check_manifold_grids(int queries) {
  RandomEngine random(7);
  ManifoldsSeen seen;
  for (int i = 0; i < queries; ++i) {
    CAPTURE(i);
    const int dim = i % 4 == 0 ? 2 : 3;
    const LrbRep a = test::open_body(test::grid_soup(random, 3, dim, i % 2 * 5)),
                 b = test::open_body(test::grid_soup(random, 3, dim));
    const double margin = std::sqrt(std::floor(shapes::uniform(random, 0, 4)));
    check(a, {}, b, Pose::translation({std::floor(shapes::uniform(random, 0, 4)), 0, 0}), margin, seen);
  }
  return seen;
}

}  // namespace

TEST_CASE("manifolds of triangles on a grid") {
  CHECK(check_manifold_grids(500).manifolds > 250);
}

TEST_CASE("manifolds of 100,000 pairs of sets of triangles on a grid" * doctest::test_suite("long")) {
  CHECK(check_manifold_grids(100'000).manifolds > 50'000);
}

TEST_CASE("manifolds of bodies in the plane and of degenerate faces") {
  RandomEngine random(2);
  ManifoldsSeen seen;
  test::for_flat_and_loose(random, 9, [&](const LrbRep& a, const LrbRep& b, const Pose& pose, int i) {
    const double flat[] = {0, 0.05, 0.5}, loose[] = {0, 0.1, 0.5};
    check(a, {}, b, pose, a.dim() == 2 ? flat[i] : loose[i / 3], seen);
  });
  CHECK(seen.points > 30);
  const ManifoldResult square = contact_manifolds(
      closed(shapes::polygon({{-2, -1}, {2, -1}, {2, 0}, {-2, 0}})), {},
      closed(shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}})), Pose::translation({0, -0.25, 0}));
  check_corners(square, {{0, -0.25, 0}, {1, -0.25, 0}}, {0, 1, 0}, 0.25);
}

TEST_CASE("no points of a manifold's faces along its normal are deeper than its first point") {
  RandomEngine random(3);
  const LrbRep bodies[] = {closed(kBox), closed(shapes::icosphere(1)), closed(fine_plate(6, 0.05))};
  int compared = 0;
  for (const LrbRep& a : bodies)
    for (const LrbRep& b : bodies)
      for (int round = 0; round < 4; ++round) {
        const Pose pose_b{shapes::random_rotation(random), 1.5 * shapes::random_direction(random)};
        const ManifoldResult r = contact_manifolds(a, {}, b, pose_b, with_margin(0.05));
        for (const ContactManifold& m : r.manifolds) {
          if (m.normal.isZero()) continue;
          for (const std::uint32_t i : m.pairs) {
            const test::Points s = test::simplex_points(a, {}, r.pairs[i].a),
                               t = test::simplex_points(b, pose_b, r.pairs[i].b);
            const Vector3d n = (s[1] - s[0]).cross(s[2] - s[0]).normalized();
            const Vector3d of_b = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
            if (n.dot(m.normal) < 0.31 || of_b.dot(m.normal) > -0.31) continue;
            for (int k = 0; k < 20; ++k) {
              const Vector3d x = test::random_point_of(random, t);
              const double depth = n.dot(s[0] - x) / n.dot(m.normal);
              if (test::point_triangle(x + depth * m.normal, s) > 1e-12) continue;
              // Deep points on parts of the surface that only seem to overlap are left out.
              if (depth > 0.5) continue;
              CHECK(depth <= m.points[0].depth + 1e-9);
              ++compared;
            }
          }
        }
      }
  CHECK(compared > 1000);
}

using Ids = std::set<std::uint64_t>;

Ids ids_of(const ManifoldResult& r) {
  Ids ids;
  for (const ContactManifold& m : r.manifolds)
    for (const ManifoldPoint& p : m.points) ids.insert(p.id);
  return ids;
}

TEST_CASE("ids of manifold points persist while bodies rock, sink, rise and slide") {
  const LrbRep plate = closed(fine_plate(40)), box = closed(kBox);
  RandomEngine random(4);
  ManifoldResult r, exchanged;
  for (int step = 0; step < 60; ++step) {
    const Vector3d axis = shapes::random_direction(random);
    // Points move farther on the plate than what keeps their ids, but not on the box.
    const Pose pose =
        Pose::rotation(axis, 1e-5, {0.1 + 0.05 * (step % 13), 0.2, 1e-4 * std::sin(0.5 * step)});
    exchanged = contact_manifolds(box, pose, plate, {}, with_margin(0.01), step > 0 ? &exchanged : nullptr);
    CHECK(ids_of(exchanged) == Ids{0, 1, 2, 3});
    r = contact_manifolds(plate, {}, box, pose, with_margin(0.01), step > 0 ? &r : nullptr);
    CHECK(ids_of(r) == Ids{0, 1, 2, 3});
  }
  // Bodies that move together.
  const Pose both = Pose::rotation({1, 2, 3}, 1.1, {5, -7, 2});
  const ManifoldResult moved = contact_manifolds(
      plate, both, box, {both.r * r.pose[1].r, both.apply(r.pose[1].t)}, with_margin(0.01), &r);
  CHECK(ids_of(moved) == ids_of(r));
  // The normal is that of the plate or of the box, which rocks by 1e-5.
  CHECK((moved.manifolds[0].normal - both.r * r.manifolds[0].normal).norm() < 1.1e-5);
  // On its other side, other corners are in contact.
  const ManifoldResult over = contact_manifolds(
      plate, {}, box, Pose::rotation({1, 0, 0}, std::numbers::pi, {0, 0, 1}), with_margin(0.01), &r);
  CHECK(ids_of(over) == Ids{4, 5, 6, 7});
  // No contact, and the ids are not used again.
  const ManifoldResult none = contact_manifolds(plate, {}, box, Pose::translation({0, 0, 1}), {}, &over);
  CHECK(none.manifolds.empty());
  CHECK(ids_of(contact_manifolds(plate, {}, box, {}, {}, &none)) == Ids{8, 9, 10, 11});
}

}  // namespace
