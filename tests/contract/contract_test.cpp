// The promises of every query of two bodies: the same answer in a workspace, with a probe, on any number of
// threads and through every door to a body; reported bounds that only narrow; one line for each rejection;
// and an answer that moves with the world.

#include <doctest/doctest.h>

#include "engine/collide/tree_query.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/contract/queries.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/float_modes.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::contract {
namespace {

using Eigen::Vector3d;
using shapes::RandomEngine;
using test::content;
using test::error_of;

/// Bodies with and without regions, open, crossing themselves, tiny, and in the plane.
const std::vector<LrbRep>& bodies() {
  static const std::vector<LrbRep> list = {
      build_lrb(shapes::bumpy_sphere(2, 4)),
      build_lrb(shapes::torus(16, 8)),
      build_lrb(shapes::box()),
      test::open_body(shapes::open_cylinder(9)),
      LrbRep::without_regions(
          shapes::several({shapes::quad_box(), shapes::translated(shapes::quad_box(), {0.5, 0.25, 0.125})}),
          true, true),
      build_lrb(shapes::ring_2d(12)),
      test::closed(shapes::star(5))};
  return list;
}

/// Two bodies of the same dimension, from deep contact to far apart; every fifth B is scaled or mirrored.
Case any_case(RandomEngine& random, bool flat_too = true) {
  const auto& list = bodies();
  const std::size_t n = flat_too ? list.size() : list.size() - 2;
  const LrbRep* const a = &list[random() % n];
  const LrbRep* b = &list[random() % n];
  while (b->dim() != a->dim()) b = &list[random() % n];
  Case c{a, b, {}, shapes::random_pose(random, *a, *b, shapes::uniform(random, 0, 1.2))};
  const Pose frame = test::any_pose_within(random, 3, a->dim());
  c.pose_a = frame;
  c.pose_b = {frame.r * c.pose_b.r, frame.apply(c.pose_b.t)};
  if (random() % 5 == 0) c.pose_b.r *= random() % 2 == 0 ? 0.5 : 1.01;
  return c;
}

template <class Q>
bool takes(const Case& c) {
  return c.a->dim() == 3 || !std::is_same_v<Q, Clash>;
}

}  // namespace

TEST_CASE_TEMPLATE("a query has the same answer in a workspace, with a probe and on any number of threads", Q,
                   Collide, Distance, Clash, FirstContact, Near, Manifold) {
  RandomEngine random(7);
  Workspace workspace;  // one for all bodies and requests
  std::size_t events = 0;
  const std::vector<typename Q::Request> requests = Q::requests();
  for (int i = 0; i < 42; ++i) {
    CAPTURE(i);
    const Case c = any_case(random);
    if (!takes<Q>(c)) continue;
    const auto& request = requests[static_cast<std::size_t>(i) % requests.size()];
    const auto expected = content(Q::ask(c, request));
    const test::InMode any_mode(i);
    CHECK((content(Q::ask(c, request, workspace).value()) == expected));
    for (const unsigned threads : {2U, 5U}) CHECK((content(Q::ask(c, request, threads)) == expected));
    if constexpr (Watched<Q>) {
      typename Q::Probe alone, inside;
      CHECK((content(Q::ask(c, request, alone)) == expected));
      CHECK((content(Q::ask(c, request, workspace, &inside).value()) == expected));
      CHECK((Q::events(alone) == Q::events(inside)));
      if constexpr (requires { alone.events.size(); }) events += alone.events.size();
      if constexpr (requires { alone.history.size(); }) events += alone.history.size();
      if constexpr (requires { alone.of_depth.size(); })
        events += alone.of_depth.size() + alone.of_distance.size();
    }
  }
  if constexpr (Watched<Q>) CHECK(events > 60);
}

