// Shapes that users of other libraries reported, and of faults found here: polygons that are not convex,
// through every door; flaps without thickness; bodies of very different sizes; subnormal coordinates; axes of
// any length.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/closed_body.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/lrb_files.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/validate.hpp>

namespace lrb {
namespace {

using Eigen::Vector3d;
using test::closed;

/// The prism over an outline, from z = 0 to 1: two polygons and a quad for each side.
Mesh prism(const std::vector<std::array<double, 2>>& outline) {
  Mesh m;
  m.name = "prism";
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : outline) m.vertices.push_back({x, y, z});
  std::vector<VertexId> low, high;
  for (std::uint32_t i = 0; i < n; ++i) low.emplace_back(n - 1 - i), high.emplace_back(n + i);
  m.add_face(low);
  m.add_face(high);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    m.add_face(std::array{VertexId(i), VertexId(j), VertexId(n + j), VertexId(n + i)});
  }
  return m;
}

const std::vector<std::array<double, 2>> kU = {{0, 0}, {5, 0}, {5, 4}, {4, 4},
                                               {4, 1}, {1, 1}, {1, 4}, {0, 4}};
const Mesh kPeg = shapes::box({2, 2, -1}, {3, 3, 2});

/// A plate of size 6 with a square hole of size 2: each side of the plate is one outline with a bridge to the
/// hole.
Mesh frame() {
  Mesh m;
  m.name = "frame";
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] :
         {std::array<double, 2>{0, 0}, {6, 0}, {6, 6}, {0, 6}, {2, 2}, {4, 2}, {4, 4}, {2, 4}})
      m.vertices.push_back({x, y, z});
  const auto face = [&](std::initializer_list<std::uint32_t> corners) {
    std::vector<VertexId> ids;
    for (const std::uint32_t v : corners) ids.emplace_back(v);
    m.add_face(ids);
  };
  face({0, 4, 5, 6, 7, 4, 0, 3, 2, 1});
  face({8, 9, 10, 11, 8, 12, 15, 14, 13, 12});
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    face({i, j, 8 + j, 8 + i});
    face({4 + j, 4 + i, 12 + i, 12 + j});
  }
  return m;
}

std::string as_obj(const Mesh& m) {
  std::ostringstream out;
  for (const Vector3d& x : m.vertices) out << "v " << x.x() << " " << x.y() << " " << x.z() << "\n";
  for (FaceId f = 0; f < m.face_count(); ++f) {
    out << "f";
    for (const VertexId v : m.face(f)) out << " " << v + 1;
    out << "\n";
  }
  return out.str();
}

std::string as_off(const Mesh& m, const std::string& head) {
  std::ostringstream out;
  out << head;
  for (const Vector3d& x : m.vertices) out << x.x() << " " << x.y() << " " << x.z() << "\n";
  for (FaceId f = 0; f < m.face_count(); ++f) {
    out << m.face(f).size();
    for (const VertexId v : m.face(f)) out << " " << v.value();
    out << "\n";
  }
  return out.str();
}

std::string off_head(const Mesh& m) {
  return "OFF\n" + std::to_string(m.vertices.size()) + " " + std::to_string(m.face_count()) + " 0\n";
}

