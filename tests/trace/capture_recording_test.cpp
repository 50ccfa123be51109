#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <thread>
#include <vector>

#include <doctest/doctest.h>

#define LRBCAP_IMPLEMENTATION
#include "tests/trace/captures.hpp"
#include <lrbscope/error.hpp>

namespace lrb::capture {
namespace {

/// Changes the first instance of a row: it is twice as large along x.
Bytes stretched(Bytes row) {
  const double pose[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const auto* const from = reinterpret_cast<const std::byte*>(pose);
  const auto at = std::search(row.begin(), row.end(), from, from + sizeof pose);
  const double two = 2;
  std::memcpy(&*at, &two, sizeof two);
  return row;
}

}  // namespace

TEST_CASE("threads record at once, and helpers join a query") {
  const Bytes bytes = record([] {
    const std::uint32_t tree = a_tree();
    std::vector<std::thread> threads;
    for (std::uint32_t k = 0; k < 4; ++k)
      threads.emplace_back([=] {
        for (int q = 0; q < 20; ++q) {
          LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, tree, nullptr, tree, nullptr);
          LRBCAP_NODE(0, 0, 1, 255);
          for (std::uint32_t i = 0; i < 20000; ++i) LRBCAP_PRIM(k, i % 4, i % 2);
          LRBCAP_END(LRBCAP_INTERSECTING, k);
        }
        LRBCAP_THREAD_END();
      });
    for (std::thread& t : threads) t.join();
    threads.clear();
    const std::uint32_t query = LRBCAP_BEGIN(LRBCAP_ANY, tree, nullptr, tree, nullptr);
    for (std::uint32_t k = 0; k < 3; ++k)
      threads.emplace_back([=] {
        for (int again = 0; again < 2; ++again) {  // leaves and joins again
          LRBCAP_JOIN(query);
          for (std::uint32_t i = 0; i < 10000; ++i) LRBCAP_PRIM(k, i % 4, 0);
          LRBCAP_JOIN(0);
          LRBCAP_PRIM(0, 0, 1);  // in no query
        }
        LRBCAP_THREAD_END();
      });
    for (std::uint32_t i = 0; i < 5000; ++i) LRBCAP_PRIM(3, i % 4, 1);
    LRBCAP_JOIN(query);  // no effect: in a query of its own
    for (std::thread& t : threads) t.join();
    LRBCAP_END(LRBCAP_INTERSECTING, 1);
  });
  const Capture c = read(bytes);
  REQUIRE(c.queries.size() == 81);
  std::map<std::uint64_t, int> by_thread;
  for (std::size_t q = 0; q < 80; ++q) {
    const Query& query = c.queries[q];
    CHECK(query.number == q + 1);
    CHECK(query.complete());
    REQUIRE(query.events.size() == 20001);
    bool own = true;
    for (std::size_t i = 1; i < query.events.size(); ++i) own = own && query.events[i].a == query.pairs;
    CHECK(own);
    ++by_thread[query.pairs];
  }
  CHECK(by_thread == std::map<std::uint64_t, int>{{0, 20}, {1, 20}, {2, 20}, {3, 20}});
  const Query& joined = c.queries[80];
  CHECK(joined.complete());
  CHECK(joined.events.size() == 65000);
  REQUIRE(joined.parts.size() == 7);
  CHECK(joined.parts[0].thread == joined.thread);
  CHECK(joined.parts[0].count == 5000);
  for (std::size_t i = 1; i < 7; ++i) {
    CHECK(joined.parts[i].count == 10000);
    CHECK(joined.parts[i].first == 5000 + (i - 1) * 10000);
    CHECK(joined.parts[i].thread == joined.parts[(i - 1) / 2 * 2 + 1].thread);
  }
}

namespace {

/// Queries of 10, 20, 30 ... tests, each with a counter.
void queries(int count, std::uint32_t tests = 10) {
  const std::uint32_t name = LRBCAP_NAME("n");
  for (std::uint32_t q = 1; q <= static_cast<std::uint32_t>(count); ++q) {
    LRBCAP_BEGIN(LRBCAP_ANY, 0, nullptr, 0, nullptr);
    for (std::uint32_t i = 0; i < q * tests; ++i) LRBCAP_PRIM(i, i, 1);
    LRBCAP_COUNT(name, q);
    LRBCAP_END(LRBCAP_INTERSECTING, q);
  }
}

std::vector<std::uint32_t> numbers_of(const Capture& c) {
  std::vector<std::uint32_t> out;
  for (const Query& q : c.queries) out.push_back(q.number);
  return out;
}

}  // namespace

TEST_CASE("LRBCAP_QUERIES records some of the queries, a reader can take some of them") {
  using Numbers = std::vector<std::uint32_t>;
  const auto recorded = [](const char* range) {
    const Capture c = read(record([] { queries(6); }, {{"LRBCAP_QUERIES", range}}));
    for (const Query& q : c.queries) CHECK((q.complete() && q.pairs == q.number));
    return numbers_of(c);
  };
  CHECK(recorded("2-4") == Numbers{2, 3, 4});
  CHECK(recorded("5-") == Numbers{5, 6});
  CHECK(recorded("3") == Numbers{3});
  CHECK(recorded("4-2") == Numbers{});
  for (const char* wrong : {"-2", "0-3", "a", "2-x", "2 4"}) CHECK(recorded(wrong).size() == 6);
  const Capture some = read(record([] { queries(6); }), 3, 4);
  CHECK(numbers_of(some) == Numbers{3, 4});
  CHECK(some.queries[1].complete());
}

TEST_CASE("LRBCAP_EVENTS=0 keeps queries, counters and the number of events") {
  const Bytes bytes = record([] { queries(5, 5000); }, {{"LRBCAP_EVENTS", "0"}});
  CHECK(bytes.size() < 5 * 500);
  const Capture c = read(bytes);
  REQUIRE(c.queries.size() == 5);
  for (const Query& q : c.queries) {
    CHECK(q.events_seen == q.number * 5000 + 1);
    REQUIRE(q.events.size() == 1);
    CHECK(q.events[0] == Event{0, q.number, EventKind::count, 0, 1, 255});
    CHECK_FALSE(q.complete());
  }
}

TEST_CASE("LRBCAP_SLOWER_US keeps the events of slow and of long queries") {
  const Capture c = read(record(
      [] {
        const std::uint32_t name = LRBCAP_NAME("n");
        for (const int which : {0, 1, 2}) {
          LRBCAP_BEGIN(LRBCAP_ANY, 0, nullptr, 0, nullptr);
          for (int i = 0; i < (which == 2 ? 9000 : 3); ++i) LRBCAP_PRIM(0, 0, 0);
          LRBCAP_COUNT(name, 1);
          if (which == 1) std::this_thread::sleep_for(std::chrono::milliseconds(700));
          LRBCAP_END(LRBCAP_SEPARATE, 0);
        }
      },
      {{"LRBCAP_SLOWER_US", "500000"}}));
  REQUIRE(c.queries.size() == 3);
  CHECK(c.queries[0].events.size() == 1);  // the counter
  CHECK(c.queries[0].events_seen == 4);
  CHECK(c.queries[1].complete());
  CHECK(c.queries[1].duration_ns > 0.6e9);
  CHECK(c.queries[1].duration_ns < 60e9);
  CHECK(c.queries[2].events.size() >= 8192);
}

TEST_CASE("LRBCAP_MAX_MB ends events, then queries, and the capture stays whole") {
  const Bytes bytes = record([] { queries(2000, 1000); }, {{"LRBCAP_MAX_MB", "1"}});
  CHECK(bytes.size() > 1125000 - 1000);
  CHECK(bytes.size() < 1125000 + 1000);
  const Capture c = read(bytes);
  CHECK_FALSE(c.cut_off);
  REQUIRE(c.queries.size() > 300);
  CHECK(c.queries.size() < 500);
  CHECK(c.queries[0].complete());
  CHECK_FALSE(c.queries.back().complete());
  CHECK(c.queries.back().ended);
  CHECK(c.queries.back().events.empty());
  CHECK(c.queries.back().events_seen == c.queries.size() * 1000 + 1);
}

TEST_CASE("a query without an end, or within another, loses only ends") {
  const Capture c = read(record([] {
    LRBCAP_BEGIN(LRBCAP_ANY, 0, nullptr, 0, nullptr);
    LRBCAP_PRIM(1, 1, 0);
    LRBCAP_BEGIN(LRBCAP_ANY, 0, nullptr, 0, nullptr);
    LRBCAP_PRIM(2, 2, 0);
    LRBCAP_END(LRBCAP_SEPARATE, 0);
    LRBCAP_END(LRBCAP_INTERSECTING, 9);
    LRBCAP_BEGIN(LRBCAP_ANY, 0, nullptr, 0, nullptr);
    LRBCAP_PRIM(3, 3, 0);
  }));
  REQUIRE(c.queries.size() == 3);
  for (const Query& q : c.queries) CHECK(q.events.at(0).a == q.number);
  CHECK_FALSE(c.queries[0].ended);
  CHECK(c.queries[1].complete());
  CHECK_FALSE(c.queries[2].ended);
}

TEST_CASE("one query of each n in succession is recorded, at changing places") {
  const Capture c = read(record([] { queries(800); }, {{"LRBCAP_EVERY", "8"}}));
  std::map<std::uint32_t, int> places;
  for (const Query& q : c.queries) ++places[q.number % 8], CHECK((q.number - 1) / 8 == &q - c.queries.data());
  CHECK(c.every == 8);
  CHECK(c.queries.size() == 100);
  CHECK(places.size() == 8);
}

TEST_CASE("volumes of instances may be scaled, split and empty, and are limited in number") {
  // Four instances as in a_row(), the last one twice as large, of a body with these volumes.
  const auto row = [](std::uint32_t volume, const double* volumes, std::uint32_t vertices = 4) {
    return [=] {
      const std::vector<double> xyz(3 * std::size_t{vertices}, 0.5);
      lrbcap_tree tree = shape_of_tree(LRBCAP_MESH("wedge", vertices, xyz.data(), 4, kCorners));
      tree.volume = volume, tree.volumes = volumes;
      a_row(LRBCAP_TREE(&tree), volume == LRBCAP_SPHERE ? LRBCAP_SPHERE : LRBCAP_AABB);
    };
  };
  const double spheres[] = {0.5, 0.5, 0.5, 1, 0, 0, 0, 2, 1, 1, 1, 3};
  const Tree round = read(record(row(LRBCAP_SPHERE, spheres))).trees.at(1);
  CHECK(round.volume == VolumeKind::rss);
  for (const std::uint32_t child : {0, 1, 2})
    CHECK(round.volume_of(12 + child)[9] == 2 * spheres[4 * child + 3]);
  CHECK_FALSE(read(record(row(LRBCAP_AABB, kBoxes))).trees.at(1).splits);
  CHECK(read(record(row(LRBCAP_AABB | LRBCAP_SPLITS, kBoxes))).trees.at(1).splits);
  // An empty box is a point: no half axis.
  const double empty[] = {0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1};
  const Tree with_empty = read(record(row(LRBCAP_AABB, empty))).trees.at(1);
  for (std::size_t k = 3; k < 12; ++k) CHECK(with_empty.volume_of(4)[k] == 0);
  // Boxes along other axes than those of a scale would be skewed.
  const double boxes[36] = {};
  const Bytes good = record(row(LRBCAP_OBB, boxes));
  CHECK_NOTHROW(read(good));
  CHECK_THROWS_WITH_AS(read(stretched(good)), doctest::Contains("for AABBs one along each of their axes"),
                       InputError);
  CHECK_NOTHROW(read(stretched(record(row(LRBCAP_AABB, kBoxes)))));
  CHECK_NOTHROW(read(record(row(LRBCAP_AABB, kBoxes, 1'999'990))));
  CHECK_THROWS_WITH_AS(read(record(row(LRBCAP_AABB, kBoxes, 2'000'000))),
                       doctest::Contains("instance 3: more than 8 million"), InputError);
}

}  // namespace lrb::capture
