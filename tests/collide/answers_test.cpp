// Every variant of the query against brute force, for every kind of bodies and class of poses.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/hard_bodies.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>

using namespace lrb;
using Eigen::Vector3d;
using shapes::RandomEngine;
using shapes::uniform;
using test::closed;
using test::open_body;

namespace {

struct Bodies {
  const char* name;
  LrbRep a, b;
  int poses = 4;  ///< of each class
};

std::vector<Bodies> all_bodies() {
  using namespace shapes;
  const Mesh cut = test::without_last_face(icosphere(1));
  return {{"spheres", closed(icosphere(1)), closed(icosphere(1, 0.7))},
          {"bumps", closed(bumpy_sphere(2, 7, 0.3)), closed(bumpy_sphere(1, 8, 0.3))},
          {"ball in bowl", closed(bowl(12, 6)), closed(icosphere(1, 0.5))},
          {"void", closed(box_with_void()), closed(icosphere(1, 0.3))},
          {"tori", closed(torus(12, 8)), closed(torus(10, 6, 1, 0.3))},
          {"combs", closed(comb(5)), closed(comb(4))},
          {"quads", closed(quad_box()), closed(quad_torus(8, 6))},
          {"grain in ball", closed(bumpy_sphere(2, 9)), closed(scaled(tetrahedron(), 1e-3))},
          {"far and small", closed(translated(icosphere(1), {1e7, -2e7, 3e6})), closed(icosphere(1, 0.6))},
          {"gears 2D", closed(gear(9)), closed(gear(7, 0.9, 0.6))},
          {"ring 2D", closed(ring_2d(30)), closed(star(5, 0.3, 0.1))},
          {"regions 2D", stairs_2d(), stairs_2d()},
          {"regions", dented_box(), closed(icosphere(1, 0.7))},
          {"built", build_lrb(bumpy_sphere(2, 7, 0.3)), build_lrb(torus(12, 8)), 2},
          {"squares underflow", closed(icosphere(1), 1e-170), closed(bumpy_sphere(1, 2), 1e-170)},
          {"denormal", closed(icosphere(1), 0x1p-1050), closed(bumpy_sphere(1, 2), 0x1p-1050), 2},
          {"huge", closed(icosphere(1), 1e150), closed(bumpy_sphere(1, 2), 1e150)},
          {"needles", closed(hard::cone(40)), closed(hard::bipyramid(60))},
          {"many needles", closed(hard::crown(300)), closed(hard::frustum(300)), 1},
          {"hub", closed(hard::cone(600)), closed(hard::fine_box(200)), 1},
          {"open", open_body(open_cylinder(9)), closed(icosphere(1, 0.3))},
          {"ball without a face", open_body(cut), open_body(cut)},
          {"triangle", open_body(test::sheet(1)), closed(icosphere(1, 0.3))},
          {"open 2D", open_body(test::without_last_face(circle(12))), closed(circle(7, 0.3))}};
}

enum class Class { anywhere, both_move, on_grid, corner_on_corner, mapped, barely_mapped, far_away, last };

/// Poses of a class, from deep inside to near misses; of sizes that keep coordinates within doubles.
void place(RandomEngine& random, const Bodies& x, Class kind, int i, Pose& pose_a, Pose& pose_b) {
  const int dim = x.a.dim();
  // Not from squares, which underflow for small bodies.
  const Eigen::AlignedBox3d box_a = shapes::box_of(x.a), box_b = shapes::box_of(x.b);
  const double size = 1.7 * (box_a.sizes().maxCoeff() + box_b.sizes().maxCoeff());
  pose_a = {};
  pose_b.r = shapes::random_rotation(random, dim);
  const double share = uniform(random, 0, 1.1);
  pose_b.t = box_a.center() - pose_b.r * box_b.center() +
             share * size / 2 * test::in_space(shapes::random_direction(random), dim);
  const auto frame = [&](double far) {
    const Pose f = test::any_pose_within(random, far, dim);
    pose_a = {f.r * pose_a.r, f.apply(pose_a.t)};
    pose_b = {f.r * pose_b.r, f.apply(pose_b.t)};
  };
  const auto corner = [&](const LrbRep& rep) { return rep.vertices()[random() % rep.vertices().size()]; };
  switch (kind) {
    case Class::both_move:
      return frame(3 * size);
    case Class::on_grid:  // faces and edges coincide
      pose_b = {};
      for (int k = 0; k < dim; ++k)
        pose_b.t[k] = (static_cast<double>(random() % 9) - 4) / 4 * std::exp2(std::ilogb(size) - 1);
      if (i % 2 == 0) pose_b.r.topLeftCorner<2, 2>() << 0, -1, 1, 0;
      return;
    case Class::corner_on_corner:
      pose_b.t = test::in_space(corner(x.a) - pose_b.r * corner(x.b), dim);
      return;
    case Class::mapped:
    case Class::barely_mapped: {
      const auto map = [&](int which) {
        return test::random_map(random,
                                kind == Class::mapped ? static_cast<test::MapKind>(which % test::kMapKinds)
                                                      : test::MapKind::barely_scaled,
                                dim);
      };
      pose_a.r = map(i);
      pose_b.r = map(i % 3 == 0 ? i : static_cast<int>(random() % test::kMapKinds));
      // The sizes of bodies and of the world are of their own; huge ones stay.
      const double world =
          size > 1e100 || size < 1e-100 ? 1 : std::array{1.0, 1e-150, 1e150, 1e-12, 1e9}[i % 5];
      pose_a.r *= world;
      pose_b.r *= world;
      pose_b.t = i % 7 == 0 ? test::in_space(pose_a.r * corner(x.a) - pose_b.r * corner(x.b), dim)
                            : Vector3d(pose_b.t * world);
      return;
    }
    case Class::far_away:
      return frame(std::pow(10, uniform(random, 0, 16)) * size);
    default:
      return;
  }
}

bool boxes_are_disjoint(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  Eigen::AlignedBox3d of_a, of_b;
  for (const VertexId v : a.data().face_vertices) of_a.extend(pose_a.apply(a.vertices()[v]));
  for (const VertexId v : b.data().face_vertices) of_b.extend(pose_b.apply(b.vertices()[v]));
  for (int k = 0; k < a.dim(); ++k)
    if (of_a.max()[k] < of_b.min()[k] || of_b.max()[k] < of_a.min()[k]) return true;
  return false;
}

struct AnswersSeen {
  int poses = 0, contact = 0, inside = 0, apart = 0, undefined = 0, ends_at_roots = 0;
};

/// Checks every variant of the query, alone, coherent, to a tolerance and with a probe.
void check(const Bodies& x, const Pose& pose_a, const Pose& pose_b, CoherentQuery& coherent,
           QueryContext& context, AnswersSeen& seen) {
  const BruteForceResult truth = brute_force(x.a, pose_a, x.b, pose_b);
  const bool meets = !truth.pairs.empty();
  if (!meets && !(x.a.closed() && x.b.closed()))
    REQUIRE(truth.relation ==
            (boxes_are_disjoint(x.a, pose_a, x.b, pose_b) ? Relation::separate : Relation::undefined));
  NullProbe none;
  const auto ask = [&](const CollideRequest& request) {
    return collide(x.a, pose_a, x.b, pose_b, request, context, none);
  };
  const CollideResult all = ask({});
  REQUIRE(all.pairs == truth.pairs);
  REQUIRE(all.meets == truth.meets);
  REQUIRE(std::string(to_string(all.relation)) == to_string(truth.relation));
  REQUIRE((meets || all.interiors_overlap == (truth.relation == Relation::separate    ? Answer::no
                                              : truth.relation == Relation::undefined ? Answer::unknown
                                                                                      : Answer::yes)));
  CollideProbe silent;
  ProbeAdapter watched(silent);
  for (const Mode mode : {Mode::first_pair, Mode::any_pair}) {
    const CollideResult one = ask({.mode = mode});
    REQUIRE(one.pairs.size() == std::min<std::size_t>(1, truth.pairs.size()));
    if (meets) REQUIRE(std::binary_search(truth.pairs.begin(), truth.pairs.end(), one.pairs[0]));
    if (!meets || mode == Mode::first_pair) REQUIRE(one.relation == truth.relation);
    const CollideResult same = collide(x.a, pose_a, x.b, pose_b, {.mode = mode}, context, watched);
    REQUIRE(same.pairs == one.pairs);
    REQUIRE(same.relation == one.relation);
    REQUIRE(same.counters == one.counters);
  }
  const CollideResult& kept = coherent.collide(pose_a, pose_b);
  REQUIRE(kept.pairs == truth.pairs);
  REQUIRE(kept.meets == truth.meets);
  REQUIRE(kept.relation == truth.relation);
  CollideRequest coarse{.tolerance = 0.05 * x.a.tree().extent()};
  for (const std::uint64_t tests : {0U, 1'000'000U}) {
    coarse.max_tests = tests;
    const CollideResult r = ask(coarse);
    REQUIRE(!std::isnan(r.error_bound));
    if (r.error_bound == 0 || r.relation == Relation::separate || r.relation == Relation::crossing)
      REQUIRE(r.relation == truth.relation);
  }
  if (!meets) {
    const CollideResult back = collide(x.b, pose_b, x.a, pose_a);
    REQUIRE(back.relation == mirrored(truth.relation));
    if (x.a.real_face_count() < 400) REQUIRE(distance(x.a, pose_a, x.b, pose_b).relation == truth.relation);
  }
  if (roots_are_apart(x.a.tree(), pose_a, x.b.tree(), pose_b)) {
    ++seen.ends_at_roots;
    REQUIRE(truth.relation == Relation::separate);
  }
  ++seen.poses;
  seen.contact += meets;
  seen.apart += truth.relation == Relation::separate;
  seen.undefined += truth.relation == Relation::undefined;
  seen.inside += is_inside(truth.relation);
}

/// Checks every `part`th of the poses.
void check_every(int part) {
  RandomEngine random(20240607);
  QueryContext context;
  AnswersSeen total;
  for (const Bodies& x : all_bodies())
    for (int kind = 0; kind < static_cast<int>(Class::last); ++kind) {
      CAPTURE(x.name);
      CAPTURE(kind);
      CoherentQuery coherent(x.a, x.b, {}, CoherentQuery::CacheUse::always);
      for (int i = 0; i < x.poses; i += part) {
        CAPTURE(i);
        Pose pose_a, pose_b;
        place(random, x, static_cast<Class>(kind), i, pose_a, pose_b);
        check(x, pose_a, pose_b, coherent, context, total);
        // And a small step on, with the cache of the coherent query.
        pose_b.t += 1e-3 * x.b.tree().extent() * test::in_space(shapes::random_direction(random), x.a.dim());
        check(x, pose_a, pose_b, coherent, context, total);
      }
    }
  MESSAGE(total.poses << " poses: " << total.contact << " in contact, " << total.inside << " inside, "
                      << total.apart << " apart, " << total.undefined << " undefined, " << total.ends_at_roots
                      << " end at the roots");
  CHECK(total.contact > 400 / part);
  CHECK(total.inside > 30 / part);
  CHECK(total.apart > 400 / part);
  CHECK(total.undefined > 30 / part);
  CHECK(total.ends_at_roots > 100 / part);
}

}  // namespace

