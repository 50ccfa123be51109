#include "scenarios/profile/verdicts.hpp"

#include <limits>
#include <map>
#include <memory>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "scenarios/profile/prices.hpp"
#include "tests/support/faulty_engine.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>

namespace lrb::profile {

using namespace lrb::test;
using capture::ProbeShape, capture::QueryKind;

namespace {

QueryVerdict verdict_of(const capture::Capture& c, std::size_t query = 0,
                        Precision precision = Precision::float64) {
  CapturedBodies bodies(c);
  Checker checker(bodies, precision);
  const auto trees = bodies.trees_of(c.queries[query]);
  std::unique_ptr<QueryWalk> walk;
  if (trees) walk = std::make_unique<QueryWalk>(bodies, c.queries[query], *trees);
  return checker.check(c.queries[query], walk.get());
}

std::string first_sentence(const capture::Capture& c, const QueryVerdict& v) {
  const auto& trees = c.queries[v.number - 1].trees;
  return sentence(v.wrong.at(0), c.trees[trees[0]], trees[1] == kNull ? capture::Tree() : c.trees[trees[1]]);
}

Pose tilted(const Eigen::Vector3d& t = {0.05, 0.07, 0.02}) {
  return Pose::rotation({0.3, 0.5, 0.8}, 0.7, t);
}

/// Two sheets that cross.
struct Sheets {
  FaultyEngine engine;
  std::uint32_t a = 0, b = 0;
  Pose pose = Pose::rotation({1, 0.2, 0.1}, 1.1, {0.03, 0.45, -0.4});