TEST_CASE_TEMPLATE("a query rejects in one line what it cannot answer, alone and in a workspace, and goes on",
                   Q, Collide, Distance, Clash, FirstContact, Near, Manifold) {
  const LrbRep &box = bodies()[2], &flat = bodies()[6];
  const Case good{&box, &box, {}, Pose::translation({0.5, 0.25, 0.125})};
  Workspace workspace;
  const auto rejected = [&](const Case& c, const typename Q::Request& request, const std::string& part) {
    CAPTURE(part);
    const std::string reason = error_of([&] { static_cast<void>(Q::ask(c, request)); });
    CHECK(!reason.empty());
    CHECK(reason.find(part) != std::string::npos);
    CHECK(reason.find('\n') == std::string::npos);
    const auto answer = Q::ask(c, request, workspace);
    REQUIRE(!answer.has_value());
    CHECK(answer.error().reason == reason);
    CHECK((content(Q::ask(good, Q::requests()[0], workspace).value()) ==
           content(Q::ask(good, Q::requests()[0]))));
    return reason;
  };
  for (const auto& [request, part] : Q::rejected())
    CHECK(rejected(good, request, part) == error_of([&, &of = request] { Q::check(box, of); }));
  Q::check(box, Q::requests()[0]);
  if constexpr (!std::is_same_v<Q, FirstContact>)  // a motion through such a pose is no motion
    for (const double bad : {kNaN, kInfinite}) {
      const Case c{&box, &box, {}, Pose::translation({bad, 0, 0})};
      CHECK(rejected(c, {}, "expected a pose of 12 finite numbers") ==
            error_of([&] { check_query(box, {}, box, c.pose_b); }));
    }
  rejected({&box, &flat, {}, {}}, {}, "");
  if constexpr (std::is_same_v<Q, Clash>) rejected({&flat, &flat, {}, {}}, {}, "expected 3D bodies");
  const LrbRep nothing = test::open_body(Mesh{});
  CHECK_NOTHROW(static_cast<void>(Q::ask({&box, &nothing, {}, {}}, {})));
  if constexpr (requires { Q::limited(1); }) {
    rejected(good, Q::limited(3), "more than 3 pairs");
    CHECK(!Q::ask(good, Q::limited(10'000)).pairs.empty());
  }
}

namespace {

/// Checks that bounds narrow while work grows, and contain an interval that contains the number.
void check_narrowing(const std::vector<Bounds>& history, double lower, double upper, double rounding = 0) {
  Bounds before{0, 0, kInfinite};
  for (const Bounds& now : history) {
    CAPTURE(now.work);
    CHECK(now.work >= before.work);
    CHECK(now.lower >= before.lower);
    CHECK(now.upper <= before.upper * (1 + rounding));
    CHECK(now.lower <= upper);
    CHECK(now.upper >= lower * (1 - rounding));
    before = now;
  }
}

}  // namespace

TEST_CASE("reported bounds of distances only narrow, and end at the answer") {
  RandomEngine random(8);
  const LrbRep ball = test::closed(shapes::icosphere(4)), small = test::closed(shapes::icosphere(2));
  Pose squeezed = Pose::translation({3, 1, 0.5});
  squeezed.r = Vector3d(1, 0.5, 0.25).asDiagonal();  // walked in doubles
  std::vector<Case> cases = {{&ball, &ball, {}, squeezed},
                             {&ball, &ball, {}, Pose::translation({2.3, 0.4, 0.2})}};
  for (int i = 0; i < 12; ++i) {  // from meeting to far apart
    const Eigen::Matrix3d r = shapes::random_rotation(random);
    cases.push_back(
        {&ball, &small, {shapes::random_rotation(random), {0, 0, 0}}, {r, r * Vector3d(0.4 * i, 0.1, 0.05)}});
  }
  for (const Case& c : cases) {
    const DistanceResult exact = Distance::ask(c, {});
    for (const DistanceRequest& request : Distance::requests()) {
      BoundsHistory reported;
      const DistanceResult r = Distance::ask(c, request, reported);
      REQUIRE(!reported.history.empty());
      check_narrowing(reported.history, exact.lower, exact.upper);
      CHECK(reported.history.back().lower >= r.lower);
      CHECK(reported.history.back().upper <= r.upper);
      if (request.within || request.max_steps > 0) continue;
      if (request.relative_tolerance > 0) {
        CHECK(r.upper - r.lower <= request.relative_tolerance * r.upper);
        continue;
      }
      CHECK(reported.history.back().lower == r.lower);
      CHECK(reported.history.back().upper == r.upper);
      CHECK(reported.history.back().work ==
            r.counters.steps + r.counters.pairs_in_doubles + r.counters.pairs_exact);
      if (&c - cases.data() > 1) continue;
      CHECK(reported.history.size() > 5);
      CHECK(reported.history.front().lower < 0.99 * r.lower);
    }
  }
}

TEST_CASE("reported bounds of first contacts only narrow, with the distance on the way") {
  const LrbRep ball = test::closed(shapes::icosphere(3));
  Pose stretched = Pose::translation({6, 0.1, 0.2});
  stretched.r = Vector3d(1, 0.5, 2).asDiagonal();  // searched by distances
  std::vector<Motion> motions = {
      Motion::linear(stretched, {-6, 0.1, 0.2}),
      Motion::linear(Pose::translation({5, 2.5, 0}), {-5, 2.5, 0}),  // passes
      Motion::linear(Pose::translation({1, 0, 0}), {-5, 0, 0})};     // begins in contact
  for (const double aside : {0.0, 0.7, 1.7})
    motions.push_back(
        Motion::turning(Pose::translation({5, aside, 0.1}), {0, 0, 0.9}, {5, aside, 0.1}, {-10, 0, 0}));
  for (const Motion& motion : motions) {
    FirstContactHistory reported;
    const FirstContactResult r = first_contact(ball, Motion::still({}), ball, motion, {}, reported);
    std::vector<Bounds> times;
    for (const ContactBounds& now : reported.history) {
      times.push_back({now.work, now.t0, now.t1});
      const DistanceResult there = distance(ball, {}, ball, motion.at(now.t0));
      CHECK(now.lower <= there.upper);
      CHECK(now.upper >= there.lower);
      CHECK(now.upper - now.lower <= 0.011 * now.upper + 1e-13);
      if (now.t0 < r.t0) CHECK(now.lower > 0);
    }
    check_narrowing(times, r.t0, r.is_contact() ? r.t1 : kInfinite);
    REQUIRE(!times.empty());
    CHECK(times.size() >= (r.at_start ? 1 : r.is_contact() ? 3 : 2));
    CHECK(times.front().lower == 0);
    CHECK(times.back().lower == r.t0);
    CHECK(times.back().upper == (r.is_contact() ? r.t1 : kInfinite));
    CHECK((reported.history.back().upper == 0) == r.at_start);
  }
}

TEST_CASE("reported bounds of clashes only narrow, and end at the answer") {
  const LrbRep ball = test::closed(shapes::icosphere(3)), box = test::closed(shapes::box()),
               torus = test::closed(shapes::torus(24, 12, 1, 0.35));
  const auto ask = [](const LrbRep& a, const LrbRep& b, const Pose& pose_a, const Pose& pose_b,
                      ClashHistory& reported) {
    return Clash::ask({&a, &b, pose_a, pose_b}, {}, reported);
  };
  struct {
    const LrbRep *a, *b;
    Pose pose;
  } const deep[] = {{&ball, &ball, Pose::translation({1.1, 0.3, 0.2})},
                    {&torus, &ball, Pose::translation({1.9, 0.1, 0.3})}};
  for (const auto& [a, b, pose] : deep) {
    ClashHistory reported;
    const ClashResult r = ask(*a, *b, {}, pose, reported);
    REQUIRE(r.depth.has_value());
    REQUIRE(reported.of_depth.size() >= 2);
    CHECK(reported.of_distance.empty());
    // The proof of the last upper bound is slightly larger than the bound.
    check_narrowing(reported.of_depth, r.depth->lower, r.depth->upper, 1e-9);
    CHECK(reported.of_depth.back().lower == r.depth->lower);
    CHECK(reported.of_depth.back().upper == r.depth->upper);
    if (a == b) CHECK(std::isinf(reported.of_depth.front().upper));  // convex: from both ends
  }
  ClashHistory apart, touching, far;
  const ClashResult gap = ask(box, box, {}, Pose::translation({1.5, 0.25, 0.25}), apart);
  CHECK(apart.of_depth.empty());
  REQUIRE(!apart.of_distance.empty());
  check_narrowing(apart.of_distance, gap.distance.lower, gap.distance.upper);
  CHECK(apart.of_distance.back().lower == gap.distance.lower);
  CHECK(apart.of_distance.back().upper == gap.distance.upper);
  ask(box, box, {}, Pose::translation({1, 0.25, 0.25}), touching);
  CHECK((touching.of_depth.empty() && touching.of_distance.empty()));
  // So far from the origin that poses are rounded by a quarter of the box, no translation proves a bound.
  const ClashResult r =
      ask(box, box, Pose::translation({1e15, 0, 0}), Pose::translation({1e15 + 0.5, 0.25, 0.25}), far);
  REQUIRE((r.depth && far.of_depth.size() >= 2));
  CHECK(std::isinf(r.depth->upper));
  CHECK(std::isinf(far.of_depth.back().upper));
}

TEST_CASE_TEMPLATE(
    "an answer moves with the world, scales with it, and is mirrored for the bodies in reverse", Q, Collide,
    Distance, Clash, FirstContact, Near) {
  RandomEngine random(9);
  // Coordinates on a grid of 2^-20, which whole translations and powers of two keep.
  std::vector<LrbRep> on_grid;
  for (Mesh mesh :
       {shapes::bumpy_sphere(1, 3), shapes::torus(9, 6), shapes::comb(3), shapes::box_with_void()}) {
    for (Vector3d& v : mesh.vertices) v = (v * 0x1p20).array().round() * 0x1p-20;
    on_grid.push_back(test::closed(mesh));
  }
  const auto whole = [&](int most) { return static_cast<double>(random() % (2 * most + 1)) - most; };
  std::size_t answers = 0;
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    Case c{&on_grid[random() % 4],
           &on_grid[random() % 4],
           {},
           Pose::translation({whole(4) / 2, whole(4) / 2, whole(1) / 2})};
    if (i % 2 == 0) c.pose_b.r << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    const typename Q::Request request = Q::measured();
    const auto r = Q::ask(c, request);
    const std::vector<double> lengths = Q::lengths(r);
    const auto check = [&](const Case& other, double scale, const typename Q::Request& its) {
      const auto s = Q::ask(other, its);
      CHECK((Q::kind(s) == Q::kind(r)));
      const std::vector<double> found = Q::lengths(s);
      REQUIRE(found.size() == lengths.size());
      for (std::size_t k = 0; k < found.size(); ++k)
        CHECK(found[k] / scale == doctest::Approx(lengths[k]).epsilon(1e-7));
    };
    Case moved = c;
    const Vector3d by(whole(1000), whole(1000), whole(9));
    moved.pose_a.t += by;
    moved.pose_b.t += by;
    check(moved, 1, request);
    for (const double scale : {0x1p-250, 0x1p250}) {
      // Scaled bodies take another motion (a line, not a screw), and at 2^+-250 grazing may be undecided.
      if (std::is_same_v<Q, FirstContact>) continue;
      Case scaled = c;
      for (Pose* const pose : {&scaled.pose_a, &scaled.pose_b}) *pose = {pose->r * scale, pose->t * scale};
      typename Q::Request its = request;
      if constexpr (requires { its.within; }) its = {.within = 0.25 * scale};
      if constexpr (std::is_same_v<Q, Distance>) its = {};
      check(scaled, scale, its);
    }
    if constexpr (!std::is_same_v<Q, FirstContact>) {
      const auto swapped = Q::ask({c.b, c.a, c.pose_b, c.pose_a}, request);
      // Bodies that hold pieces of each other: the first is named as the one inside.
      CHECK((Q::kind(swapped, true) == Q::kind(r)));
    }
    answers += !lengths.empty();
  }
  if constexpr (!std::is_same_v<Q, FirstContact>) CHECK(answers > 10);
}

namespace {

template <class Q>
using Answers = std::vector<Expected<typename Q::Result>>;

template <class Q>
Answers<Q> batch(const LrbRep& a, const Pose& pose_a, const LrbRep& b, std::span<const Pose> poses,
                 const typename Q::Request& request, unsigned threads) {
  if constexpr (std::is_same_v<Q, Collide>)
    return collide(a, pose_a, b, poses, request, threads);
  else
    return distance(a, pose_a, b, poses, request, threads);
}
template <class Q>
Answers<Q> batch(std::span<const PosedPair> pairs, const typename Q::Request& request, unsigned threads) {
  if constexpr (std::is_same_v<Q, Collide>)
    return collide(pairs, request, threads);
  else
    return distance(pairs, request, threads);
}
template <class Q, class Visit>
std::size_t visited(Batch& batch, const Case& c, std::span<const Pose> poses, std::size_t chunk,
                    const Visit& visit) {
  const typename Batch::Visit<typename Q::Result> each = visit;
  if constexpr (std::is_same_v<Q, Collide>)
    return batch.collide(*c.a, c.pose_a, *c.b, poses, {}, each, chunk);
  else
    return batch.distance(*c.a, c.pose_a, *c.b, poses, {}, each, chunk);
}

}  // namespace

TEST_CASE_TEMPLATE("a batch gives each query its own answer or reason, in order, on any number of threads", Q,
                   Collide, Distance) {
  RandomEngine random(10);
  std::vector<PosedPair> pairs;
  for (int i = 0; i < 30; ++i) {
    const Case c = any_case(random);
    pairs.push_back({c.a, c.pose_a, c.b, c.pose_b});
  }
  pairs[7].pose_b.t.y() = kInfinite;
  pairs[9].a = pairs[9].a->dim() == 2 ? &bodies()[0] : &bodies()[5];
  const Case one = any_case(random, false);
  std::vector<Pose> poses;
  for (int i = 0; i < 23; ++i) poses.push_back(shapes::random_pose(random, *one.a, *one.b, 0.05 * i));
  for (const auto& request : Q::requests())
    for (const unsigned threads : {1U, 2U, 5U}) {
      CAPTURE(threads);
      const Answers<Q> of_pairs = batch<Q>(pairs, request, threads),
                       of_poses = batch<Q>(*one.a, {}, *one.b, poses, request, threads);
      REQUIRE(of_pairs.size() == pairs.size());
      REQUIRE(of_poses.size() == poses.size());
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        CAPTURE(i);
        REQUIRE(of_pairs[i].has_value() == (i != 7 && i != 9));
        const Case c{pairs[i].a, pairs[i].b, pairs[i].pose_a, pairs[i].pose_b};
        if (of_pairs[i])
          CHECK((content(*of_pairs[i]) == content(Q::ask(c, request))));
        else
          CHECK(of_pairs[i].error().reason == error_of([&] { static_cast<void>(Q::ask(c, request)); }));
      }
      for (std::size_t i = 0; i < poses.size(); ++i)
        CHECK((content(*of_poses[i]) == content(Q::ask({one.a, one.b, {}, poses[i]}, request))));
    }
  CHECK(batch<Q>(std::span<const PosedPair>(), {}, 2).empty());
  Batch work(2);
  CHECK(work.threads() == 2);
  for (const std::size_t chunk : {0U, 1U, 7U, 23U, 1000U})  // 0 counts as 1
    for (const std::size_t end : {1U, 7U, 8U, 23U}) {
      CAPTURE(chunk);
      std::size_t next = 0;
      CHECK(visited<Q>(work, {one.a, one.b, {}, {}}, poses, chunk, [&](std::size_t i, auto& answer) {
              CHECK(i == next++);
              CHECK((content(*answer) == content(Q::ask({one.a, one.b, {}, poses[i]}, {}))));
              return next < end;
            }) == end);
      CHECK(next == end);
    }
  CHECK(visited<Q>(work, {one.a, one.b, {}, {}}, {}, 7, [](std::size_t, auto&) { return true; }) == 0);
}

TEST_CASE("a batch that asks only whether bodies meet along motions keeps nothing of the answers before") {
  RandomEngine random(11);
  const CollideRequest any{.mode = Mode::any_pair};
  Mesh tiny = shapes::box();
  for (Vector3d& v : tiny.vertices) v *= 0.01;
  const LrbRep small = build_lrb(tiny);
  Batch work[2] = {Batch(1), Batch(3)};
  CollideAnswers answers[2];
  std::size_t meet = 0, inside = 0, proven = 0;
  for (int i = 0; i < 60; ++i) {
    Case c = any_case(random);
    if (i % 6 == 0) c = {&bodies()[0], &small, {}, {}};  // inside, and out of it
    const Vector3d way = shapes::uniform(random, 0, 0.5) * shapes::box_of(*c.a).diagonal().norm() *
                         c.pose_a.r.col(i % 2),
                   axis = c.a->dim() == 2 ? Vector3d::UnitZ() : shapes::random_direction(random);
    const double angle = shapes::uniform(random, 0, 2);
    std::vector<Pose> poses;
    for (int k = 0; k < 150; ++k)
      poses.push_back({Pose::rotation(axis, k * angle / 149).r * c.pose_b.r, c.pose_b.t + k / 149.0 * way});
    if (i % 5 == 0) poses[40 + i].t.x() = kNaN;
    const bool flat = c.a->dim() == 2;
    if (flat) poses[3].t.z() = 1e-4;
    const CollideRequest request = i % 4 == 0 ? CollideRequest{} : any;
    for (const int w : {0, 1}) work[w].collide(*c.a, c.pose_a, *c.b, poses, request, answers[w]);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      CAPTURE(i);
      CAPTURE(k);
      const bool valid = std::isfinite(poses[k].t.x()) && (!flat || poses[k].t.z() == 0);
      for (const auto& of : answers) REQUIRE(of[k].has_value() == valid);
      if (!answers[0][k]) continue;
      const CollideResult& found = *answers[0][k];
      CollideResult expected = collide(*c.a, c.pose_a, *c.b, poses[k], request);
      meet += !found.pairs.empty();
      inside += found.relation == Relation::b_inside_a;
      if (found.counters.node_pairs == 0) {
        ++proven;
        clear(expected.counters);
        for (std::vector<RegionId>& opened : expected.opened) opened.clear();
      }
      CHECK((content(found) == content(expected)));
      CHECK((content(*answers[1][k]) == content(found)));
    }
  }
  CHECK(std::min({meet / 10, inside, proven / 10}) > 100);
}