TEST_CASE("every variant of the query agrees with brute force, for all kinds of bodies and poses") {
  check_every(3);
}

TEST_CASE("brute force omits no pair: it finds those of all tests of two simplices") {
  RandomEngine random(20261130);
  std::size_t found = 0;
  for (const Bodies& x : all_bodies()) {
    if (x.a.real_simplex_count() * x.b.real_simplex_count() > 200'000) continue;
    CAPTURE(x.name);
    Pose pose_a, pose_b;
    place(random, x, Class::both_move, 0, pose_a, pose_b);
    const auto of_a = test::real_simplices(x.a, pose_a), of_b = test::real_simplices(x.b, pose_b);
    std::vector<SimplexPair> pairs;
    for (SimplexId s = 0; s < of_a.size(); ++s)
      for (SimplexId t = 0; t < of_b.size(); ++t)
        if (test::meet_of(of_a[s], of_b[t]) != exact::Meet::disjoint) pairs.push_back({s, t});
    CHECK(brute_force(x.a, pose_a, x.b, pose_b).pairs == pairs);
    found += pairs.size();
  }
  CHECK(found > 500);
}

TEST_CASE("every variant of the query agrees with brute force at all poses" * doctest::test_suite("long")) {
  check_every(1);
}

namespace {

using Triangle = std::array<Vector3d, 3>;

LrbRep soup(const std::vector<Triangle>& triangles) {
  Mesh mesh;
  for (const Triangle& t : triangles) test::add_loose(mesh, {t[0], t[1], t[2]});
  return open_body(mesh);
}

Vector3d in_ball(RandomEngine& random) {
  const double radius = uniform(random, 0, 1);
  return radius * shapes::random_direction(random);
}

struct LargeAndSmall {
  LrbRep large, small;
  Pose pose_large, pose_small;
};

/// Small triangles far from the centre of their block, on large ones of the other body: the planes of the
/// small ones are known badly, and the corners of the large ones are far away.
LargeAndSmall small_on_large(RandomEngine& random, double size, double offset) {
  std::vector<Triangle> large(8), small(24);
  const Pose pose_large{shapes::random_rotation(random), offset * shapes::random_direction(random)};
  const Pose pose_small{shapes::random_rotation(random), pose_large.t + in_ball(random)};
  for (Triangle& t : large)
    for (auto& x : t) x = in_ball(random);
  for (Triangle& t : small) {
    const Triangle& on = large[random() % large.size()];
    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1 - u);
    const Vector3d centre = on[0] + u * (on[1] - on[0]) + v * (on[2] - on[0]);
    for (auto& x : t)
      x = pose_small.r.transpose() * (pose_large.apply(centre + size * in_ball(random)) - pose_small.t);
  }
  return {soup(large), soup(small), pose_large, pose_small};
}

}  // namespace

