/// The fuzzers' little brother: the same damage on every machine, without clang, in two seconds.

#include <filesystem>
#include <random>

#include <doctest/doctest.h>

#include "tests/fuzz/feed.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/mesh/io/encode.hpp"

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

/// Random bytes, as many as `lengths` says by turns, behind one of the first bytes.
void draw(const std::string& name, const std::string& first, const std::vector<std::size_t>& lengths,
          int rounds) {
  const Format& f = format(name);
  std::mt19937_64 random(1);
  for (const std::string& seed : f.seeds) CHECK(f.feed(seed));
  for (int round = 0; round < rounds; ++round) {
    std::string input(1, first[random() % first.size()]);
    for (std::size_t i = lengths[random() % lengths.size()]; i > 0; --i) input += static_cast<char>(random());
    CAPTURE(input);
    CHECK_NOTHROW(f.feed(input));
  }
}

}  // namespace

TEST_CASE("inputs found by fuzzers are rejected, or read and answered") {
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(LRB_SOURCE_DIR "/tests/fuzz/corpus")) {
    if (!entry.is_regular_file()) continue;
    CAPTURE(entry.path().string());
    const std::string name = entry.path().parent_path().filename().string();
    CHECK_NOTHROW(format(name).feed(test::load_bytes(entry.path().string())));
  }
}

TEST_CASE(".lrb files damaged field by field are rejected or safe to read") {
  draw("fields", std::string("\0\1\2\3\4\5\6\7\10\11\12\13", 12), {5, 5, 10, 15}, 250);
}
TEST_CASE("bodies of folded polygons are built, validated, saved, loaded and queried") {
  draw("body", "12", {20, 40, 100}, 1000);
}

TEST_CASE("damaged files of every format are rejected or safe to use; queries of any motions end") {
  for (const auto& [name, rounds] : std::vector<std::pair<const char*, int>>{{"mesh", 1000},
                                                                             {"lrb", 800},
                                                                             {"poses", 5000},
                                                                             {"scenario", 700},
                                                                             {"crowd", 1500},
                                                                             {"experiment", 500},
                                                                             {"trace", 250},
                                                                             {"capture", 20000},
                                                                             {"motion", 40}})
    mutate(name, rounds);
}

}  // namespace lrb::fuzz