TEST_CASE("an answer stays in its workspace until the next query of the same kind, and may be moved out") {
  const LrbRep& box = bodies()[2];
  const Pose at = Pose::translation({0.5, 0.25, 0.125});
  Workspace workspace;
  const CollideResult& pairs = collide(box, {}, box, at, {}, workspace).value();
  const DistanceResult& gap = distance(box, {}, box, Pose::translation({3, 0, 0}), {}, workspace).value();
  const std::size_t count = pairs.pairs.size();
  CHECK(count > 0);
  CHECK(clash(box, {}, box, at, {}, workspace)->kind == ClashKind::protrudes);
  CHECK(pairs.pairs.size() == count);
  CHECK(gap.lower > 1.9);
  CHECK(&collide(box, {}, box, Pose::translation({9, 0, 0}), {}, workspace).value() == &pairs);
  CHECK(pairs.pairs.empty());
  const CollideResult mine = std::move(collide(box, {}, box, at, {}, workspace).value());
  CHECK(mine.pairs.size() == count);
  CHECK(collide(box, {}, box, at, {}, workspace)->pairs == mine.pairs);
}

TEST_CASE("describe_contact() adds what a query without contacts omitted") {
  Workspace workspace;
  const CollideRequest more{.contacts = true, .interiors_overlap = true};
  RandomEngine random(11);
  for (int i = 0; i < 40; ++i) {
    const Case c = any_case(random);
    CollideResult found = Collide::ask(c, {}), at_once = Collide::ask(c, more);
    const auto described = describe_contact(*c.a, c.pose_a, *c.b, c.pose_b, more, workspace, found);
    REQUIRE(described.has_value());
    CHECK(&*described == &found);
    found.counters = at_once.counters = {};
    CHECK((content(found) == content(at_once)));
  }
  CollideResult none;
  CHECK(describe_contact(bodies()[2], {}, bodies()[6], {}, {}, workspace, none)
            .error()
            .reason.find("dimension") != std::string::npos);
}

