// Shapes that users of other libraries reported, and of faults found here: polygons that are not convex;
// flaps without thickness; bodies of very different sizes; subnormal coordinates; axes of any length.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/lrb_files.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::reported {
namespace {

using Eigen::Vector3d;
using shapes::box;
using test::closed;

/// Checks that an interval contains a value, and is not wider than this share of it.
void check_interval(double lower, double upper, double value, double width = 1e-8) {
  CHECK(lower <= value * (1 + 1e-12));
  CHECK(upper >= value * (1 - 1e-12));
  CHECK(upper - lower <= width * value);
}

/// Checks the U profile and a peg in its opening, 1 away from each wall.
void check_u(const LrbRep& u) {
  const LrbRep peg = closed(box({2, 2, -1}, {3, 3, 2}));
  CHECK(u.closed());
  const CollideResult r = collide(u, Pose{}, peg, Pose{});
  CHECK(r.relation == Relation::separate);
  CHECK(r.pairs.empty());
  const DistanceResult d = distance(u, Pose{}, peg, Pose{});
  check_interval(d.lower, d.upper, 1);
  CHECK(clash(u, Pose{}, peg, Pose{}).kind == ClashKind::apart);
  const Vector3d points[] = {{2.5, 2.5, 0.5}, {0.5, 2, 0.5}};
  const auto distances = point_distances(u, Pose{}, points);
  check_interval(distances[0].signed_lower(), distances[0].signed_upper(), 1.5);
  check_interval(-distances[1].signed_upper(), -distances[1].signed_lower(), 0.5);
  const ClashResult in = clash(u, Pose{}, peg, Pose::translation({1.5, 0, 0}));  // half of the peg in a wall
  CHECK(in.kind == ClashKind::protrudes);
  check_interval(in.volume->lower, in.volume->upper, 0.5);
}

Body body_of(const Mesh& mesh) {
  Expected<Body> body = Body::from(mesh);
  REQUIRE(body);
  return *body;
}

}  // namespace

TEST_CASE("concave polygons cover their outline, from whatever corner and door") {
  for (int first = 0; first < 8; ++first) check_u(closed(test::u_profile(first)));
  const Mesh u = test::u_profile();
  for (const Mesh& mesh : {u, read_mesh(test::to_off(u), "u.off"), read_mesh(test::to_ply_ascii(u), "u.ply"),
                           shapes::turned_inside_out(u)}) {
    const Body body = body_of(mesh);
    CHECK(body.has_regions());
    CHECK(validate(body.rep()).valid);
    check_u(body);
    check_u(load_lrb(test::lrb_bytes(body.rep()), "u.lrb"));
  }
}

TEST_CASE("an outline with a bridge to a hole is a plate with a hole") {
  const MeshReport report = check_mesh(test::plate_with_hole());
  CHECK(report.genus == 1);
  CHECK(report[MeshFault::repeated_corner].count == 0);
  CHECK(report[MeshFault::self_intersection].count == 0);
  const Body plate = body_of(test::plate_with_hole());
  CHECK(plate.notes().empty());
  CHECK(validate(plate.rep()).valid);
  const LrbRep pin = closed(box({2.5, 2.5, -1}, {3.5, 3.5, 2}));
  const DistanceResult d = distance(plate, Pose{}, pin, Pose{});
  check_interval(d.lower, d.upper, 0.5);
  CHECK(collide(plate, Pose{}, pin, Pose::translation({1, 0, 0})).relation == Relation::crossing);
}

TEST_CASE("polygons without triangles that cover them are fans, with a note") {
  std::vector<Eigen::Vector2d> pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.push_back({std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i)});
  Mesh folded;
  test::add_loose(folded, {{0, 4, 0}, {0, 0, 3}, {4, 0, 0}, {1, 1, 3}});
  for (const Mesh& mesh : {test::prism(pentagram), folded}) {
    const Body body = body_of(mesh), again = Body::from(load_lrb(test::lrb_bytes(body.rep()), "m.lrb"));
    for (const Body& b : {body, again})
      CHECK(b.notes()[0].find("crosses itself or is far from planar") != std::string::npos);
  }
}

TEST_CASE("a file of a version that took concave polygons as fans has the right shape, without its regions") {
  std::string bytes = test::lrb_bytes(body_of(test::u_profile()).rep());
  REQUIRE(bytes[test::kVersionAt] == 4);
  bytes[test::kVersionAt] = 3;
  const LrbRep old = load_lrb(test::with_right_checksum(bytes), "old.lrb");
  CHECK(old.region_count() == 0);
  check_u(old);
  CHECK(Body::from(old).notes()[0].find("took concave polygons as fans") != std::string::npos);
  // Other bodies have the same bytes as in that version.
  CHECK(test::lrb_bytes(build_lrb(box()))[test::kVersionAt] == 3);
}

TEST_CASE("flaps without thickness are no interior") {
  // A cube with a separate pair of coincident faces, and a plate of thickness 0 as a closed box.
  const Mesh pillow = test::with_face(test::with_face(box(), {{3, -1, 0}, {6, -1, 0}, {3, 3, 0}}, {8, 9, 10}),
                                      {}, {10, 9, 8});
  const LrbRep peg = closed(box({3.5, -0.5, -1}, {4, 0, 1}));
  for (const Mesh& mesh : {pillow, box({3, -1, 0}, {7, 3, 0})})
    for (const bool swapped : {false, true}) {
      const LrbRep flap = closed(mesh);
      const ClashResult r = clash(swapped ? peg : flap, Pose{}, swapped ? flap : peg, Pose{});
      CHECK((r.kind == ClashKind::touching_edge || r.kind == ClashKind::undecided));
      if (r.kind == ClashKind::undecided) continue;
      CHECK(r.interiors_overlap == Answer::no);
      CHECK(r.depth->upper == 0);
      CHECK(r.volume->upper == 0);
    }
  // Two cubes side by side in one body: their common faces are no flap.
  const LrbRep two = closed(shapes::several({box(), box({1, 0, 0}, {2, 1, 1})}));
  const ClashResult r = clash(two, Pose{}, closed(box({0.75, 0.25, 0.25}, {1.25, 0.75, 0.75})), Pose{});
  CHECK(r.interiors_overlap == Answer::yes);
  check_interval(r.volume->lower, r.volume->upper, 0.125);
  CHECK(r.depth->lower > 0.7);
}