std::string ply_head(const Mesh& m) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(m.vertices.size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(m.face_count()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

/// Checks the U and the peg in its opening, 1 away from each wall.
void check_u(const LrbRep& u) {
  const LrbRep peg = closed(kPeg);
  CHECK(u.closed());
  CHECK(u.folded_faces().empty());
  const CollideResult r = collide(u, Pose{}, peg, Pose{});
  CHECK(r.relation == Relation::separate);
  CHECK(r.pairs.empty());
  const DistanceResult d = distance(u, Pose{}, peg, Pose{});
  CHECK(d.lower <= 1);
  CHECK(d.upper >= 1);
  CHECK(d.upper - d.lower < 1e-12);
  CHECK(clash(u, Pose{}, peg, Pose{}).kind == ClashKind::apart);
  const Vector3d points[] = {{2.5, 2.5, 0.5}, {0.5, 2, 0.5}};
  const auto distances = point_distances(u, Pose{}, points);
  CHECK(distances[0].signed_lower() <= 1.5);
  CHECK(distances[0].signed_upper() >= 1.5);
  CHECK(distances[1].signed_lower() <= -0.5);
  CHECK(distances[1].signed_upper() >= -0.5);
  // Half of the peg in a wall.
  const ClashResult in = clash(u, Pose{}, peg, Pose::translation({1.5, 0, 0}));
  CHECK(in.kind == ClashKind::protrudes);
  CHECK(in.volume->lower <= 0.5);
  CHECK(in.volume->upper >= 0.5);
}

}  // namespace

TEST_CASE("concave polygons cover their outline, whatever door they come through") {
  for (std::size_t first = 0; first < kU.size(); ++first) {
    CAPTURE(first);
    auto outline = kU;
    std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(first), outline.end());
    const Mesh u = prism(outline);
    check_u(LrbRep::without_regions(u, true, false));
    if (first != 0) continue;
    for (const auto& [bytes, name] :
         {std::pair{as_obj(u), "u.obj"}, std::pair{as_off(u, off_head(u)), "u.off"},
          std::pair{as_off(u, ply_head(u)), "u.ply"}}) {
      const Mesh read = read_mesh(bytes, name);
      CHECK(read.face_count() == u.face_count());
      const Expected<Body> body = Body::from(read);
      REQUIRE(body);
      CHECK(body->notes().empty());
      CHECK(body->has_regions());
      check_u(*body);
      check_u(load_lrb(test::lrb_bytes(body->rep()), "u.lrb"));
      CHECK(validate(body->rep()).valid);
    }
    Mesh inward = u;
    turn_faces(inward, {[&] {
                 std::vector<FaceId> all;
                 for (FaceId f = 0; f < inward.face_count(); ++f) all.push_back(f);
                 return all;
               }()});
    const Expected<Body> turned = Body::from(inward);
    REQUIRE(turned);
    CHECK(turned->turned() == 1);
    check_u(*turned);
  }
}

TEST_CASE("an outline with a bridge to a hole is a plate with a hole") {
  const Mesh m = frame();
  const MeshReport report = check_mesh(m);
  CHECK(report.closed);
  CHECK(report.genus == 1);
  CHECK(report.buildable());
  CHECK(report[MeshFault::repeated_corner].count == 0);
  CHECK(report[MeshFault::self_intersection].count == 0);
  CHECK(report[MeshFault::non_convex_face].count == 2);
  const Expected<Body> body = Body::from(m);
  REQUIRE(body);
  CHECK(body->notes().empty());
  CHECK(validate(body->rep()).valid);
  const LrbRep pin = closed(shapes::box({2.5, 2.5, -1}, {3.5, 3.5, 2}));
  CHECK(collide(*body, Pose{}, pin, Pose{}).relation == Relation::separate);
  const DistanceResult d = distance(*body, Pose{}, pin, Pose{});
  CHECK(d.lower <= 0.5);
  CHECK(d.upper >= 0.5);
  CHECK(d.upper < 0.5 + 1e-12);
  CHECK(collide(*body, Pose{}, pin, Pose::translation({1, 0, 0})).relation == Relation::crossing);
}

TEST_CASE("polygons that have no triangles that cover them are fans, with a note") {
  // A pentagram as a cap, and a quad that is folded out of its plane.
  std::vector<std::array<double, 2>> star;
  for (int i = 0; i < 5; ++i)
    star.push_back({std::cos(0.8 * std::numbers::pi * i), std::sin(0.8 * std::numbers::pi * i)});
  Mesh pair;
  pair.name = "m";
  pair.vertices = {{1, 1, 3}, {0, 4, 0}, {0, 0, 3}, {4, 0, 0}};
  pair.add_face(std::array<VertexId, 4>{1, 2, 3, 0});
  for (Mesh m : {prism(star), pair}) {
    const Expected<Body> body = Body::from(m);
    REQUIRE(body);
    CHECK(!body->rep().folded_faces().empty());
    CHECK(std::any_of(body->notes().begin(), body->notes().end(), [](const std::string& note) {
      return note.find("crosses itself or is far from planar") != std::string::npos;
    }));
    const Body again = Body::from(load_lrb(test::lrb_bytes(body->rep()), "m.lrb"));
    CHECK(again.notes()[0].find("crosses itself or is far from planar") != std::string::npos);
  }
}

