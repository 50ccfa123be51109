#include "scenarios/profile/prices.hpp"

#include <algorithm>

#include <doctest/doctest.h>

#include "scenarios/profile/captured_run.hpp"
#include "scenarios/profile/check.hpp"
#include "tests/support/faulty_engine.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/recorder.hpp>

namespace lrb::profile {

using namespace lrb::test;
using capture::QueryKind;

namespace {

std::uint64_t sum_of(const Prices& p) {
  return p.needed + p.proof + p.test + p.volumes + p.order + p.unsplit + p.unattributed;
}

/// A query priced with all that belongs to it.
struct Priced {
  CapturedBodies bodies;
  QueryWalk walk;
  PriceBook book;
  std::vector<TrianglePair> exact;
  Prices prices;

  explicit Priced(const capture::Capture& c, std::size_t query = 0, bool split = true)
      : bodies(c), walk(bodies, c.queries[query], bodies.trees_of(c.queries[query]).value()), book(bodies) {
    exact = Checker(bodies, Precision::float64).check(c.queries[query], &walk).exact;
    prices = book.add(c.queries[query], &walk, exact, split);
  }
};

/// The numbers of visits of all descents from a pair of nodes, whichever node they open at each pair.
struct AllDescents {
  const FaultyEngine& engine;
  const capture::Query& query;
  bool wide, both;

