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

TEST_CASE("pairs are sorted with their kinds of contact, each once, by every way to sort") {
  std::mt19937_64 random(2);
  PairOrder order;
  // To either side of where the way to sort changes: pairs in all, pairs with the same simplex of A, numbers.
  for (const std::size_t size : {0, 1, 2, 32, 33, 100, 2048, 2049, 4096, 4097, 50'000})
    for (const std::size_t alike : {0, 1, 2, 8, 9, 16, 17, 30})  // 0: half of them
      for (const std::uint32_t most : {1u, 300u, 5'000'000u, kMaxId}) {
        CollideResult result;
        std::vector<PairAndMeet> expected;
        for (std::size_t i = 0; i < size; ++i) {
          const std::uint64_t a = alike == 0 ? (i % 2 == 0 ? 77 : random()) : i / alike;
          const SimplexPair p{static_cast<SimplexId>(a % (std::uint64_t{most} + 1)),
                              static_cast<SimplexId>(random() % (std::uint64_t{most} + 1))};
          expected.emplace_back(p, (p.a ^ p.b) % 2 ? exact::Meet::cross : exact::Meet::touch);
        }
        std::ranges::shuffle(expected, random);
        std::vector<SimplexPair> alone;
        for (const auto& [pair, meet] : expected) {
          result.pairs.push_back(pair);
          result.meets.push_back(meet);
          alone.push_back(pair);
        }
        order.sort(result);
        order.sort(alone);
        std::ranges::sort(expected);
        expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
        CAPTURE(size);
        CAPTURE(alike);
        CAPTURE(most);
        check_same(result, expected);
        CHECK(alone == result.pairs);
      }
}
