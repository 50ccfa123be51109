#include "engine/collide/pair_order.hpp"

#include <algorithm>
#include <random>

#include <doctest/doctest.h>

using namespace lrb;

namespace {

using PairAndMeet = std::pair<SimplexPair, exact::Meet>;

void check_same(const CollideResult& result, const std::vector<PairAndMeet>& expected) {
  REQUIRE(result.pairs.size() == expected.size());
  REQUIRE(result.meets.size() == expected.size());
  bool same = true;
  for (std::size_t i = 0; i < expected.size(); ++i)
    same &= result.pairs[i] == expected[i].first && result.meets[i] == expected[i].second;
  CHECK(same);
}

}  // namespace

TEST_CASE("pairs are sorted if half of them share a simplex of A") {
  std::mt19937_64 random(2);
  PairOrder order;
  for (const std::size_t size : {std::size_t{33}, std::size_t{100}, std::size_t{4'000}, std::size_t{5'000}}) {
    std::vector<SimplexPair> pairs;
    for (std::size_t i = 0; i < size; ++i)
      pairs.push_back({static_cast<SimplexId>(i % 2 == 0 ? 77'777 : random() % 200'000),
                       static_cast<SimplexId>(random() % 300'000)});
    std::vector<SimplexPair> expected = pairs;
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    order.sort(pairs);
    CHECK(pairs == expected);
  }
}

TEST_CASE("pairs are sorted with their kinds of contact, in short and long groups of the same simplex of A") {
  std::mt19937_64 random(3);
  PairOrder order;
  // To either side of where the way to sort changes: pairs in all, and pairs with the same simplex of A.
  for (const std::size_t size : {32, 33, 4096, 4097})
    for (const std::size_t alike : {1, 2, 8, 9, 16, 17, 30}) {
      CollideResult result;
      std::vector<PairAndMeet> expected;
      const std::size_t repeated = size / 10;
      for (std::size_t i = 0; i < size - repeated; ++i) {
        const SimplexPair p{static_cast<SimplexId>(i / alike), static_cast<SimplexId>(37 * i % 100'003)};
        expected.emplace_back(p, random() % 2 ? exact::Meet::cross : exact::Meet::touch);
      }
      std::ranges::sort(expected);
      std::vector<PairAndMeet> given = expected;
      given.insert(given.end(), expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(repeated));
      std::ranges::shuffle(given, random);
      for (const auto& [pair, meet] : given) {
        result.pairs.push_back(pair);
        result.meets.push_back(meet);
      }
      order.sort(result);
      CAPTURE(size);
      CAPTURE(alike);
      check_same(result, expected);
    }
}

TEST_CASE("pairs are sorted with their data by comparison sort and by radix sort") {
  std::mt19937_64 random(1);
  PairOrder order;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{100},
                                 std::size_t{2048}, std::size_t{2049}, std::size_t{50'000}})
    for (const std::uint32_t most : {1u, 300u, 5'000'000u, kMaxId}) {
      CollideResult result;
      std::vector<PairAndMeet> expected;
      for (std::size_t i = 0; i < size; ++i) {
        SimplexPair p{};
        p.a = static_cast<SimplexId>(random() % (std::uint64_t{most} + 1));
        p.b = static_cast<SimplexId>(random() % (std::uint64_t{most} + 1));
        const exact::Meet meet = (p.a ^ p.b) % 2 ? exact::Meet::cross : exact::Meet::touch;
        result.pairs.push_back(p);
        result.meets.push_back(meet);
        expected.emplace_back(p, meet);
      }
      order.sort(result);
      std::sort(expected.begin(), expected.end());
      expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
      CAPTURE(size);
      CAPTURE(most);
      check_same(result, expected);
    }
}
