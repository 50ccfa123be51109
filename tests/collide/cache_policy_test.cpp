// When caches are made, with a clock that the test sets.
#include <doctest/doctest.h>

#include "engine/collide/candidate_cache.hpp"

using namespace lrb;

namespace {

/// Queries of a body that keeps its course or wanders, at what costs.
struct PolicyScene {
  double scratch, stretch_list, place_list, step;  ///< microseconds
  int stretch_serves, place_serves;                ///< steps
  bool on_course = true;
  int jump_every = 0;  ///< queries; 0: it does not
};

struct Count {
  int scratch = 0, from_cache = 0, lists[2] = {};
  double time = 0;
};

class Player {
 public:
  Count play(const PolicyScene& scene, int queries) {
    Count count;
    for (int i = 0; i < queries; ++i) {
      const bool jump = scene.jump_every > 0 && i % scene.jump_every == 0;
      count.time += jump ? jump_query(scene, count) : query(scene, count);
    }
    return count;
  }

 private:
  double query(const PolicyScene& s, Count& count) {
    if (policy_.rests()) return from_scratch(s, count, false);
    if (policy_.must_wait()) return from_scratch(s, count, true);
    if (left_ > 0) {
      --left_;
      ++count.from_cache;
      policy_.step_took(1e-6 * s.step);
      return s.step;
    }
    const auto list = policy_.next(s.on_course, 0.001, 0.5);
    if (!list) return from_scratch(s, count, true);
    const bool stretch = list->kind == CachePolicy::Kind::swept;
    const double time = stretch ? s.stretch_list : s.place_list;
    left_ = stretch ? s.stretch_serves : s.place_serves;
    ++count.lists[static_cast<int>(list->kind)];
    policy_.build_took(list->kind, 1e-6 * time);
    return time;
  }
  double jump_query(const PolicyScene& s, Count& count) {
    if (policy_.rests()) return from_scratch(s, count, false);
    policy_.forgive();
    return from_scratch(s, count, true);
  }
  double from_scratch(const PolicyScene& s, Count& count, bool timed) {
    left_ = 0;
    ++count.scratch;
    if (timed) policy_.scratch_took(1e-6 * s.scratch);
    return s.scratch;
  }

  CachePolicy policy_;
  int left_ = 0;  ///< steps that the list serves yet
};

}  // namespace

TEST_CASE("caches that save time are made repeatedly") {
  const Count c = Player().play({10, 15, 60, 2, 8, 8}, 1000);
  CHECK(c.scratch < 20);
  CHECK(c.lists[0] > 90);
  CHECK(c.lists[1] < 10);  // dearer, tried now and then
  CHECK(c.time < 0.45 * 1000 * 10);
}

TEST_CASE("the cheaper kind of cache is chosen") {
  // B turns back so often that stretches break, but stays near one place.
  const Count c = Player().play({10, 15, 30, 2, 1, 200}, 2000);
  CHECK(c.from_cache > 1600);
  CHECK(c.lists[1] > c.lists[0] / 4);
  CHECK(c.time < 0.4 * 2000 * 10);
}

TEST_CASE("a cache covers a limited motion, and none is made if that is only a few steps") {
  for (const double step : {1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
    CachePolicy policy;
    int lists = 0;
    for (int i = 0; i < 500; ++i) {
      if (policy.rests()) continue;
      policy.scratch_took(1e-5);
      if (policy.must_wait()) continue;
      const auto list = policy.next(i % 100 < 50, step, 1);
      if (!list) continue;
      ++lists;
      CHECK(list->steps >= 2);
      CHECK(list->steps * step <= 0.0626);
      policy.build_took(list->kind, 1e-6);
    }
    CHECK((lists > 0) == (step < 0.0157));
  }
}

TEST_CASE("caches that do not save time are rarely tried") {
  for (const bool on_course : {true, false}) {
    const Count c = Player().play({10, 40, 40, 9, 3, 3, on_course}, 2000);
    CHECK(c.lists[0] + c.lists[1] < 40);
    CHECK(c.lists[0] + c.lists[1] > 0);
    CHECK(c.time < 1.1 * 2000 * 10);
  }
}

TEST_CASE("caches are rarely tried if jumps invalidate each of them early") {
  PolicyScene scene{10, 30, 30, 5, 8, 8};
  CHECK(Player().play(scene, 2000).time < 2000 * 10);  // they would pay
  scene.jump_every = 4;
  const Count c = Player().play(scene, 2000);
  CHECK(c.lists[0] + c.lists[1] > 0);
  CHECK(c.time < 1.1 * 2000 * 10);
  scene.jump_every = 100;  // now and then one of them
  CHECK(Player().play(scene, 2000).time < 2000 * 10);
}

TEST_CASE("no caches are made if queries from scratch are very fast") {
  const Count c = Player().play({0.2, 0.1, 0.1, 0.01, 8, 8}, 2000);
  CHECK(c.lists[0] + c.lists[1] == 0);
}

TEST_CASE("caches that did not save time are tried again when the scene changes") {
  Player player;
  const PolicyScene dear{10, 40, 40, 9, 3, 3}, cheap{10, 15, 60, 2, 8, 8};
  player.play(dear, 1000);
  player.play(cheap, 300);
  CHECK(player.play(cheap, 1000).from_cache > 800);
  // Queries from scratch take longer by now, and so do lists: that is no failure.
  const PolicyScene deeper{100, 150, 600, 20, 8, 8};
  CHECK(player.play(deeper, 1000).from_cache > 800);
  // A body that wanders, for which no list paid, finds its course.
  PolicyScene lost = dear;
  lost.on_course = false;
  player.play(lost, 1000);
  player.play(cheap, 300);
  CHECK(player.play(cheap, 1000).from_cache > 800);
  // It wanders on, but less far.
  player.play(lost, 1000);
  PolicyScene near = lost;
  near.place_list = 15;
  near.place_serves = 20;
  near.step = 2;
  player.play(near, 300);
  CHECK(player.play(near, 1000).from_cache > 800);
}
