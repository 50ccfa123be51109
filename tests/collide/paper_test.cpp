// The paper's recursion: where it finds the same as the complete query, and where it misses, pinned.
#include <algorithm>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/mesh_check.hpp>

using namespace lrb;

namespace {

CollideResult ask(const LrbRep& a, const LrbRep& b, const Pose& p, Recursion recursion,
                  Mode mode = Mode::all_pairs) {
  CollideRequest request;
  request.recursion = recursion;
  request.mode = mode;
  return collide(a, Pose{}, b, p, request);
}

}  // namespace

TEST_CASE(
    "on kept wrappers the paper's recursion gives the answers of queries from scratch for bodies of any size") {
  for (const double size : {1e-310, 1e-200, 1e-160, 1e-82, 1.0, 1e100, 1e150, 1e200, 1e300}) {
    CAPTURE(size);
    const LrbRep a = build_lrb(shapes::scaled(shapes::icosphere(1), size)),
                 b = build_lrb(shapes::scaled(shapes::bumpy_sphere(1, 6, 0.2), size));
    CollideRequest request;
    request.recursion = Recursion::paper;
    CoherentQuery query(a, b, request);
    std::size_t contacts = 0;
    for (int step = 0; step < 20; ++step) {
      const Pose p = Pose::translation({size * (2.3 - 0.04 * step), 0.1 * size, 0});
      const std::vector<SimplexPair> expected = collide(a, Pose{}, b, p, request).pairs;
      CHECK(query.collide(Pose{}, p).pairs == expected);
      contacts += !expected.empty();
    }
    CHECK(contacts > 5);
  }
}

TEST_CASE("without regions the paper's query is brute force and finds all pairs") {
  const LrbRep a = test::closed(shapes::icosphere(1));
  const LrbRep b = test::closed(shapes::comb(3));
  shapes::RandomEngine random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose p = shapes::random_pose(random, a, b, 0.4);
    for (const Recursion recursion : {Recursion::paper, Recursion::paper_wrapper}) {
      const CollideResult paper = ask(a, b, p, recursion);
      CHECK(paper.pairs == ask(a, b, p, Recursion::complete).pairs);
      CHECK(paper.counters.face_tests == std::uint64_t{a.face_count()} * b.face_count());
    }
  }
}

TEST_CASE(
    "a contact under a lid that nothing touches is missed by the paper's recursion, never by the complete "
    "one") {
  const LrbRep a = shapes::dented_box();
  // In the dent, below the lid at z = 2, its corner through the dent's floor at z = 1: the lid is not
  // touched.
  const LrbRep pebble = test::closed(shapes::box({1.6, 1.7, 0.9}, {2.1, 2.2, 1.5}));
  const CollideResult complete = ask(a, pebble, Pose{}, Recursion::complete);
  CHECK(complete.relation == Relation::crossing);
  CHECK(complete.opened[0] == std::vector<RegionId>{0});
  for (const Recursion recursion : {Recursion::paper, Recursion::paper_strict, Recursion::paper_wrapper,
                                    Recursion::paper_boxes, Recursion::paper_wrapper_boxes}) {
    const CollideResult paper = ask(a, pebble, Pose{}, recursion);
    CHECK(paper.pairs.empty());
    CHECK(paper.counters.refinements == 0);
  }
}