TEST_CASE("a query in deep contact has the same answer and limit of pairs on any number of threads") {
  const std::vector<LrbRep> list = {
      build_lrb(shapes::bumpy_sphere(4, 7, 0.3)),
      build_lrb(shapes::quad_torus(90, 60)),
      test::closed(
          shapes::several({shapes::icosphere(4), shapes::turned_inside_out(shapes::icosphere(4, 0.5))})),
      build_lrb(
          shapes::several({shapes::torus(80, 40), shapes::translated(shapes::torus(80, 40), {1, 0, 0})})),
      test::open_body(shapes::open_cylinder(12000)),
      test::closed(shapes::ring_2d(20000))};
  Pose turned = Pose::rotation({0, 0, 1}, 1e-3), skewed;
  skewed.r << 1, 1e-3, 0, 0, 1.001, 0, 0, 0, 1;
  Workspace two(2), five(5);
  for (const LrbRep& body : list) {
    std::uint64_t most = 0;
    for (const Pose& pose : {Pose{}, turned, skewed})
      for (const Predicates predicates : {Predicates::exact, Predicates::floating}) {
        CollideRequest request{.predicates = predicates};
        const Case c{&body, &body, {}, pose};
        const CollideResult alone = Collide::ask(c, request);
        most = std::max(most, alone.counters.node_pairs);
        CollideProbe silent;
        CHECK((content(collide(body, {}, body, pose, request, silent)) == content(alone)));
        for (Workspace* const threads : {&two, &five})
          CHECK((content(Collide::ask(c, request, *threads).value()) == content(alone)));
        request.max_pairs = alone.pairs.size();
        CHECK(Collide::ask(c, request, two).has_value());
        --request.max_pairs;
        CHECK(Collide::ask(c, request, two)
                  .error()
                  .reason.find("more than " + std::to_string(request.max_pairs)) == 0);
      }
    CHECK(most > 2 * kNodePairsBeforeSplit);  // several parts
  }
}

