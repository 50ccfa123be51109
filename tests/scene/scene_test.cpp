// Scenes against brute force, over random adds, removals and moves, for any number of threads.
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/float_modes.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/scene.hpp>
#include <lrbscope/world_box.hpp>

using namespace lrb;
using Eigen::Vector3d;
using shapes::RandomEngine;

namespace {

/// The content of a scene in a simple form.
struct Plain {
  struct Entry {
    Body body;
    Pose pose;
  };
  std::map<BodyKey, Entry> entries;
};

bool is_reported(Relation r) {
  return r != Relation::separate && r != Relation::undefined;
}

std::vector<Body> some_bodies() {
  BodyOptions faces;
  faces.regions = false;
  return {Body::from(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})).value(),
          Body::from(shapes::icosphere(1, 0.6)).value(), Body::from(shapes::tetrahedron(1.5)).value(),
          Body::from(shapes::open_cylinder(8), faces).value(),
          Body::from(shapes::icosphere(0, 2), faces).value()};
}

Pose random_place(RandomEngine& random, double room) {
  Pose pose;
  pose.r = shapes::random_rotation(random);
  if (random() % 4 == 0) pose.r.setIdentity();  // whole numbers: boxes and faces that touch
  for (int k = 0; k < 3; ++k) pose.t[k] = std::floor(2 * shapes::uniform(random, 0, room)) / 2;
  return pose;
}

/// Checks a scene's answers on all its pairs against the answer for each pair.
void check_collide(Scene& scene, const Plain& plain) {
  std::vector<std::pair<BodyKey, BodyKey>> expected;
  std::vector<BruteForceResult> answers;
  for (auto i = plain.entries.begin(); i != plain.entries.end(); ++i)
    for (auto j = std::next(i); j != plain.entries.end(); ++j) {
      BruteForceResult r = brute_force(i->second.body, i->second.pose, j->second.body, j->second.pose);
      if (!is_reported(r.relation)) continue;
      expected.emplace_back(i->first, j->first);
      answers.push_back(std::move(r));
    }
  const auto reported = scene.collide();
  REQUIRE(reported.size() == expected.size());
  for (std::size_t k = 0; k < reported.size(); ++k) {
    CHECK(std::pair(reported[k].a, reported[k].b) == expected[k]);
    REQUIRE(reported[k].result.has_value());
    CHECK(reported[k].result->relation == answers[k].relation);
    CHECK(reported[k].result->pairs == answers[k].pairs);
  }
}

void check_nearest(const std::optional<SceneDistance>& found, double expected) {
  REQUIRE(found.has_value());
  REQUIRE(found->result.has_value());
  CHECK(found->result->upper == expected);
}

/// Checks the least distance of a body to those of a scene, and which of them it meets.
void check_alone(Scene& scene, const Plain& plain, const Body& body, const Pose& pose) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<BodyKey> expected;
  for (const auto& [key, entry] : plain.entries) {
    least = std::min(least, distance(body, pose, entry.body, entry.pose).upper);
    if (is_reported(brute_force(body, pose, entry.body, entry.pose).relation)) expected.push_back(key);
  }
  const auto reported = test::in_mode(0, [&] { return scene.collide(body, pose); });
  REQUIRE(reported.size() == expected.size());
  for (std::size_t k = 0; k < reported.size(); ++k) {
    CHECK(reported[k].b == expected[k]);
    CHECK(reported[k].result->pairs ==
          brute_force(body, pose, scene.body(reported[k].b), scene.pose(reported[k].b)).pairs);
  }
  if (plain.entries.empty())
    CHECK(!scene.nearest(body, pose));
  else
    check_nearest(test::in_mode(1, [&] { return scene.nearest(body, pose); }), least);
}

double min_distance(const Plain& plain) {
  double least = std::numeric_limits<double>::infinity();
  for (auto i = plain.entries.begin(); i != plain.entries.end(); ++i)
    for (auto j = std::next(i); j != plain.entries.end(); ++j)
      least = std::min(least, distance(i->second.body, i->second.pose, j->second.body, j->second.pose).upper);
  return least;
}

