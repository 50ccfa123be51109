/// The fuzzers' little brother: the same damage on every machine, without clang, in two seconds.

#include <random>

#include <doctest/doctest.h>

#include "tests/fuzz/feed.hpp"
#include "tests/fuzz/seeds.hpp"

namespace lrb::fuzz {
namespace {

const Format& format(const std::string& name) {
  static const std::vector<Format> all = formats();
  for (const Format& f : all)
    if (f.name == name) return f;
  throw std::logic_error("no format " + name);
}

std::string damaged(std::string bytes, const std::string& other, std::mt19937_64& random) {
  for (auto changes = 1 + random() % 3; changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 5) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, 1 + random() % 8);
        break;
      case 2:
        bytes.insert(at, 1, "0123456789-. \n/e\"{}[]:,"[random() % 23]);
        break;
      case 3:
        bytes.insert(at, other.substr(random() % other.size(), random() % 32));
        break;
      default:
        bytes.resize(random() % 8 == 0 ? at : bytes.size());
        break;
    }
  }
  return bytes;
}

void mutate(const std::string& name, int rounds) {
  const Format& f = format(name);
  std::mt19937_64 random(1);
  for (const std::string& seed : f.seeds) {
    CHECK(f.feed(seed));
    for (int round = 0; round < rounds; ++round) {
      const std::string input = damaged(seed, f.seeds[random() % f.seeds.size()], random);
      CAPTURE(input);
      CHECK_NOTHROW(f.feed(input));
    }
  }
}

}  // namespace

// Meshes are damaged in tests/mesh/io/malformed_test.cpp.
TEST_CASE("damaged .lrb files are refused or safe to use") {
  mutate("lrb", 800);
}
TEST_CASE("damaged pose files are refused or read") {
  mutate("poses", 5000);
}
TEST_CASE("damaged scenarios are refused or read") {
  mutate("scenario", 700);
}
TEST_CASE("damaged crowds and experiments are refused or read") {
  mutate("crowd", 1500);
  mutate("experiment", 500);
}
TEST_CASE("damaged traces are refused or read") {
  mutate("trace", 250);
}

}  // namespace lrb::fuzz