namespace {

/// A body, and why its clashes as A and as B are undecided; none: they are decided.
struct Row {
  const char* name;
  Mesh mesh;
  ClashReason as_a = ClashReason::none, as_b = ClashReason::none;
};

std::vector<Row> rows() {
  using enum ClashReason;
  using namespace shapes;
  const Mesh ball = icosphere(1), hollow = several({ball, turned_inside_out(icosphere(1, 0.6))});
  Mesh pulled_through = ball;
  pulled_through.vertices[0] *= -1.5;
  return {
      {"clean", ball},
      {"crosses itself in one place", pulled_through, a_overlaps, b_overlaps},
      {"crosses itself all over", torus(24, 12, 0.5, 0.8), a_overlaps, b_overlaps},
      {"components that overlap", several({ball, translated(ball, {0.7, 0.1, 0.2})}), a_overlaps, b_overlaps},
      {"components in one place", several({ball, ball}), a_overlaps, b_overlaps},
      {"components that touch in a face",
       several({box({-1, -0.5, -0.5}, {0, 0.5, 0.5}), box({0, -0.5, -0.5}, {1, 0.5, 0.5})})},
      {"open", open_cylinder(12), a_open, b_open},
      {"a void", hollow},
      {"a body in a void", several({hollow, icosphere(1, 0.3)})}};
}

/// Returns the body through every door there is.
std::vector<Body> through_all_doors(const Mesh& mesh, const test::Folder& folder) {
  BodyOptions plain;
  plain.regions = false;
  write_mesh(mesh, folder / "mesh.obj");
  std::vector<Body> list = {Body::from(mesh).value(), Body::from(mesh, plain).value(),
                            Body::load(folder / "mesh.obj").value(),
                            Body::load(folder / "mesh.obj", plain).value()};
  for (const std::size_t i : {0U, 1U}) {
    save_lrb(list[i].rep(), folder / "saved.lrb");
    list.push_back(Body::load(folder / "saved.lrb").value());
  }
  for (const bool crossing : {false, true})
    list.push_back(Body::from(LrbRep::without_regions(mesh, list[0].is_solid(), crossing)));
  return list;
}

}  // namespace