/// Adds, removes and moves at random, in a scene and in the simple form.
void change(Scene& scene, Plain& plain, const std::vector<Body>& bodies, RandomEngine& random, double room) {
  const auto any = [&] {
    auto entry = plain.entries.begin();
    std::advance(entry, static_cast<std::ptrdiff_t>(random() % plain.entries.size()));
    return entry;
  };
  const auto kind = random() % 6;
  if (plain.entries.empty() || kind < 2) {
    const Body& body = bodies[random() % bodies.size()];
    const Pose pose = random_place(random, room);
    plain.entries.emplace(scene.add(body, pose), Plain::Entry{body, pose});
  } else if (kind == 2) {
    const auto entry = any();
    CHECK(scene.remove(entry->first));
    CHECK(!scene.has(entry->first));
    CHECK(!scene.remove(entry->first));
    CHECK(!scene.move(entry->first, Pose{}));
    plain.entries.erase(entry);
  } else {
    const auto entry = any();
    entry->second.pose = random_place(random, room);
    CHECK(scene.move(entry->first, entry->second.pose));
  }
}

}  // namespace

TEST_CASE("a scene agrees with queries of all pairs while bodies are added, removed and moved") {
  const std::vector<Body> bodies = some_bodies();
  for (std::uint64_t round = 0; round < 6; ++round) {
    RandomEngine random(round + 1);
    const double room = round % 2 == 0 ? 3 : 5;
    Scene scene(round % 3 == 0 ? 1 : 2);
    Plain plain;
    std::size_t reported = 0;
    for (int step = 0; step < 25; ++step) {
      for (auto changes = random() % 12; changes > 0; --changes) change(scene, plain, bodies, random, room);
      CAPTURE(step);
      CHECK(scene.size() == plain.entries.size());
      check_collide(scene, plain);
      reported += scene.collide().size();
      check_alone(scene, plain, bodies[random() % bodies.size()], random_place(random, room));
      if (step % 5 == 4 && plain.entries.size() > 1) check_nearest(scene.nearest(), min_distance(plain));
    }
    CHECK(reported > 100);
    std::vector<BodyKey> keys;
    for (const auto& [key, entry] : plain.entries) keys.push_back(key);
    CHECK(scene.keys() == keys);
  }
}

TEST_CASE("barely touching bodies have distance 0, and the closest body is found with few queries") {
  const Body ball = Body::from(shapes::icosphere(2, 0.4)).value();
  Scene scene(2);
  CHECK(!scene.nearest());
  std::vector<BodyKey> keys;
  for (int i = 0; i < 400; ++i)
    keys.push_back(scene.add(ball, Pose::translation({1.0 * (i % 20), 1.0 * (i / 20), 0.001 * i})));
  CHECK(scene.collide().empty());
  scene.move(keys[210], Pose::translation({10.05, 10, 0.21}));
  const std::optional<SceneDistance> found = scene.nearest();
  REQUIRE(found.has_value());
  CHECK(found->a == keys[210]);
  CHECK(found->b == keys[211]);
  CHECK(found->result->upper == distance(ball, scene.pose(keys[210]), ball, scene.pose(keys[211])).upper);
  scene.move(keys[210], scene.pose(keys[211]));
  CHECK(scene.nearest()->result->upper == 0);
}

TEST_CASE("two scenes collide if and only if their bodies do") {
  const std::vector<Body> bodies = some_bodies();
  RandomEngine random(9);
  for (int round = 0; round < 8; ++round) {
    Scene x(2), y(2);
    for (int i = 0; i < 15; ++i) x.add(bodies[random() % bodies.size()], random_place(random, 6));
    for (int i = 0; i < 20; ++i) y.add(bodies[random() % bodies.size()], random_place(random, 6));
    std::vector<std::pair<BodyKey, BodyKey>> expected, found;
    double least = std::numeric_limits<double>::infinity();
    for (const BodyKey i : x.keys())
      for (const BodyKey j : y.keys()) {
        if (is_reported(brute_force(x.body(i), x.pose(i), y.body(j), y.pose(j)).relation))
          expected.emplace_back(i, j);
        least = std::min(least, distance(x.body(i), x.pose(i), y.body(j), y.pose(j)).upper);
      }
    for (const SceneAnswer& answer : x.collide(y)) found.emplace_back(answer.a, answer.b);
    CHECK(found == expected);
    check_nearest(test::in_mode(round, [&] { return x.nearest(y); }), least);
  }
  Scene empty;
  CHECK(!empty.nearest(empty));
}