TEST_CASE("small triangles on large ones, where the kernel's floats are strained") {
  RandomEngine random(3);
  std::size_t meeting = 0, from_cache = 0;
  for (int i = 0; i < 1500; ++i) {
    const double size = std::pow(10, uniform(random, -7, -0.5));
    LargeAndSmall x = small_on_large(random, size, i % 3 ? 0 : std::pow(10, uniform(random, -1, 6)));
    CAPTURE(i);
    CAPTURE(size);
    const auto truth = brute_force(x.large, x.pose_large, x.small, x.pose_small).pairs;
    REQUIRE(collide(x.large, x.pose_large, x.small, x.pose_small).pairs == truth);
    REQUIRE(collide(x.small, x.pose_small, x.large, x.pose_large).pairs ==
            brute_force(x.small, x.pose_small, x.large, x.pose_large).pairs);
    meeting += truth.size();
    if (i % 10 != 0) continue;
    CoherentQuery coherent(x.large, x.small, {}, CoherentQuery::CacheUse::always);
    const Pose start = x.pose_small;
    for (int step = 0; step < 12; ++step) {  // tiny motions
      REQUIRE(coherent.collide(x.pose_large, x.pose_small).pairs ==
              brute_force(x.large, x.pose_large, x.small, x.pose_small).pairs);
      x.pose_small = {test::nudged(random, start, 0.3 * size, 0, 3).r,
                      start.t + 0.3 * size * in_ball(random)};
    }
    from_cache += coherent.statistics().from_cache;
  }
  CHECK(meeting > 10'000);
  CHECK(from_cache > 500);
}

TEST_CASE("boxes of open bodies: touching they are not disjoint, one ulp apart they are; only faces count") {
  const auto triangle = [](const Vector3d& at, double size = 1) {
    Mesh mesh;
    test::add_loose(mesh, {at, at + Vector3d(size, 0, 0), at + Vector3d(0, size, 0)});
    return mesh;
  };
  Mesh more = triangle({0, 0, 0});
  more.vertices.insert(more.vertices.end(), {{9, 9, 9}, {-9, -9, -9}});  // without a face
  const Mesh low = triangle({-1.7e308, 0, 0}, 1e307);
  struct {
    Mesh a, b;
    Relation expected;
  } const rows[] = {{more, triangle({1, 1, 0}), Relation::undefined},
                    {more, triangle({std::nextafter(1, 2), 1, 0}), Relation::separate},
                    {more, triangle({1, 1, 5e-324}), Relation::separate},
                    {more, triangle({0, 0, 5e-324}), Relation::separate},
                    {low, triangle({1.6e308, 0, 0}, 1e307), Relation::separate},
                    {low, triangle({-1.6e308, 1e307, 0}, 1e307), Relation::undefined}};
  for (const auto& [a, b, expected] : rows)
    CHECK(collide(open_body(a), {}, open_body(b), {}).relation == expected);
  // In a search for a first contact.
  const LrbRep open = open_body(test::without_last_face(shapes::icosphere(4))),
               small = closed(shapes::icosphere(0, 0.3));
  for (const auto& [x, expected] : {std::pair{5.0, Relation::separate}, {0.0, Relation::undefined}})
    CHECK(first_contact(open, Motion::still({}), small,
                        Motion::linear(Pose::translation({x, 0, 0}), {x - 0.1, 0, 0}))
              .at_begin == expected);
}

TEST_CASE("world coordinates that overflow are rejected with the body's name") {
  const LrbRep box = closed(shapes::box());
  Pose far;
  far.r *= 1.5e308;
  far.t.y() = 1e308;
  CHECK_THROWS_WITH_AS(collide(box, {}, box, far),
                       "body B, vertex 1: its world y exceeds 1.8e308; scale down the bodies and the pose",
                       InputError);
  far.t.y() = 0;
  CHECK(collide(box, far, box, {}).relation == Relation::touching);
}

// At 1e16 doubles are 2 apart: a plate of thickness 1 becomes a sheet with two faces, one of which faces as
// the box behind it does. That was taken for solids on the same side; pierced, for a common interior.
TEST_CASE(
    "overlap of interiors: proven by crossings of bodies with volume, down to an ulp, and only by these") {
  const LrbRep plate = closed(shapes::box({0, 0, 0}, {1, 4, 4})),
               beside = closed(shapes::box({-4, 1, 1}, {0, 2, 2})),
               rod = closed(shapes::box({-4, 1, 1}, {4, 2, 2})), ball = closed(shapes::icosphere(1, 2)),
               box = closed(shapes::box()),
               ulp = closed(shapes::box({std::nextafter(1.0, 0.0), 0, 0}, {2, 1, 1})),
               gear = closed(shapes::gear(5)), room = closed(shapes::box({0, 0, 0}, {3, 3, 3})),
               hollow = closed(shapes::box_with_void()),
               bar = closed(shapes::polygon({{-3, -0.5}, {3, -0.5}, {3, 0.5}, {-3, 0.5}}));
  Mesh inscribed;  // in the box: all its corners and edges lie on the box's surface
  inscribed.vertices = {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  for (const auto& f : std::vector<std::array<VertexId, 3>>{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}})
    inscribed.add_face(f);
  const LrbRep in_box = closed(inscribed);
  const Pose far = Pose::translation({1e16, 0, 0}), up = Pose::translation({0, 1e17, 0});
  using enum Answer;
  struct {
    const LrbRep *a, *b;
    Pose pose_a, pose_b;
    Relation relation;
    std::vector<Answer> overlap;
  } const rows[] = {{&plate, &beside, far, far, Relation::touching, {no, unknown}},
                    {&plate, &beside, {}, {}, Relation::touching, {no}},
                    {&plate, &beside, {}, Pose::translation({1, 0, 0}), Relation::crossing, {yes}},
                    {&plate, &rod, far, far, Relation::crossing, {unknown}},
                    {&plate, &rod, {}, {}, Relation::crossing, {yes}},
                    {&ball, &rod, {}, {}, Relation::crossing, {yes}},
                    {&box, &ulp, {}, {}, Relation::touching, {yes}},
                    {&box, &in_box, {}, {}, Relation::touching, {yes}},
                    {&ball, &ball, {}, {}, Relation::touching, {yes}},
                    {&box, &box, {}, Pose::translation({1, 1, 1}), Relation::touching, {no}},  // at a corner
                    {&room, &box, {}, Pose::translation({1, 1, 0}), Relation::touching, {yes}},
                    {&hollow, &box, {}, Pose::translation({1, 1, 1}), Relation::touching, {no}},  // fills it
                    {&gear, &bar, {}, {}, Relation::crossing, {yes}},
                    {&bar, &bar, up, Pose::translation({1, 1e17, 0}), Relation::touching, {no, unknown}}};
  for (const auto& row : rows) {
    const CollideResult r = collide(*row.a, row.pose_a, *row.b, row.pose_b, {.interiors_overlap = true});
    CAPTURE(&row - rows);
    CHECK(r.relation == row.relation);
    CHECK(std::count(row.overlap.begin(), row.overlap.end(), r.interiors_overlap) == 1);
  }
}

TEST_CASE("contact normals point from A to B for mirrored and scaled bodies, in space and in the plane") {
  const CollideRequest request{.contacts = true, .interiors_overlap = true};
  const auto check_beside = [&](const LrbRep& box, const Pose& a, Pose b, double deep) {
    const CollideResult r = collide(box, a, box, b, request);
    REQUIRE(r.regions.size() == 1);
    CHECK((r.regions[0].normal - Vector3d(1, 0, 0)).norm() < 1e-12);
    CHECK(r.interiors_overlap == Answer::no);
    b.t.x() -= deep;  // sides that coincide, from within
    CHECK(collide(box, a, box, b, request).interiors_overlap == Answer::yes);
  };
  // Boxes from 0 to 1 on each axis; B's lower side is the plane x = size.
  for (const double size : {1.0, 1e-120, 1e120})
    for (const double mirror_a : {1.0, -1.0})
      for (const double mirror_b : {1.0, -1.0}) {
        Pose a, b = Pose::translation({size, 0.25 * size, 0.25 * size});
        a.r = size * Vector3d(1, mirror_a, 1).asDiagonal();
        a.t.y() = mirror_a < 0 ? size : 0;
        b.r = 0.5 * size * Vector3d(1, mirror_b, 1).asDiagonal();
        b.t.y() += mirror_b < 0 ? 0.5 * size : 0;
        check_beside(closed(shapes::box()), a, b, 0.5 * size);
      }
  for (const double z : {1.0, -1.0, 0.0, 7.0}) {  // whatever the matrix does to z
    Pose over = Pose::translation({1, 1, 0});
    over.r = Vector3d(1, -1, z).asDiagonal();
    check_beside(closed(shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}})), {}, over, 1);
  }
}