// tests/matrix has the other queries of bodies through all doors.
TEST_CASE("a clash has the same answer through every door to a body, and a reason if it is undecided") {
  const test::Folder folder;
  const LrbRep cube = Body::from(shapes::box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4})).value().rep();
  const Pose apart = Pose::translation({9, 0, 0}), meeting = Pose::translation({0.93, 0.11, 0.07});
  for (const Row& row : rows()) {
    CAPTURE(row.name);
    const std::vector<Body> doors = through_all_doors(row.mesh, folder);
    const ClashResult first = clash(doors[0], {}, cube, meeting), back = clash(cube, meeting, doors[0], {});
    CHECK(first.reason == row.as_a);
    CHECK(back.reason == row.as_b);
    CHECK((first.kind == ClashKind::undecided) == (row.as_a != ClashReason::none));
    CHECK((back.kind == ClashKind::undecided) == (row.as_b != ClashReason::none));
    CHECK(first.volume.has_value() == (row.as_a == ClashReason::none));
    CHECK(first.depth.has_value() == (row.as_a != ClashReason::a_open));
    if (first.depth)
      CHECK(collide(doors[0], {}, cube, Pose::translation(meeting.t + first.translation)).relation ==
            Relation::separate);
    for (const Body& body : doors) {
      CHECK((content(clash(body, {}, cube, meeting)) == content(first)));
      CHECK((content(clash(cube, meeting, body, {})) == content(back)));
      const ClashResult far = clash(body, {}, cube, apart);
      CHECK((far.kind == ClashKind::apart && far.reason == ClashReason::none &&
             far.interiors_overlap == Answer::no));
    }
  }
}

}  // namespace lrb::contract