TEST_CASE("a file of a version that took concave polygons as fans has the right shape, without its regions") {
  const Expected<Body> body = Body::from(prism(kU));
  REQUIRE(body);
  std::string bytes = test::lrb_bytes(body->rep());
  REQUIRE(bytes[8] == 4);
  bytes[8] = 3;
  const std::uint64_t sum = lrb_checksum(std::string_view(bytes).substr(0, bytes.size() - 8), 3);
  std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
  const LrbRep old = load_lrb(bytes, "old.lrb");
  CHECK(old.dropped_fans());
  CHECK(old.region_count() == 0);
  check_u(old);
  CHECK(Body::from(old).notes()[0].find("took concave polygons as fans") != std::string::npos);
  // Other bodies have the same bytes as in that version.
  CHECK(test::lrb_bytes(build_lrb(shapes::box()))[8] == 3);
}

TEST_CASE("flaps without thickness are no interior") {
  // A cube with a separate pair of coincident faces, and a plate of thickness 0 as a closed box.
  Mesh pillow = shapes::box();
  for (const Vector3d& x : {Vector3d(3, -1, 0), Vector3d(6, -1, 0), Vector3d(3, 3, 0)})
    pillow.vertices.push_back(x);
  const auto n = static_cast<std::uint32_t>(pillow.vertices.size());
  pillow.add_face(std::array{VertexId(n - 3), VertexId(n - 2), VertexId(n - 1)});
  pillow.add_face(std::array{VertexId(n - 1), VertexId(n - 2), VertexId(n - 3)});
  const Mesh slab = shapes::box({3, -1, 0}, {7, 3, 0});
  const Mesh peg = shapes::box({3.5, -0.5, -1}, {4, 0, 1});
  for (const Mesh& flap : {pillow, slab})
    for (const bool swapped : {false, true}) {
      const LrbRep a = closed(swapped ? peg : flap), b = closed(swapped ? flap : peg);
      const ClashResult r = clash(a, Pose{}, b, Pose{});
      CAPTURE(to_string(r.kind));
      CHECK((r.kind == ClashKind::touching_edge || r.kind == ClashKind::undecided));
      if (r.kind == ClashKind::undecided) continue;
      CHECK(r.interiors_overlap == Answer::no);
      CHECK(r.depth->upper == 0);
      CHECK(r.volume->upper == 0);
    }
  // Two cubes side by side in one body: their common faces are no flap.
  Mesh two = shapes::box();
  const Mesh second = shapes::box({1, 0, 0}, {2, 1, 1});
  for (const Vector3d& x : second.vertices) two.vertices.push_back(x);
  for (FaceId f = 0; f < second.face_count(); ++f) {
    std::vector<VertexId> ids;
    for (const VertexId v : second.face(f)) ids.emplace_back(v + 8);
    two.add_face(ids);
  }
  const ClashResult r =
      clash(closed(two), Pose{}, closed(shapes::box({0.75, 0.25, 0.25}, {1.25, 0.75, 0.75})), Pose{});
  CHECK(r.interiors_overlap == Answer::yes);
  CHECK(r.volume->lower <= 0.125);
  CHECK(r.volume->upper >= 0.125);
  CHECK(r.depth->lower > 0.7);
}

TEST_CASE("the volume of an overlap is as precise as the overlap is large") {
  struct Case {
    Mesh a, b;
    double volume;
  };
  // 1 cm in a block of 20 km; a column 10 um deep in a slab of 200 m.
  const double deep = 0x1p-17;
  for (const Case& c :
       {Case{shapes::box({-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}),
             shapes::box({9999.99609375, 3, 5}, {10000.00390625, 3.0078125, 5.0078125}), 0x1p-22},
        Case{shapes::box({-100, -100, -0.5}, {100, 100, 0}), shapes::box({3, 5, -deep}, {3.25, 5.5, 2}),
             0.125 * deep}}) {
    for (const bool swapped : {false, true}) {
      const ClashResult r = clash(closed(swapped ? c.b : c.a), Pose{}, closed(swapped ? c.a : c.b), Pose{});
      CHECK(r.volume->lower <= c.volume * (1 + 1e-12));
      CHECK(r.volume->upper >= c.volume * (1 - 1e-12));
      CHECK(r.volume->upper - r.volume->lower < 0.01 * c.volume);
    }
  }
}