TEST_CASE(
    "the recursions with boxes, on bodies of every kind: no false pair, no more missed than by paper, fewer tests") {
  using namespace shapes;
  const Mesh meshes[] = {bumpy_sphere(3, 1, 0.4),
                         quad_torus(20, 10),
                         comb(5),
                         bowl(16, 8),
                         box_with_void(),
                         several({icosphere(2), translated(icosphere(2), {3, 0, 0})}),
                         several({icosphere(3), translated(icosphere(3), {1, 0.1, 0})}),  // crosses itself
                         open_cylinder(12),
                         ring_2d(40),
                         comb_2d(5)};
  std::size_t all = 0, paper_pairs = 0, paper_tests = 0, pairs[2] = {0, 0}, tests[2] = {0, 0};
  for (const Mesh& mesh : meshes) {
    CAPTURE(mesh.name);
    BuildOptions options;
    options.max_lids = 12;
    const LrbRep rep = check_mesh(mesh).buildable() ? build_lrb(mesh, options) : test::open_body(mesh);
    RandomEngine random(5);
    for (int i = 0; i < 20; ++i) {
      Pose p = random_pose(random, rep, rep, uniform(random, 0.3, 0.9));
      if (i % 5 == 4 && mesh.dim == 3) p.r *= Eigen::Vector3d(1, 0.5, -2).asDiagonal();  // not rigid
      const auto expected = brute_force(rep, Pose{}, rep, p).pairs;
      const CollideResult paper = ask(rep, rep, p, Recursion::paper);
      all += expected.size();
      paper_pairs += paper.pairs.size();
      paper_tests += paper.counters.face_tests;
      for (const int k : {0, 1}) {
        const CollideResult found =
            ask(rep, rep, p, k == 0 ? Recursion::paper_boxes : Recursion::paper_wrapper_boxes);
        CHECK(std::includes(expected.begin(), expected.end(), found.pairs.begin(), found.pairs.end()));
        pairs[k] += found.pairs.size();
        tests[k] += found.counters.box_tests + found.counters.face_tests;
      }
    }
  }
  for (const int k : {0, 1}) {
    CHECK(pairs[k] >= paper_pairs);
    CHECK(pairs[k] < all);  // contacts under lids of the void, the bowl and the 2D bodies
    CHECK(tests[k] < paper_tests / 4);
  }
}

TEST_CASE(
    "on kept wrappers the paper's recursion gives the answers of queries from scratch, with at most half of their "
    "comparisons at steps of 0.02 % of the size") {
  using namespace shapes;
  const LrbRep reps[] = {*generators::generate_rep(
                             "fractal", {{"real_faces", 144}, {"total_faces", 168}, {"outer_faces", 6}}, 2),
                         build_lrb(bumpy_sphere(2, 1, 0.4)), build_lrb(quad_torus(16, 8)),
                         build_lrb(comb_2d(5))};
  RandomEngine random(7);
  for (const LrbRep& rep : reps) {
    CAPTURE(rep.name());
    CollideRequest request;
    request.recursion = Recursion::paper;
    const double size = box_of(rep).diagonal().norm();
    Pose p = random_pose(random, rep, rep, 0.5);
    while (collide(rep, Pose{}, rep, p, request).pairs.empty()) p = random_pose(random, rep, rep, 0.5);
    CoherentQuery query(rep, rep, request);
    std::uint64_t kept_tests = 0, tests = 0, changed = 0;
    for (int step = 0; step < 120; ++step) {
      const bool jumps = step % 60 == 59;
      const Pose turn = Pose::rotation({0, 0, 1}, jumps ? 0.3 : 1e-4);
      p = {turn.r * p.r,
           p.t + (jumps ? 0.05 : 2e-4) * size * Eigen::Vector3d(0.6, step % 40 < 20 ? 0.8 : -0.8, 0)};
      const CollideResult expected = collide(rep, Pose{}, rep, p, request);
      const CollideResult& found = query.collide(Pose{}, p);
      CHECK(found.pairs == expected.pairs);
      CHECK(found.meets == expected.meets);
      CHECK(found.relation == expected.relation);
      for (int side = 0; side < 2; ++side) {
        auto ours = found.opened[side], theirs = expected.opened[side];
        std::sort(ours.begin(), ours.end());
        std::sort(theirs.begin(), theirs.end());
        CHECK(ours == theirs);
      }
      kept_tests += found.counters.face_tests;
      tests += expected.counters.face_tests;
      changed += step > 0 ? found.counters.refinements : 0;
    }
    CHECK(2 * kept_tests <= tests);
    CHECK(changed > 0);
    CHECK(query.statistics().coarsened > 0);
    if (rep.dim() == 2) continue;
    // Far away and back, and then with steps far below the way there; A moves as well.
    for (int step = 0; step < 60; ++step) {
      const double x = step == 0 ? 1e16 * size : (1.4 - 0.02 * step) * size;
      const Pose pose_a = Pose::translation({0, step > 30 ? 0.01 * size * step : 0, 0}),
                 pose_b = Pose::translation({x, 0.1 * size, 0});
      CHECK(query.collide(pose_a, pose_b).pairs == collide(rep, pose_a, rep, pose_b, request).pairs);
    }
    // Scaled: nothing may be kept.
    for (const double scale : {1.5, 1.0, 0.7}) {
      const Pose scaled = {p.r * scale, p.t};
      CHECK(query.collide(Pose{}, scaled).pairs == collide(rep, Pose{}, rep, scaled, request).pairs);
    }
  }
}
