// Batches: answers in the order of the questions, those that each question gets alone, for any number of
// threads.
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

constexpr unsigned kThreads[] = {1, 2, 5};

std::vector<Pose> some_poses(const LrbRep& a, const LrbRep& b, std::size_t count, std::uint64_t seed) {
  RandomEngine random(seed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i)
    poses.push_back(shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1)));
  return poses;
}

template <class Result>
void check_same(const Result& x, const Result& y) {
  CHECK((test::content(x) == test::content(y)));
}

/// Requests of every kind.
std::vector<CollideRequest> requests() {
  std::vector<CollideRequest> out(6);
  out[1].mode = Mode::first_pair;
  out[2].contacts = true;
  out[3].tolerance = 0.05;
  out[4].separation = true;
  out[5].mode = Mode::any_pair;
  out[5].max_tests = 3;
  return out;
}

struct Bodies {
  LrbRep ball = build_lrb(shapes::bumpy_sphere(2, 4)), ring = build_lrb(shapes::torus(16, 8)),
         box = build_lrb(shapes::box());
};

}  // namespace

TEST_CASE("a batch of poses gives the answers of single queries, for any number of threads") {
  const Bodies bodies;
  const std::vector<Pose> poses = some_poses(bodies.ball, bodies.ring, 60, 1);
  const Pose pose_a = Pose::rotation({3, 1, 2}, 0.4, {1, 2, 3});
  std::vector<Pose> poses_b;
  for (const Pose& p : poses) poses_b.push_back({p.r, p.t + pose_a.t});
  std::size_t met = 0;
  for (const CollideRequest& request : requests()) {
    std::vector<CollideResult> alone;
    for (const Pose& p : poses_b) alone.push_back(collide(bodies.ball, pose_a, bodies.ring, p, request));
    for (const unsigned threads : kThreads) {
      CAPTURE(threads);
      const CollideAnswers answers = collide(bodies.ball, pose_a, bodies.ring, poses_b, request, threads);
      REQUIRE(answers.size() == alone.size());
      for (std::size_t i = 0; i < alone.size(); ++i) {
        check_same(answers[i].value(), alone[i]);
        met += !alone[i].pairs.empty();
      }
    }
  }
  CHECK(met > 200);
}

TEST_CASE("a batch of pairs gives the answers of single queries, for any number of threads") {
  const Bodies bodies;
  const LrbRep* all[] = {&bodies.ball, &bodies.ring, &bodies.box};
  RandomEngine random(2);
  std::vector<PosedPair> pairs;
  for (int i = 0; i < 80; ++i) {
    PosedPair p;
    p.a = all[random() % 3];
    p.b = all[random() % 3];
    p.pose_a = Pose::rotation({1, 2, 3}, i);
    p.pose_b = shapes::random_pose(random, *p.a, *p.b, 0.7);
    pairs.push_back(p);
  }
  CollideRequest request;
  request.contacts = true;
  for (const unsigned threads : kThreads) {
    const CollideAnswers answers = collide(pairs, request, threads);
    const DistanceAnswers distances = distance(pairs, {}, threads);
    REQUIRE(answers.size() == pairs.size());
    REQUIRE(distances.size() == pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const PosedPair& p = pairs[i];
      check_same(*answers[i], collide(*p.a, p.pose_a, *p.b, p.pose_b, request));
      check_same(*distances[i], distance(*p.a, p.pose_a, *p.b, p.pose_b));
    }
  }
}

TEST_CASE("a batch of distances gives the answers of single queries") {
  const Bodies bodies;
  const std::vector<Pose> poses = some_poses(bodies.ring, bodies.box, 40, 3);
  for (const unsigned threads : kThreads) {
    const DistanceAnswers answers = distance(bodies.ring, Pose{}, bodies.box, poses, {}, threads);
    REQUIRE(answers.size() == poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      check_same(*answers[i], distance(bodies.ring, Pose{}, bodies.box, poses[i]));
  }
}

TEST_CASE("rejected queries of a batch have their reason, and reused memory is clean") {
  const Bodies bodies;
  const LrbRep flat = build_lrb(shapes::circle(8));
  std::vector<Pose> poses = some_poses(bodies.ball, bodies.ring, 12, 4);
  poses[5].t.y() = std::numeric_limits<double>::infinity();
  Batch batch(2);
  CHECK(batch.threads() == 2);
  CollideAnswers answers;
  for (int round = 0; round < 3; ++round) {  // a refusal, then an answer in its place
    batch.collide(bodies.ball, Pose{}, bodies.ring, poses, {}, answers);
    REQUIRE(answers.size() == poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      CAPTURE(i);
      REQUIRE(answers[i].has_value() == (i != 5 || round == 2));
      if (answers[i]) check_same(*answers[i], collide(bodies.ball, Pose{}, bodies.ring, poses[i]));
    }
    if (round == 0)
      CHECK(answers[5].error().reason == "expected a pose of 12 finite numbers, found a NaN or an infinity");
    if (round == 1) poses[5] = poses[4];
  }
  const PosedPair pairs[] = {{&flat, {}, &bodies.ball, {}}, {&flat, {}, &flat, {}}};
  batch.collide(pairs, {}, answers);
  REQUIRE(answers.size() == 2);
  CHECK(!answers[0]);
  CHECK(answers[1]->relation == Relation::touching);
  CollideRequest request;
  request.max_pairs = 1;
  CHECK(!collide(bodies.ball, Pose{}, bodies.ball, std::vector<Pose>(3), request)[2]);
  CHECK(!distance(pairs)[0]);
  CHECK(collide(std::span<const PosedPair>()).empty());
}

TEST_CASE("a visitor of a batch sees each answer once, in order, and can end it") {
  const Bodies bodies;
  const std::vector<Pose> poses = some_poses(bodies.ball, bodies.ring, 23, 4);
  CollideAnswers collisions;
  DistanceAnswers distances;
  Batch batch(2);
  batch.collide(bodies.ball, {}, bodies.ring, poses, {}, collisions);
  batch.distance(bodies.ball, {}, bodies.ring, poses, {}, distances);
  for (const std::size_t chunk : {0U, 1U, 7U, 23U, 1000U})  // 0 counts as 1
    for (const std::size_t end : {1U, 7U, 8U, 23U}) {
      CAPTURE(chunk);
      std::size_t next = 0;
      CHECK(batch.collide(
                bodies.ball, {}, bodies.ring, poses, {},
                [&](std::size_t i, Expected<CollideResult>& answer) {
                  CHECK(i == next++);
                  check_same(*answer, *collisions[i]);
                  return next < end;
                },
                chunk) == end);
      CHECK(next == end);
      next = 0;
      CHECK(batch.distance(
                bodies.ball, {}, bodies.ring, poses, {},
                [&](std::size_t i, Expected<DistanceResult>& answer) {
                  CHECK(i == next++);
                  check_same(*answer, *distances[i]);
                  return next < end;
                },
                chunk) == end);
    }
  CHECK(batch.collide(bodies.ball, {}, bodies.ring, {}, {}, [](auto, auto&) { return true; }) == 0);
}