TEST_CASE("near pairs of subnormal bodies, and of small parts of large ones") {
  Mesh a, b;
  a.vertices = {{-1.0118464426828729e-320, -1.5177696640243094e-320, -1.5177696640243094e-320},
                {-1.0118464426828729e-320, -1.5177696640243094e-320, -1.5177696640243094e-320},
                {0, -1.5177696640243094e-320, 0}};
  b.vertices = {{1.5177696640243094e-320, 5.0592322134143646e-321, 1.0118464426828729e-320},
                {-5.0592322134143646e-321, -1.0118464426828729e-320, 1.0118464426828729e-320},
                {1.0118464426828729e-320, -1.5177696640243094e-320, -5.0592322134143646e-321}};
  Pose pose;
  pose.r << 0.1180620857694579, 0.90578448339966022, -0.40695922834625081, -0.97453126940600832,
      0.18437483379565803, 0.12765079557208804, 0.19065715001981742, 0.38152377422021061, 0.90448297985704884;
  pose.t = {1.1136239657261697e-320, -1.284570679187241e-322, 1.3053214363125734e-320};
  for (Mesh* m : {&a, &b}) m->add_face(std::array<VertexId, 3>{0, 1, 2});
  NearPairsRequest request;
  request.within = 7.5690856942878971e-321;
  CHECK(near_pairs(closed(a), Pose{}, closed(b), pose, request).found == 1);
  // 2^1030 times as large, as parts of bodies of size 1: without a rotation, so that the distance is the
  // same.
  const double by = 0x1p1022;
  for (Mesh* m : {&a, &b}) {
    for (Vector3d& x : m->vertices) x *= by;
    for (int i = 0; i < 40; ++i) {
      const Vector3d corner(1, 0.01 * i, m == &a ? 0 : -1);
      const VertexId first(m->vertices.size());
      for (int k = 0; k < 3; ++k) m->vertices.push_back(corner + 0.001 * Vector3d::Unit(k));
      m->add_face(std::array{first, VertexId(first + 1), VertexId(first + 2)});
    }
  }
  const DistanceResult d = distance(closed(a), Pose{}, closed(b), Pose{});
  request.within = d.upper * 1.5;
  CHECK(near_pairs(closed(a), Pose{}, closed(b), Pose{}, request).found >= 1);
}

TEST_CASE("a rotation has an axis of any length") {
  const Pose expected = Pose::rotation({1, 2, 0}, 0.5), tiny = Pose::rotation({1, 0, 0}, 0.5);
  for (const double size : {0x1p-1000, 0x1p-540, 0x1p-3, 0x1p10, 0x1p540, 0x1p1000})
    CHECK(Pose::rotation({size, 2 * size, 0}, 0.5).r == expected.r);
  CHECK(Pose::rotation({0x1p-1074, 0, 0}, 0.5).r == tiny.r);
  CHECK((Pose::rotation({1e308, 1e308, 0}, 0.5).r.transpose() * Pose::rotation({1e308, 1e308, 0}, 0.5).r -
         Eigen::Matrix3d::Identity())
            .norm() < 1e-15);
}

TEST_CASE("manifolds with a depth above 0 intersect") {
  ManifoldRequest request;
  request.margin = 0.5;
  const LrbRep cube = closed(shapes::box());
  const ManifoldResult r = contact_manifolds(cube, Pose{}, cube, Pose::translation({0.9, 0.8, 0.7}), request);
  REQUIRE(!r.manifolds.empty());
  for (const ContactManifold& m : r.manifolds) CHECK(m.intersects == (m.points[0].depth > 0));
}

}  // namespace lrb