  explicit Sheets(std::uint32_t leaf = 1) {
    std::mt19937_64 random(7);
    a = engine.grow(engine.add(sheet_mesh(5)), random, leaf);
    b = engine.grow(engine.add(sheet_mesh(4)), random, leaf);
  }
  capture::Query& ask(const FaultyQuery& how = {}) { return engine.ask(a, {}, b, pose, how); }
};

}  // namespace

TEST_CASE(
    "The exact pairs of captured meshes are those of all tests of two triangles, also for degenerate ones") {
  std::mt19937_64 random(1);
  std::uint64_t pairs = 0;
  for (int round = 0; round < 20; ++round) {
    FaultyEngine engine;
    const std::uint32_t a = engine.grow(engine.add(soup_mesh(random, 30)), random, 3);
    const std::uint32_t b = engine.grow(engine.add(soup_mesh(random, 25)), random, 2);
    const capture::Query& q = engine.ask(a, tilted(), b, Pose::translation({0.1, 0, 0}));
    std::vector<TrianglePair> expected;
    for (std::uint32_t f = 0; f < 30; ++f)
      for (std::uint32_t g = 0; g < 25; ++g)
        if (triangles_meet(engine.capture.meshes[0], f, q.poses[0], engine.capture.meshes[1], g, q.poses[1]))
          expected.push_back({f, g});
    const QueryVerdict v = verdict_of(engine.capture);
    CHECK(v.exact == expected);
    CHECK(v.outcome == Judgement::right);
    CHECK(v.right == expected.size());
    pairs += v.right;
  }
  CHECK(pairs > 100);
}

TEST_CASE("A box that was shrunk is blamed, with its node, axis and how far the triangle sticks out") {
  for (const std::size_t side : {0, 1}) {
    Sheets s;
    const QueryVerdict sound = verdict_of((s.ask(), s.engine.capture));
    REQUIRE(sound.outcome == Judgement::right);
    REQUIRE(sound.exact.size() > 5);
    const auto of = [&](const TrianglePair& p) { return side == 0 ? p.a : p.b; };
    // The leaf of a triangle that intersects.
    const std::uint32_t f = of(sound.exact[sound.exact.size() / 2]), t = side == 0 ? s.a : s.b;
    const std::uint32_t leaf = TreeIndex(s.engine.capture.trees[t], side == 0 ? 50 : 32).leaf[f];
    auto& volumes = s.engine.capture.trees[t].volumes;
    volumes[6 * leaf + 2] += 100, volumes[6 * leaf + 5] += 100;  // far away
    s.engine.capture.queries.clear();
    s.ask();
    const QueryVerdict v = verdict_of(s.engine.capture);
    CHECK(v.outcome == Judgement::wrong);
    CHECK(v.answer == Judgement::right);  // other pairs make the verdict right
    CHECK(v.missed == std::ranges::count(sound.exact, f, of));
    for (const WrongPair& w : v.wrong) {
      CHECK(of(w.triangles) == f);
      CHECK(w.culprit == Culprit::volumes);
      CHECK(w.nodes[side] == leaf);
      CHECK(w.outside[side] == doctest::Approx(100));
      CHECK(w.outside[1 - side] == 0);
      CHECK(w.margin > w.bound);
      CHECK(cause_of(w) == "missed; cause: volumes, from which a triangle sticks out");
    }
    CHECK(first_sentence(s.engine.capture, v)
              .find("triangle " + std::to_string(f) + " sticks out of its node by 100") != std::string::npos);
  }
}

TEST_CASE("A test of triangles that lies is blamed, in both directions") {
  Sheets s;
  const std::vector<TrianglePair> exact = verdict_of((s.ask(), s.engine.capture)).exact;
  std::set<NumberPair> disjoint;
  for (const capture::Event& e : s.engine.capture.queries[0].events)
    if (e.kind == capture::EventKind::triangles && e.met == 0) disjoint.insert({e.a, e.b});
  REQUIRE(!disjoint.empty());
  FaultyQuery how;
  how.lies = {{exact[0].a, exact[0].b}, *disjoint.begin()};
  s.ask(how);
  const QueryVerdict v = verdict_of(s.engine.capture, 1);
  CHECK(v.outcome == Judgement::wrong);
  CHECK(v.missed == 1);
  CHECK(v.extra == 1);
  REQUIRE(v.wrong.size() == 2);
  CHECK(v.wrong[0].missed);
  CHECK(v.wrong[0].culprit == Culprit::triangle_test);
  CHECK(v.wrong[0].triangles == exact[0]);
  CHECK_FALSE(v.wrong[1].missed);
  CHECK(v.wrong[1].triangles == TrianglePair{(*disjoint.begin())[0], (*disjoint.begin())[1]});
  CHECK(v.wrong[1].margin > 0);
}

TEST_CASE("a traversal that omits a pair of children is blamed at that pair, also for wide nodes") {
  for (const bool wide : {false, true}) {
    CAPTURE(wide);
    Sheets s;
    FaultyQuery how;
    how.wide = wide;
    how.order = wide ? OpeningOrder::both : OpeningOrder::larger;
    const std::vector<capture::Event> events = s.ask(how).events;
    // The pair whose forgotten child costs most.
    int blamed = 0;
    for (const capture::Event& e : events) {
      if (e.kind != capture::EventKind::nodes || e.met == 0) continue;
      if (s.engine.capture.trees[s.a].is_leaf(e.a) && s.engine.capture.trees[s.b].is_leaf(e.b)) continue;
      how.forgetful = NumberPair{e.a, e.b};
      s.engine.capture.queries.clear();
      s.ask(how);
      const QueryVerdict v = verdict_of(s.engine.capture);
      for (const WrongPair& w : v.wrong) {
        CHECK(w.culprit == Culprit::traversal);
        CHECK(w.nodes == *how.forgetful);
        ++blamed;
      }
    }
    CHECK(blamed > 20);
  }
}

TEST_CASE("A triangle in no leaf is blamed") {
  Sheets s(2);
  const TrianglePair lost = verdict_of((s.ask(), s.engine.capture)).exact[2];
  auto& triangles = s.engine.capture.trees[s.b].triangle;
  // Another triangle takes its place, so that one is in two leaves and one in none.
  std::replace(triangles.begin(), triangles.end(), lost.b, lost.b == 0 ? 1U : 0U);
  s.ask();
  const QueryVerdict v = verdict_of(s.engine.capture, 1);
  REQUIRE(v.missed > 0);
  for (const WrongPair& w : v.wrong) {
    CHECK(w.culprit == Culprit::in_no_leaf);
    CHECK(w.in_leaf == std::array{true, false});
    CHECK(w.triangles.b == lost.b);
  }
}

TEST_CASE("The depth of two triangles is the shortest translation that separates them") {
  const Triangle flat{Eigen::Vector3d(0, 0, 0), {4, 0, 0}, {0, 4, 0}};
  const Triangle pierces{Eigen::Vector3d(1, 1, -0.25), {1, 1, 3}, {1.5, 1.2, 3}};
  CHECK(overlap_depth(flat, pierces) == doctest::Approx(0.25));
  CHECK(overlap_depth(pierces, flat) == doctest::Approx(0.25));
  // In one plane, and degenerate ones: a motion out of the plane separates them.
  CHECK(overlap_depth(flat, Triangle{Eigen::Vector3d(1, 1, 0), {2, 1, 0}, {1, 2, 0}}) == 0);
  CHECK(overlap_depth(Triangle{flat[0], flat[1], flat[0]}, Triangle{flat[0], flat[1], flat[1]}) ==
        doctest::Approx(0));
  CHECK(overlap_depth(flat, Triangle{Eigen::Vector3d(1, 1, 0), {1, 1, 0}, {1, 1, 0}}) == doctest::Approx(0));
  // No direction of many separates random ones by less.
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  int compared = 0;
  for (int round = 0; round < 300; ++round) {
    const Triangle a{vector(), vector(), vector()}, b{vector(), vector(), vector()};
    const double depth = overlap_depth(a, b);
    if (depth == 0) continue;
    ++compared;
    double least = 1e300;
    for (int k = 0; k < 3000; ++k) {
      const Eigen::Vector3d axis = vector().normalized();
      const auto ends = [&](const Triangle& t) {
        return std::minmax({axis.dot(t[0]), axis.dot(t[1]), axis.dot(t[2])});
      };
      const auto [low_a, high_a] = ends(a);
      const auto [low_b, high_b] = ends(b);
      least = std::min(least, std::min(high_a - low_b, high_b - low_a));
    }
    CHECK(depth <= least + 1e-12);
    CHECK(least < depth + 0.3);  // close to it, so that the comparison means something
  }
  CHECK(compared > 50);
}

TEST_CASE("Errors about triangles within the error of a float or double are undecidable, others are wrong") {
  // A triangle whose lowest corner is `height` above, or below, the middle of another.
  const auto touching = [](double height, bool reported) {
    FaultyEngine engine;
    std::mt19937_64 random(1);
    const std::uint32_t a =
        engine.grow(engine.add(triangle_mesh({Eigen::Vector3d(0, 0, 1), {4, 0, 1}, {0, 4, 1}})), random);
    const std::uint32_t b = engine.grow(
        engine.add(triangle_mesh({Eigen::Vector3d(1, 1, 1 + height), {1, 1, 3}, {1.5, 1.2, 3}})), random);
    capture::Query& q = engine.ask(a, {}, b, {});
    q.events = {{.a = 0, .b = 0, .met = 1},
                {.a = 0, .b = 0, .kind = capture::EventKind::triangles, .met = reported}};
    q.verdict = reported ? capture::Verdict::intersecting : capture::Verdict::separate;
    q.pairs = reported;
    FaultyEngine::close(q);
    return engine.capture;
  };
  const double ulp = std::numeric_limits<double>::epsilon(),
               float_ulp = std::numeric_limits<float>::epsilon();
  for (const double height : {ulp, -ulp, 4 * ulp, -4 * ulp}) {
    const QueryVerdict v = verdict_of(touching(height, height > 0));
    CHECK(v.outcome == Judgement::undecidable);
    CHECK(v.answer == Judgement::undecidable);
    CHECK(v.undecidable == 1);
    CHECK(v.missed + v.extra == 0);
    REQUIRE(v.wrong.size() == 1);
    CHECK(v.wrong[0].margin == doctest::Approx(std::abs(height)));
    CHECK(v.wrong[0].missed == (height < 0));
  }
  for (const double height : {float_ulp, -float_ulp}) {
    CHECK(verdict_of(touching(height, height > 0), 0, Precision::float32).outcome == Judgement::undecidable);
    CHECK(verdict_of(touching(height, height > 0), 0, Precision::float64).outcome == Judgement::wrong);
  }
  CHECK(verdict_of(touching(1e-3, true), 0, Precision::float32).outcome == Judgement::wrong);
  CHECK(verdict_of(touching(1e-3, false), 0, Precision::float32).outcome == Judgement::right);
  capture::Capture counted = touching(-ulp, false);  // a pair that may be missed is none to be counted twice
  counted.queries[0].verdict = capture::Verdict::intersecting, counted.queries[0].pairs = 2;
  CHECK(verdict_of(counted).answer == Judgement::wrong);
}

TEST_CASE("The number format is that of the volumes") {
  Sheets s;
  CHECK(precision_of(s.engine.capture) == Precision::float64);  // 1/5
  for (capture::Tree& t : s.engine.capture.trees)
    for (double& x : t.volumes) x = static_cast<float>(x);
  CHECK(precision_of(s.engine.capture) == Precision::float32);
}

TEST_CASE("A query of kind any is checked by its verdict and its tests, not by the pairs that it left out") {
  Sheets s;
  FaultyQuery how;
  how.kind = QueryKind::any;
  const capture::Query q = s.ask(how);
  REQUIRE(q.verdict == capture::Verdict::intersecting);
  QueryVerdict v = verdict_of(s.engine.capture);
  CHECK(v.outcome == Judgement::right);
  CHECK(v.exact_pairs > 5);
  CHECK(v.right == 1);
  // The same tests with the opposite verdict: then all pairs are missed.
  s.engine.capture.queries[0].verdict = capture::Verdict::separate;
  v = verdict_of(s.engine.capture);
  CHECK(v.answer == Judgement::wrong);
  CHECK(v.missed == v.exact_pairs - 1);
  // A lie on the way does not change the verdict, but is found.
  for (const capture::Event& e : q.events)
    if (e.kind == capture::EventKind::triangles && e.met > 0) how.lies.insert({e.a, e.b});
  s.ask(how);
  v = verdict_of(s.engine.capture, 1);
  CHECK(v.answer == Judgement::right);
  CHECK(v.missed == 1);
  CHECK(v.wrong[0].culprit == Culprit::triangle_test);
}

TEST_CASE("The distance that an engine recorded is compared with the proven one") {
  using capture::Verdict;
  struct Case {
    double lower, upper;  // relative to the distance
    Judgement outcome;
  };
  const Case cases[] = {{1, 1, Judgement::right},     {0.5, 2, Judgement::right},
                        {1.1, 1.1, Judgement::wrong}, {0.9, 0.9, Judgement::wrong},
                        {-1, 0, Judgement::wrong},    {1 + 2e-6, 1 + 2e-6, Judgement::undecidable},
                        {-1, 1.5, Judgement::right}};
  Sheets sheets;
  capture::Query& q = sheets.engine.ask(sheets.a, Pose::translation({0, 0, -4}), sheets.b, sheets.pose);
  q.kind = QueryKind::distance;
  q.verdict = Verdict::separate;
  const capture::Capture& c = sheets.engine.capture;
  CapturedBodies bodies(c);
  DistanceRequest request;
  request.relation = false;
  Workspace workspace;
  const double exact =
      distance(*bodies.body(0), q.poses[0], *bodies.body(1), q.poses[1], request, workspace).value().upper;
  REQUIRE(exact > 1);
  for (const Verdict verdict : {Verdict::separate, Verdict::unreported})
    for (const Case& k : cases) {
      CAPTURE(k.lower);
      q.verdict = verdict;
      q.value = {k.lower * exact, k.upper * exact};
      const QueryVerdict v = verdict_of(c, 0, Precision::float32);
      CHECK(v.outcome == k.outcome);
      CHECK((v.remark.find("the engine's distance is") != std::string::npos) ==
            (k.outcome == Judgement::wrong));
    }
  // Bodies that intersect: 0, or a negative number.
  Sheets crossing;
  capture::Query& touching = crossing.ask();
  touching.kind = QueryKind::distance;
  for (const auto& [value, outcome] :
       {std::pair{-1.0, Judgement::right}, {0.0, Judgement::right}, {0.1, Judgement::wrong}}) {
    touching.value = {value, value};
    CHECK(verdict_of(crossing.engine.capture).outcome == outcome);
  }
}

namespace {

/// Triangles in the unit cube, with rays, points and boxes around it.
struct Probes {
  FaultyEngine engine;
  std::mt19937_64 random{11};
  std::uint32_t tree = engine.grow(engine.add(soup_mesh(random, 60)), random, 2);
  const capture::Mesh mesh = engine.capture.meshes[0];

