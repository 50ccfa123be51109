// Numbering agrees with a map, also when it grows and when it is used again.
#include "engine/core/numbering.hpp"

#include <map>
#include <random>

#include <doctest/doctest.h>

using namespace lrb;

TEST_CASE("keys are numbered in the order of their first use") {
  std::mt19937_64 random(3);
  Numbering<2> numbering;
  for (int round = 0; round < 20; ++round) {
    std::map<Numbering<2>::Key, std::uint32_t> expected;
    numbering.begin(round % 3 == 0 ? 1000 : 2);  // with too few slots it grows
    for (int i = 0; i < 2000; ++i) {
      const Numbering<2>::Key key{random() % 40, random() % 40};
      CHECK(numbering.contains(key) == expected.contains(key));
      const auto [at, is_new] = expected.emplace(key, static_cast<std::uint32_t>(expected.size()));
      CHECK((numbering.number(key) == std::pair{at->second, is_new}));
    }
  }
}