  std::set<std::uint64_t> from(std::uint32_t i, std::uint32_t j) const {
    const capture::Tree &a = engine.capture.trees[query.trees[0]], &b = engine.capture.trees[query.trees[1]];
    if (!wide && !engine.volumes_overlap(query, i, j)) return {1};
    std::set<std::uint64_t> out;
    if (a.is_leaf(i) && b.is_leaf(j)) return {1};
    for (int opens = 1; opens <= 3; ++opens) {
      const bool opens_a = (opens & 1) != 0, opens_b = (opens & 2) != 0;
      if ((opens_a && a.is_leaf(i)) || (opens_b && b.is_leaf(j)) || (opens == 3 && !both)) continue;
      std::set<std::uint64_t> sums{1};
      const std::vector<std::uint32_t> only_i{i}, only_j{j};
      for (const std::uint32_t x : opens_a ? a.children(i) : std::span<const std::uint32_t>(only_i))
        for (const std::uint32_t y : opens_b ? b.children(j) : std::span<const std::uint32_t>(only_j)) {
          if (wide && !engine.volumes_overlap(query, x, y)) continue;
          std::set<std::uint64_t> more;
          for (const std::uint64_t beneath : from(x, y))
            for (const std::uint64_t sum : sums) more.insert(sum + beneath);
          sums = std::move(more);
        }
      out.insert(sums.begin(), sums.end());
    }
    return out;
  }
};

/// Returns true if an intersecting pair lies beneath two nodes.
bool intersects_beneath(const FaultyEngine& engine, const capture::Query& q, std::uint32_t i,
                        std::uint32_t j) {
  const auto triangles = [](const capture::Tree& t, std::uint32_t root) {
    std::vector<std::uint32_t> out, open{root};
    while (!open.empty()) {
      const std::uint32_t n = open.back();
      open.pop_back();
      for (const std::uint32_t f : t.triangles(n)) out.push_back(f);
      for (const std::uint32_t c : t.children(n)) open.push_back(c);
    }
    return out;
  };
  const capture::Tree &a = engine.capture.trees[q.trees[0]], &b = engine.capture.trees[q.trees[1]];
  for (const std::uint32_t f : triangles(a, i))
    for (const std::uint32_t g : triangles(b, j))
      if (triangles_meet(engine.capture.meshes[a.mesh], f, q.poses[0], engine.capture.meshes[b.mesh], g,
                         q.poses[1]))
        return true;
  return false;
}

constexpr OpeningOrder kOrders[] = {OpeningOrder::a_first, OpeningOrder::b_first, OpeningOrder::larger,
                                    OpeningOrder::both};

}  // namespace

TEST_CASE("The prices of random descents are those of their definition, and of a search over all descents") {
  std::mt19937_64 random(11);
  int with_order = 0, with_volumes = 0;
  for (int round = 0; round < 160; ++round) {
    CAPTURE(round);
    FaultyEngine engine;
    const bool wide = round % 2 == 1;
    // Trees of up to 15 nodes.
    const auto grow = [&] {
      return engine.grow(engine.add(soup_mesh(random, wide ? 9 : 8, 0.3)), random, 1, wide ? 4 : 2);
    };
    const std::uint32_t a = grow(), b = grow();
    REQUIRE(engine.capture.trees[a].size() <= 17);
    FaultyQuery how;
    how.wide = wide;
    how.order = kOrders[(round / 2) % 4];
    const double apart = 0.5 * static_cast<double>(round % 5) / 4;
    const capture::Query q =
        engine.ask(a, Pose::rotation({1, 2, 3}, round), b, Pose::translation({apart, 0, 0}), how);
    const Priced priced(engine.capture);
    const Prices& p = priced.prices;
    CHECK(sum_of(p) == p.visits);
    CHECK(p.unsplit + p.unattributed == 0);
    // Needed and proof, by their definition.
    std::uint64_t visits = 0, needed = 0, proof = 0;
    for (std::size_t i = 0; i < q.events.size(); ++i) {
      const capture::Event& e = q.events[i];
      if (e.kind != capture::EventKind::nodes) continue;
      ++visits;
      const std::uint32_t up = priced.walk.parent(i);
      if (intersects_beneath(engine, q, e.a, e.b))
        ++needed;
      else if (up == QueryWalk::kNone || intersects_beneath(engine, q, q.events[up].a, q.events[up].b))
        ++proof;
    }
    CHECK(p.visits == visits);
    CHECK(p.needed == needed);
    CHECK(p.proof == proof);
    // The least number of visits, from a search over all descents.
    bool opened_both = false;
    for (const std::uint32_t i : priced.walk.from_root())
      opened_both = opened_both || priced.walk.step(i) == NodeStep::descend_both;
    const std::set<std::uint64_t> all =
        AllDescents{engine, q, wide && priced.walk.wide(), opened_both}.from(0, 0);
    CHECK(all.count(visits) == 1);
    Priced again(engine.capture);
    CHECK(least_visits(again.bodies, again.walk) == *all.begin());
    CHECK(needed + proof + p.volumes == std::max(*all.begin(), needed + proof));
    with_order += p.order > 0;
    with_volumes += p.volumes > 0;
    // The parts add up.
    double shared = 0;
    for (const std::uint32_t tree : {a, b})
      for (const double x : again.book.waste_by_triangle(tree)) shared += x;
    CHECK(shared == doctest::Approx(static_cast<double>(p.wasted())));
  }
  CHECK(with_order > 20);
  CHECK(with_volumes > 20);
}

TEST_CASE("Visits beside the descent are unattributed, and repeated ones are order") {
  std::mt19937_64 random(9);
  FaultyEngine engine;
  const std::uint32_t a = engine.grow(engine.add(soup_mesh(random, 20)), random);
  engine.ask(a, {}, a, Pose::translation({0.4, 0.2, 0.1}));
  const Prices before = Priced(engine.capture).prices;
  capture::Query& q = engine.capture.queries[0];
  const std::vector<capture::Event> events = q.events;
  // The first event comes last: visits of another thread.
  std::rotate(q.events.begin(), q.events.begin() + 1, q.events.end());
  CHECK(Priced(engine.capture).prices == before);
  // All events twice.
  q.events = events;
  q.events.insert(q.events.end(), events.begin(), events.end());
  FaultyEngine::close(q);
  const Prices twice = Priced(engine.capture).prices;
  CHECK(twice.needed == before.needed);
  CHECK(twice.proof == before.proof);
  CHECK(twice.volumes == before.volumes);
  CHECK(twice.order == before.order + before.visits);
  // Without the visit of the roots, the descent begins with their children.
  q.events.assign(events.begin() + 1, events.end());
  FaultyEngine::close(q);
  const Prices below = Priced(engine.capture).prices;
  CHECK(below.unattributed == 0);
  CHECK(below.needed == before.needed - 1);
  // An engine that skips a level: the visits below belong to the closest pair above whose volumes overlap.
  const TreeIndex index(engine.capture.trees[a], 20);
  const auto level_of = [&](const capture::Event& e) {
    return e.kind == capture::EventKind::nodes ? index.depth[e.a] + index.depth[e.b] : 0;
  };
  q.events = events;
  const std::uint64_t skipped = std::erase_if(q.events, [&](const auto& e) { return level_of(e) == 3; });
  REQUIRE(skipped > 0);
  FaultyEngine::close(q);
  const Prices fewer = Priced(engine.capture).prices;
  CHECK(fewer.unattributed == 0);
  CHECK(fewer.visits == before.visits - skipped);
  CHECK(sum_of(fewer) == fewer.visits);
  CHECK(fewer.needed <= before.needed);
  CHECK(fewer.needed + skipped >= before.needed);
  for (capture::Event& e : q.events)
    if (level_of(e) <= 2 && e.kind == capture::EventKind::nodes) e.met = 0;
  CHECK(Priced(engine.capture).prices.unattributed > 0);
  // Without the first levels, the rest hangs in the air.
  q.events.assign(events.begin() + 1, events.end());
  std::uint64_t left = 0;
  std::erase_if(q.events, [&](const capture::Event& e) {
    return e.kind == capture::EventKind::nodes && index.depth[e.a] + index.depth[e.b] <= 2;
  });
  for (const capture::Event& e : q.events) left += e.kind == capture::EventKind::nodes;
  FaultyEngine::close(q);
  const Prices lost = Priced(engine.capture).prices;
  CHECK(left > 10);
  CHECK(lost.unattributed == left);
  CHECK(sum_of(lost) == lost.visits);
}

TEST_CASE("Broken trees, other kinds of queries and sides without a tree are priced without a crash") {
  std::mt19937_64 random(10);
  FaultyEngine engine;
  const std::uint32_t a = engine.grow(engine.add(soup_mesh(random, 20)), random, 2);
  engine.ask(a, {}, a, Pose::translation({0.4, 0.2, 0.1}));
  const capture::Capture sound = engine.capture;
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    capture::Capture c = sound;
    capture::Tree& t = c.trees[0];
    // Children and triangles at random: cycles, nodes without parents or with two, triangles in no leaf.
    for (int k = 0; k < 1 + round % 5; ++k) {
      t.child[random() % t.child.size()] = static_cast<std::uint32_t>(random() % t.size());
      t.triangle[random() % t.triangle.size()] = static_cast<std::uint32_t>(random() % 25);
    }
    const Check checked = check(c, {});
    const Prices p = checked.sum().prices;
    CHECK(sum_of(p) == p.visits);
    CHECK(p.visits == Priced(sound).prices.visits);
  }
  capture::Capture c = sound;
  c.queries[0].kind = QueryKind::first_contact;
  const Prices p = check(c, {}).sum().prices;
  CHECK(p.unattributed == p.visits);
  // A query of distance whose bodies intersect.
  c.queries[0].kind = QueryKind::distance;
  const Prices of_distance = check(c, {}).sum().prices;
  CHECK(of_distance.needed > 0);
  CHECK(of_distance.needed + of_distance.order == of_distance.visits);
  CHECK(of_distance.crowded_tests > 0);
  FaultyEngine of_leaves;  // of which each has all triangles
  const std::uint32_t leaf = of_leaves.grow(of_leaves.add(soup_mesh(random, 20)), random, 20);
  of_leaves.ask(leaf, {}, leaf, Pose::translation({0.4, 0.2, 0.1})).kind = QueryKind::distance;
  const Prices of_leaf = check(of_leaves.capture, {}).sum().prices;
  CHECK(of_leaf.triangle_tests_for_nothing < 20 * 20);
  CHECK(of_leaf.crowded_tests == of_leaf.triangle_tests_for_nothing);
  c = sound;
  c.queries[0].trees[1] = kNull;
  std::erase_if(c.queries[0].events,
                [](const capture::Event& e) { return e.kind == capture::EventKind::nodes; });
  CHECK(check(c, {}).sum().prices.visits == 0);
}