  capture::Probe probe(ProbeShape shape) {
    capture::Probe out{shape, {}};
    auto& n = out.numbers;
    for (double& x : n) x = 1.4 * static_cast<double>(random() >> 11) * 0x1p-53 - 0.2;
    n[6] -= 1, n[7] = n[7] < 0.5 ? std::numeric_limits<double>::infinity() : n[6] + n[7];
    for (std::size_t k = 0; k < 3; ++k)
      n[k + 3] = shape == ProbeShape::ray ? n[k + 3] - n[k] : n[k] + std::abs(n[k + 3]) / 2;
    return out;
  }
  capture::Capture& ask(const capture::Probe& probe, const FaultyQuery& how = {}, const Pose& pose = {}) {
    return engine.ask(tree, pose, probe, how), engine.capture;
  }
};

/// Möller and Trumbore 1997.
std::optional<double> ray_hit(const capture::Probe& ray, const Triangle& t) {
  const auto& n = ray.numbers;
  const Eigen::Vector3d o(n[0], n[1], n[2]), d(n[3], n[4], n[5]), u = t[1] - t[0], v = t[2] - t[0],
                                                                  p = d.cross(v), q = (o - t[0]).cross(u);
  const double det = u.dot(p), a = (o - t[0]).dot(p) / det, b = d.dot(q) / det, at = v.dot(q) / det;
  return a >= 0 && b >= 0 && a + b <= 1 && at >= n[6] && at <= n[7] ? std::optional(at) : std::nullopt;
}

}  // namespace

TEST_CASE("Rays, points and boxes hit the triangles that an independent test finds") {
  Probes s;
  capture::Mesh posed = s.mesh;
  for (Eigen::Vector3d& x : posed.vertices) x = tilted().apply(x);
  std::array<std::uint64_t, 4> hits{};
  std::size_t all = 0;
  for (const auto shape : {ProbeShape::ray, ProbeShape::point, ProbeShape::box})
    for (std::uint32_t round = 0; round < 100; ++round) {
      capture::Probe probe = s.probe(shape);
      const bool at_corner = round % 3 == 0;
      if (at_corner && shape != ProbeShape::box)
        std::copy_n(corners_of(posed, round % 60)[1].data(), 3, probe.numbers.data());
      if (shape == ProbeShape::box && round % 9 == 1)  // around everything
        probe.numbers = {-9, -9, -9, 9, 9, 9};
      if (shape == ProbeShape::ray && round % 7 == 1) probe.numbers[6] = -1e20;  // nearly a line
      const QueryVerdict v = verdict_of(s.ask(probe, {}, tilted()), all++, Precision::float32);
      CHECK(v.outcome != Judgement::wrong);
      hits[static_cast<std::size_t>(shape)] += v.exact_pairs;
      if (shape != ProbeShape::ray || at_corner) continue;
      std::vector<TrianglePair> expected;
      for (std::uint32_t f = 0; f < 60; ++f)
        if (ray_hit(probe, corners_of(posed, f))) expected.push_back({f, 0});
      CHECK(v.exact == expected);
    }
  CHECK(hits[1] > 60);
  CHECK(hits[2] > 0);
  CHECK(hits[3] > 500);
}

TEST_CASE("The faults of a ray tracer are named by node and triangle; its first hit may hide others") {
  Probes s;
  capture::Probe ray{ProbeShape::ray, {0.1, 0.2, -3, 0.1, 0.08, 2, 0, 100}};
  std::map<double, std::uint32_t> hits;
  for (std::uint32_t f = 0; f < 60; ++f)
    if (const auto at = ray_hit(ray, corners_of(s.mesh, f))) hits[*at] = f;
  REQUIRE(hits.size() > 1);
  const auto priced = [&](std::size_t query) {
    CapturedBodies bodies(s.engine.capture);
    const capture::Query& q = s.engine.capture.queries[query];
    const QueryWalk walk(bodies, q, bodies.trees_of(q).value());
    const QueryVerdict v = Checker(bodies, Precision::float64).check(q, &walk);
    return PriceBook(bodies).add(q, &walk, v.exact, true);
  };
  const QueryVerdict sound = verdict_of(s.ask(ray));
  CHECK(sound.outcome == Judgement::right);
  CHECK(sound.exact.size() == hits.size());
  const Prices all = priced(0);
  CHECK(all.needed > hits.size());
  CHECK(all.needed + all.proof + all.volumes == all.visits);
  // A test of triangles that lies; a box that is elsewhere.
  FaultyQuery how;
  for (const capture::Event& e : s.engine.capture.queries[0].events)
    if (e.kind == capture::EventKind::triangles && e.met == 0) how.lies = {{e.a, 0}};
  CHECK(first_sentence(s.engine.capture, verdict_of(s.ask(ray, how), 1))
            .starts_with("false " + std::to_string(how.lies.begin()->front()) + ": it is not hit (gap "));
  how = {.kind = QueryKind::distance};
  s.ask(ray, how);
  // Visits behind the first hit are of order. A ray that ends there has none.
  const Prices whole = priced(2);
  CHECK(whole.order > 0);
  CHECK(whole.needed + whole.proof + whole.volumes + whole.order == whole.visits);
  ray.numbers[7] = hits.begin()->first * (1 + 1e-9);
  s.ask(ray, how);
  CHECK(priced(3).order == 0);
  // Distances of a point, and of a box, which is 0 around the triangles.
  for (const auto& [probe, distance] : {std::pair{capture::Probe{ProbeShape::point, {0.5, 0.5, -9}}, 8.0},
                                        {{ProbeShape::box, {-9, -9, -9, 9, 9, 9}}, 0.0}})
    for (const double wrong : {0.0, 3.0}) {
      capture::Query& q = s.ask(probe, how).queries.back();
      q.value = {distance + wrong, distance + wrong + (distance > 0 ? 2 : 0)};
      CHECK((verdict_of(s.engine.capture, q.number - 1).outcome == Judgement::wrong) == (wrong > 0));
    }
  // A multiple below 0: the origin is behind the triangles.
  capture::Probe behind = ray;
  for (std::size_t k = 0; k < 3; ++k) behind.numbers[k] += 10 * ray.numbers[k + 3];
  behind.numbers[6] = -100;
  for (const double wrong : {0.0, 0.1}) {
    capture::Query& q = s.ask(behind, how).queries.back();
    q.value = {hits.begin()->first - 10 + wrong, hits.begin()->first - 10 + wrong};
    CHECK((verdict_of(s.engine.capture, q.number - 1).outcome == Judgement::wrong) == (wrong > 0));
    const Prices same = priced(q.number - 1);
    CHECK(std::array{same.needed, same.volumes, same.order} ==
          std::array{whole.needed, whole.volumes, whole.order});
  }
  // A node whose box is elsewhere.
  auto& volumes = s.engine.capture.trees[s.tree].volumes;
  const std::uint32_t f = hits.begin()->second, leaf = TreeIndex(s.engine.capture.trees[s.tree], 60).leaf[f];
  volumes[6 * leaf] = 50, volumes[6 * leaf + 3] = 51;
  s.engine.capture.queries.clear();
  CHECK(first_sentence(s.engine.capture, verdict_of(s.ask(ray)))
            .starts_with("missed " + std::to_string(f) + ": node " + std::to_string(leaf) +
                         ", which contains it, and the probe were found disjoint"));
}

TEST_CASE("What rounding explains of hits of rays, boxes and their number is undecidable, and no more") {
  const double tiny = 1e-15;
  struct Case {
    Eigen::Vector2d edge, height;  // of triangles that are hit if the edge is at 0 or below
    std::set<NumberPair> lies;
    double value;
    Judgement outcome;
  };
  for (const Case& k : {Case{{-1, -1}, {5, 7}, {}, 5, Judgement::right},
                        {{-1, -1}, {5, 7}, {}, 5 + 8 * tiny, Judgement::right},
                        {{-1, -1}, {5, 7}, {}, 5 + 1e-12, Judgement::wrong},
                        {{-1, -1}, {5, 7}, {{0, 0}}, 7, Judgement::wrong},
                        {{-1, -1}, {5, 5 + 4 * tiny}, {{0, 0}}, 5, Judgement::right},
                        {{-tiny, -1}, {2, 5}, {{0, 0}}, 5, Judgement::undecidable},
                        {{tiny, -1}, {2, 5}, {{0, 0}, {1, 0}}, 2, Judgement::undecidable}}) {
    auto c = capture_of(mesh_across_z(k.edge, k.height), ray_along_z(), QueryKind::distance, k.lies);
    c.queries[0].value = {k.value, k.value};
    const QueryVerdict v = verdict_of(c);
    CHECK(v.outcome == k.outcome);
    CHECK(v.missed == (k.value == 7));  // the second hit does not hide the first
  }
  // One of two hits is counted, or two of one.
  for (const double x : {-1.0, -tiny, tiny, 1e-9}) {
    auto c = capture_of(mesh_across_z({x, -1}, {2, 5}), ray_along_z(), QueryKind::all_pairs, {{0, 0}});
    c.queries[0].pairs = x < 0 ? 1 : 2, ++c.queries[0].events_seen;
    CHECK(verdict_of(c).answer == (std::abs(x) == tiny ? Judgement::undecidable : Judgement::wrong));
  }
  // A triangle dips into a long box, or not quite; the error is that of the box, which is larger.
  const capture::Probe box{ProbeShape::box, {-1, -1, -1, 1e6, 1, 1}};
  for (const double depth : {0.5, 1e-10, -1e-10, -0.5}) {
    const auto mesh = triangle_mesh({Eigen::Vector3d(9, 1 - depth, 0), {8, 3, 0}, {10, 3, 0}});
    CHECK(verdict_of(capture_of(mesh, box, QueryKind::all_pairs, {{0, 0}})).outcome ==
          (std::abs(depth) < 0.1 ? Judgement::undecidable : Judgement::wrong));
  }
}

TEST_CASE("The bounds of a hit of a narrow triangle cover the rounding of its normal") {
  using Exact = Eigen::Matrix<long double, 3, 1>;
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
  for (int i = 0; i < 2000; ++i) {
    // Narrow, and nearly along the ray, which passes near the first corner.
    const double width = std::exp2(-20 - 10 * any(random)), steep = std::exp2(-5 - 5 * any(random));
    const Eigen::Vector3d along = vector().cwiseProduct(Eigen::Vector3d(steep, steep, 1));
    const Eigen::Vector3d across = width * vector();
    const Eigen::Vector3d corner = -0.5 * along - 0.25 * across + Eigen::Vector3d(0, 0, 3);
    const auto mesh = triangle_mesh({corner, corner + along, corner + 0.5 * along + across});
    auto c = capture_of(mesh, ray_along_z(), QueryKind::distance);
    const std::vector<Eigen::Vector3d>& v = mesh.vertices;
    const Exact first = v[0].cast<long double>();
    const Exact u = v[1].cast<long double>() - first, w = v[2].cast<long double>() - first;
    const Exact normal = u.cross(w);
    const auto hit = static_cast<double>(normal.dot(first) / normal[2]);
    const auto [least, greatest] = hit_of(c.queries[0], mesh, 0, 0x1p-50);
    CAPTURE(width);
    CHECK(least <= hit);
    CHECK(greatest >= hit);
  }
}

TEST_CASE("A self query is checked for triangles without a common vertex") {
  FaultyEngine engine;
  std::mt19937_64 random(5);
  capture::Mesh mesh = sheet_mesh(3);
  // A triangle across the sheet, connected to none.
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(0.5, 0.4, -1), {0.5, 0.4, 1}, {0.9, 0.7, 1}})
    mesh.vertices.push_back(v);
  mesh.triangles.push_back({16, 17, 18});
  const std::uint32_t a = engine.grow(engine.add(mesh), random);
  FaultyQuery how;
  how.kind = QueryKind::self;
  engine.ask(a, tilted(), a, tilted(), how);
  const QueryVerdict v = verdict_of(engine.capture);
  CHECK(v.outcome == Judgement::right);
  CHECK(v.exact_pairs > 0);
  for (const TrianglePair& p : v.exact) CHECK(p.b == 18);
  // Only one of both trees is named; and a lie about the triangle across.
  how.lies = {{v.exact[0].a, 18}, {18, v.exact[0].a}};
  engine.ask(a, {}, a, {}, how).trees[1] = kNull;
  const QueryVerdict lied = verdict_of(engine.capture, 1);
  CHECK(lied.missed == 1);
  CHECK(lied.wrong[0].triangles == v.exact[0]);
}

}  // namespace lrb::profile