TEST_CASE("a scene passes its request to its queries, and rejections have a reason") {
  Scene scene(2);
  const Body box = Body::from(shapes::box()).value(),
             square = Body::from(shapes::polygon({{0, 0}, {1, 0}, {0, 1}})).value();
  const BodyKey a = scene.add(box), b = scene.add(box, Pose::translation({0.5, 0.4, 0.3}));
  CollideRequest request;
  request.contacts = true;
  REQUIRE(scene.collide(request).size() == 1);
  CHECK(scene.collide(request)[0].result->regions.size() == 1);
  request = {};
  request.mode = Mode::any_pair;
  CHECK(scene.collide(request)[0].result->pairs.size() == 1);
  CHECK(scene.nearest()->result->meet);
  scene.move(b, Pose::translation({std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  REQUIRE(scene.collide().size() == 1);
  CHECK(scene.collide()[0].result.error().reason ==
        "expected a pose of 12 finite numbers, found a NaN or an infinity");
  CHECK(!scene.nearest()->result.has_value());
  scene.remove(b);
  scene.add(square);
  CHECK(scene.collide()[0].result.error().reason ==
        "expected two bodies of the same dimension, found a 3D and a 2D body");
  CHECK(scene.collide()[0].a == a);
}

TEST_CASE("pairs of close boxes, closest first, against all pairs of boxes") {
  RandomEngine random(18);
  const std::vector<Body> bodies = some_bodies();
  Scene scene(2);
  std::map<BodyKey, Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 40; ++i) {
    const Body& body = bodies[random() % bodies.size()];
    const Pose pose = random_place(random, 9);
    boxes[scene.add(body, pose)] = world_box(body, pose);
  }
  for (const double within : {0.0, 0.3, 2.0, 100.0}) {
    std::size_t expected = 0;
    double least = std::numeric_limits<double>::infinity();
    for (auto i = boxes.begin(); i != boxes.end(); ++i)
      for (auto j = std::next(i); j != boxes.end(); ++j) {
        const double gap = i->second.exteriorDistance(j->second);
        least = std::min(least, gap);
        if (gap <= within) ++expected;
      }
    const auto near = scene.near(within);
    CHECK(near.size() == expected);
    CHECK(near[0].gap == doctest::Approx(least));
    for (std::size_t k = 0; k < near.size(); ++k) {
      CHECK(near[k].a < near[k].b);
      CHECK(near[k].gap == doctest::Approx(boxes[near[k].a].exteriorDistance(boxes[near[k].b])));
      if (k > 0)
        CHECK(std::tuple(near[k - 1].gap, near[k - 1].a, near[k - 1].b) <
              std::tuple(near[k].gap, near[k].a, near[k].b));
    }
    const auto nearest = scene.nearest_boxes();
    REQUIRE(nearest.has_value());
    CHECK(std::pair(nearest->a, nearest->b) == std::pair(near[0].a, near[0].b));
  }
  CHECK(!Scene().nearest_boxes());
  const Pose far = Pose::translation({50, 0, 0});
  CHECK(scene.near(bodies[0], far).empty());
  CHECK(scene.near(bodies[0], far, 1e3).size() == boxes.size());
  CHECK(scene.near(bodies[0], far, 1e3)[0].b == scene.nearest_boxes(bodies[0], far)->b);
  Scene other;
  const BodyKey lone = other.add(bodies[0], far);
  CHECK(scene.nearest_boxes(other)->b == lone);
  CHECK(other.nearest_boxes(scene)->gap == scene.nearest_boxes(other)->gap);
}

TEST_CASE("closest solids: an enclosed body is closer than any outside") {
  Scene scene;
  const Body big = Body::from(shapes::icosphere(2, 3)).value(),
             small = Body::from(shapes::tetrahedron(1)).value();
  const BodyKey outer = scene.add(big), inner = scene.add(small);
  const BodyKey beside = scene.add(small, Pose::translation({4.5, 0, 0}));
  const auto surfaces = scene.nearest();
  const auto solids = scene.nearest({}, Apart::solids);
  CHECK(std::pair(surfaces->a, surfaces->b) == std::pair(outer, beside));
  CHECK(std::pair(solids->a, solids->b) == std::pair(outer, inner));
  CHECK(solids->result->solids_upper() == 0);
  CHECK(solids->result->upper > surfaces->result->upper);
}

TEST_CASE("a scene keeps the answers of bodies that have not moved, for the same request") {
  const std::vector<Body> bodies = some_bodies();
  RandomEngine random(31);
  Scene scene(2);
  std::vector<BodyKey> keys;
  for (int i = 0; i < 60; ++i)
    keys.push_back(scene.add(bodies[random() % bodies.size()], random_place(random, 4)));
  // Compares with a scene that asks all queries.
  const auto check = [&](const CollideRequest& request) {
    Scene anew(1);
    for (const BodyKey key : scene.keys()) anew.add(scene.body(key), scene.pose(key));
    const auto expected = anew.collide(request), found = scene.collide(request);
    CHECK(anew.work().kept == 0);
    CHECK(scene.work().near == anew.work().near);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      REQUIRE(found[i].result.has_value() == expected[i].result.has_value());
      if (!found[i].result) continue;
      CHECK(found[i].result->relation == expected[i].result->relation);
      CHECK(found[i].result->pairs == expected[i].result->pairs);
      CHECK(found[i].result->regions.size() == expected[i].result->regions.size());
    }
  };
  const auto near_of = [&](BodyKey key) {
    std::size_t n = 0;
    for (const ScenePair& p : scene.near()) n += static_cast<std::size_t>(p.a == key || p.b == key);
    return n;
  };
  CollideRequest request;
  check(request);
  CHECK(scene.work().near > 50);
  CHECK(scene.work().kept == 0);
  check(request);
  CHECK(scene.work().kept == scene.work().near);
  for (int step = 0; step < 20; ++step) {
    CAPTURE(step);
    const BodyKey moved = keys[random() % keys.size()];
    scene.move(moved, random_place(random, 4));
    const std::size_t queried = near_of(moved);  // queries of other kinds do not disturb
    scene.collide(bodies[0], Pose{});
    scene.move(keys[7], scene.pose(keys[7]));  // to where it is
    check(request);
    CHECK(scene.work().kept == scene.work().near - queried);
  }
  request.contacts = true;
  check(request);
  CHECK(scene.work().kept == 0);
  check(request);
  CHECK(scene.work().kept == scene.work().near);
  scene.remove(keys[3]);
  keys[3] = scene.add(bodies[1], random_place(random, 4));
  Pose bad;
  bad.t.x() = std::numeric_limits<double>::quiet_NaN();
  scene.move(keys[4], bad);
  check(request);
  check(request);
  request.max_time = 10;
  request.contacts = false;
  check(request);
  check(request);
  CHECK(scene.work().kept == 0);
}

TEST_CASE("a batch finds the poses of a motion at which bodies meet, however few they are") {
  RandomEngine random(3);
  const CollideRequest any{.mode = Mode::any_pair};
  const LrbRep ball = LrbRep::without_regions(shapes::bumpy_sphere(4, 2), true, false);
  for (int i = 0; i < 400; ++i) {
    // B, whose frame may be far from it, passes A in steps, one of which or each more than the one before
    // goes aside or turns.
    const double far = i % 2 == 0 ? 0 : shapes::uniform(random, 2, 20);
    const LrbRep b =
        LrbRep::without_regions(shapes::box({far, -0.05, -1}, {far + 0.1, 0.05, 1}), true, false);
    const Vector3d way = shapes::uniform(random, 0, i % 5 == 0 ? 4 : 0.3) * Vector3d(0, 1, 1),
                   aside = shapes::uniform(random, 0, 0.4) * Vector3d(-1, 0, 0);
    const double angle = shapes::uniform(random, -0.3, 0.3);
    const int only = static_cast<int>(random() % 8);
    const Pose pose_a{(i % 7 == 0 ? 1.25 : 1) * Eigen::Matrix3d::Identity(), Vector3d::Zero()};
    const auto pose = [&](int k, double gap) {
      const double share = i % 4 < 2 ? k == only : k / 7.0;
      return Pose::rotation({0, 1, 0}, (i % 3 != 0) * share * angle,
                            Vector3d(gap - far, 0, 0) + k / 7.0 * way + (i % 3 == 0) * share * aside);
    };
    const auto meets = [&](int k, double gap) {
      return !collide(ball, pose_a, b, pose(k, gap), any).pairs.empty();
    };
    // The largest gap, nearly, at which a pose meets A.
    std::array<double, 2> gap = {0.5, 20};
    for (int step = 0; step < 12; ++step) {
      const double midpoint = (gap[0] + gap[1]) / 2;
      bool some = false;
      for (int k = 0; k < 8 && !some; ++k) some = meets(k, midpoint);
      gap[some ? 0 : 1] = midpoint;
    }
    std::vector<Pose> poses;
    for (int k = 0; k < 8; ++k) poses.push_back(pose(k, gap[0]));
    const CollideAnswers found = collide(ball, pose_a, b, poses, any, 1);
    std::size_t meet = 0;
    for (int k = 0; k < 8; ++k) {
      CAPTURE(i);
      CAPTURE(k);
      CHECK(found[k].value().pairs.empty() != meets(k, gap[0]));
      meet += meets(k, gap[0]);
    }
    CHECK(meet > 0);
  }
}