TEST_CASE("any_pair ends at the first intersecting pair, first_pair at the first crossing one") {
  const LrbRep ball = closed(shapes::icosphere(3));
  const CollideResult first = collide(ball, {}, ball, {}, {.mode = Mode::first_pair}),
                      any = collide(ball, {}, ball, {}, {.mode = Mode::any_pair});
  CHECK(first.relation == Relation::touching);
  CHECK(any.relation == Relation::touching);
  CHECK(first.counters.face_tests > ball.real_face_count());
  CHECK(any.counters.face_tests < 100);
}

TEST_CASE(
    "a limit of pairs holds for every recursion and for coherent queries, which recover; not for one pair") {
  // Thin upright triangles, side by side along x or along y: each of one body crosses each of the other.
  constexpr std::uint64_t kStrips = 60, kPairs = kStrips * kStrips;
  const auto strips = [](int along) {
    std::vector<Triangle> list;
    for (std::uint64_t i = 0; i < kStrips; ++i) {
      const double at = static_cast<double>(i) / kStrips;
      Triangle t = {{{at, -1, -0.5}, {at, 2, -0.5}, {at, 0.5, 2}}};
      if (along == 1)
        for (Vector3d& x : t) std::swap(x[0], x[1]);
      list.push_back(t);
    }
    return soup(list);
  };
  const LrbRep a = strips(0), b = strips(1);
  const auto at = [](double x) { return Pose::translation({x, 0, 0.125}); };
  for (const Recursion recursion :
       {Recursion::complete, Recursion::paper, Recursion::paper_strict, Recursion::paper_wrapper,
        Recursion::paper_boxes, Recursion::paper_wrapper_boxes}) {
    CHECK(collide(a, {}, b, at(0), {.recursion = recursion, .max_pairs = kPairs}).pairs.size() == kPairs);
    CHECK_THROWS_WITH_AS(collide(a, {}, b, at(0), {.recursion = recursion, .max_pairs = kPairs - 1}),
                         doctest::Contains("max_pairs; raise it (--max-pairs)"), InputError);
  }
  CHECK_THROWS_AS(collide(a, {}, b, at(0), {.contacts = true, .max_pairs = 10}), InputError);
  CHECK_THROWS_AS(collide(a, {}, b, at(0), {.tolerance = 1e-9, .max_pairs = 10}), InputError);
  for (const Mode mode : {Mode::first_pair, Mode::any_pair})
    CHECK(collide(a, {}, b, at(0), {.mode = mode, .max_pairs = 1}).pairs.size() == 1);
  for (const auto use : {CoherentQuery::CacheUse::always, CoherentQuery::CacheUse::as_it_pays}) {
    CoherentQuery query(a, b, {.max_pairs = kPairs / 2}, use);
    int rejected = 0;
    for (int step = 0; step < 60; ++step) {
      const Pose pose = at(3.0 - 0.05 * step);
      const std::size_t expected = collide(a, {}, b, pose).pairs.size();
      CAPTURE(step);
      rejected += expected > kPairs / 2;
      if (expected > kPairs / 2) {
        CHECK_THROWS_AS(query.collide({}, pose), InputError);
      } else {
        CHECK(query.collide({}, pose).pairs.size() == expected);
      }
    }
    CHECK((rejected > 5 && rejected < 55));
    CHECK(query.collide({}, at(4)).pairs.empty());
  }
  CHECK(CollideRequest{}.pair_limit() == kMaxPairs);
  CHECK(CollideRequest{.contacts = true}.pair_limit() == kMaxPairsWithContacts);
  CHECK(CollideRequest{.max_pairs = 7}.pair_limit() == 7);
}