TEST_CASE("volume and depth of an overlap are as precise as the overlap is large") {
  // 1 cm in a block of 20 km: partly, entirely, and by 8 um; a column 8 um deep in a slab of 200 m.
  const auto check = [](const Mesh& a, double size, const Mesh& b, double depth, double volume) {
    for (const bool swapped : {false, true}) {
      const LrbRep small = closed(b);
      const ClashResult r = clash(swapped ? small : closed(a), Pose{}, swapped ? closed(a) : small, Pose{});
      check_interval(r.volume->lower, r.volume->upper, volume, 0.01);
      check_interval(r.depth->lower, r.depth->upper, depth, 0.01);
      CHECK(r.depth->upper - r.depth->lower <= 1e-12 * size);
    }
  };
  constexpr double kDeep = 0x1p-17, kEdge = 0x1p-7;
  const Mesh block = box({-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4});
  for (const double inside : {kEdge / 2, kDeep, 1.0})
    check(block, 2e4, box({1e4 - inside, 3, 5}, {1e4 - inside + kEdge, 3 + kEdge, 5 + kEdge}), inside,
          std::min(inside, kEdge) * kEdge * kEdge);
  // Corners are rounded in the frame of both.
  for (const double y : {1 / 3.0, 100 / 7.0}) {
    const double x = 1e4 - 1e-3, wide = y + kEdge - y;
    const LrbRep beam = closed(box({x, y, y}, {1e4 + 1e3 / 3, y + kEdge, y + kEdge}));
    const auto volume = clash(closed(block), Pose{}, beam, Pose{}).volume;
    check_interval(volume->lower, volume->upper, (1e4 - x) * wide * wide, 0.01);
  }
  check(box({-100, -100, -0.5}, {100, 100, 0}), 200, box({3, 5, -kDeep}, {3.25, 5.5, 2}), kDeep,
        0.125 * kDeep);
  // No more than the smaller body's volume; from 0 where it would be rounded up to the least double.
  const LrbRep part = closed(box({0, 0, 0}, {0.2, 0.2, 0.2}));
  CHECK(clash(closed(box({-1, -1, -1}, {1, 1, 1})), Pose{}, part, Pose::rotation({1, 2, 3}, 0.7))
            .volume->upper <= 0.008 * (1 + 1e-12));
  CHECK(clash(closed(shapes::scaled(box({0, 0, 0}, {3, 1, 1}), 0x1p-358)), Pose{},
              closed(shapes::scaled(box({2.25, 0, 0}, {4, 1, 1}), 0x1p-358)), Pose{})
            .volume->lower == 0);
}

TEST_CASE("near pairs of subnormal bodies, and of small parts of large ones") {
  Mesh a, b;
  test::add_loose(a, {{-2048, -3072, -3072}, {-2048, -3072, -3072}, {0, -3072, 0}});
  test::add_loose(b, {{3072, 1024, 2048}, {-1024, -2048, 2048}, {2048, -3072, -1024}});
  Pose pose;
  pose.r << 0.1180620857694579, 0.90578448339966022, -0.40695922834625081, -0.97453126940600832,
      0.18437483379565803, 0.12765079557208804, 0.19065715001981742, 0.38152377422021061, 0.90448297985704884;
  pose.t = 0x1p-1074 * Vector3d(2254, -26, 2642);
  NearPairsRequest request;
  request.within = 0x1p-1074 * 1532;
  const auto times = [](Mesh mesh, double by) { return shapes::scaled(std::move(mesh), by); };
  CHECK(near_pairs(closed(times(a, 0x1p-1074)), Pose{}, closed(times(b, 0x1p-1074)), pose, request).found ==
        1);
  // 2^1022 times as large, as parts of bodies of size 1.
  a = times(a, 0x1p-52), b = times(b, 0x1p-52);
  for (int i = 0; i < 80; ++i) {
    const Vector3d corner(1, 0.01 * (i / 2), i % 2 - 1);
    test::add_loose(i % 2 == 0 ? b : a,
                    {corner, corner + 0.001 * Vector3d::UnitX(), corner + 0.001 * Vector3d::UnitY()});
  }
  request.within = distance(closed(a), Pose{}, closed(b), Pose{}).upper * 1.5;
  CHECK(near_pairs(closed(a), Pose{}, closed(b), Pose{}, request).found >= 1);
}

TEST_CASE("a rotation has an axis of any length") {
  for (const double size : {0x1p-1000, 0x1p-540, 0x1p10, 0x1p540, 0x1p1000})
    CHECK(Pose::rotation({size, 2 * size, 0}, 0.5).r == Pose::rotation({1, 2, 0}, 0.5).r);
  CHECK(Pose::rotation({0x1p-1074, 0, 0}, 0.5).r == Pose::rotation({1, 0, 0}, 0.5).r);
}

}  // namespace lrb::reported