TEST_CASE("Prices of distances: hits as close by rounding, rays that miss, and boxes") {
  struct Case {
    capture::Probe probe;
    double height;  // of the second of two triangles; the first is at 1
    std::uint64_t for_nothing, needed, volumes;
  };
  for (const Case& k : {Case{ray_along_z(), 1 + 1e-12, 0, 2, 0},
                        {ray_along_z(), 1 + 1e-6, 1, 2, 0},
                        {ray_along_z(0.9), 2, 2, 0, 2},
                        {{capture::ProbeShape::box, {-3, -1, 0, -2, 1, 3}}, 2, 0, 2, 0}}) {
    const Prices p =
        Priced(capture_of(mesh_across_z({-1, -1}, {1, k.height}), k.probe, QueryKind::distance)).prices;
    CHECK(std::array{p.triangle_tests_for_nothing, p.needed, p.volumes} ==
          std::array{k.for_nothing, k.needed, k.volumes});
  }
}

TEST_CASE("The advice names the change with most to gain, and the next") {
  Prices p;
  p.visits = p.volume_tests = 800;
  p.needed = 100, p.proof = 100, p.volumes = 200, p.order = 400;
  p.triangle_tests = 200;
  CHECK(advice(p) == "Most to gain: another order of descent, at most 40 % of " + render::group_digits(1000) +
                         " tests of volumes and triangles; next: tighter volumes, at most 60 %, of which no "
                         "other change saves 20 %.");
  p.crowded_tests = 190;
  p.order = 0, p.volumes = 600;
  CHECK(advice(p).find("Most to gain: tighter volumes, at most 60 %") == 0);
  CHECK(advice(p).find("next: smaller leaves, at most 19 %") != std::string::npos);
  p.saved_by_leaves = {100, 700, 300};
  CHECK(advice(p).find("Most to gain: leaves of up to 4 triangles, at most 70 %") == 0);
  p.saved_by_leaves = {};
  p.volumes = 0, p.unsplit = 600;
  CHECK(advice(p).find("Most to gain: tighter volumes or another order of descent, at most 60 %") == 0);
  p.unsplit = 0, p.volumes = p.order = 200, p.test = 200;
  p.triangles_by_volumes = p.triangles_by_test = 150;
  CHECK(advice(p) == "Most to gain: a sharper test of these volumes, at most 35 % of " +
                         render::group_digits(1000) +
                         " tests of volumes and triangles; next: another order of descent, at most 20 %.");
  // Wide nodes compare several volumes in a visit.
  p.volume_tests = 1600;
  CHECK(advice(p).find("Most to gain: a sharper test of these volumes, at most 31 %") == 0);
  CHECK(advice({}) == "No tests were recorded.");
  Prices triangles;
  triangles.triangle_tests = 100, triangles.triangle_tests_for_nothing = 90;
  CHECK(advice(triangles).find("No tests of volumes were recorded (LRBCAP_NODE)") == 0);
  Prices needed;
  needed.visits = needed.volume_tests = needed.needed = 10;
  CHECK(advice(needed) == "Nothing to gain: every visit was needed.");
  needed.needed = 0, needed.unattributed = 10;
  CHECK(advice(needed).find("No visit is attributed") == 0);
}

}  // namespace lrb::profile
