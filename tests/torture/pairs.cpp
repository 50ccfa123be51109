#include "tests/torture/pairs.hpp"

#include <chrono>
#include <cstdio>

#include "tests/support/meet_roles.hpp"
#include "tests/support/random_simplices.hpp"
#include "tests/support/rational_oracle.hpp"
#include "tests/torture/cgal_oracle.hpp"
#include "tests/torture/children.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/core/hash.hpp>

namespace lrb::torture {
namespace {

using test::Kind;

constexpr std::uint64_t kPairBatch = 20000;

struct PairTally {
  std::uint64_t pairs = 0, meet[3] = {}, wrong = 0, cgal_pairs = 0, cgal_wrong = 0, crashes = 0;
  std::uint64_t differences() const { return wrong + cgal_wrong + crashes; }
};

PairTally batch_of_pairs(Kind kind, int dim, std::uint64_t seed, Batch batch) {
  PairTally t;
  for (std::uint64_t i = batch.begin; i < batch.end; ++i) {
    Fnv64 h;
    for (const std::uint64_t x : {seed, static_cast<std::uint64_t>(kind), static_cast<std::uint64_t>(dim), i})
      h.add_value(x);
    test::Rng random(h.value());
    const test::SimplexPair s = test::random_pair(random, kind);
    const auto a = s.a(), b = s.b();
    const int expected = oracle::meet_of_simplices(a.data(), b.data(), static_cast<std::size_t>(dim));
    ++t.pairs;
    ++t.meet[expected];
    const bool right = dim == 3 ? test::triangles_meet_as(s, expected) : test::segments_meet_as(s, expected);
    if (!right && t.wrong++ < 3)
      std::fprintf(stderr, "%s, %dD, seed %llu, pair %llu: the oracle says %s\n", test::name_of(kind).c_str(),
                   dim, static_cast<unsigned long long>(seed), static_cast<unsigned long long>(i),
                   expected == 0   ? "disjoint"
                   : expected == 1 ? "touch"
                                   : "cross");
    const int cgal = dim == 3 ? cgal_triangles_meet(a.data(), b.data()) : -1;
    if (cgal < 0) continue;
    ++t.cgal_pairs;
    t.cgal_wrong += cgal != (expected != 0);
  }
  return t;
}

void print_row(const std::string& name, const char* what, const PairTally& t, double seconds) {
  const auto n = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
  std::printf("%-12s %-9s %9llu %9llu %9llu %9llu %9llu %10llu %9llu %8llu %7.1f\n", name.c_str(), what,
              n(t.pairs), n(t.meet[0]), n(t.meet[1]), n(t.meet[2]), n(t.wrong), n(t.cgal_pairs),
              n(t.cgal_wrong), n(t.crashes), seconds);
  std::fflush(stdout);
}

/// The oracle's integers are thousands of bits long for these: fewer of them.
std::uint64_t share_of(Kind kind) {
  return kind == Kind::extreme ? 1 : 5;
}

}  // namespace

std::uint64_t torture_pairs(std::uint64_t count, std::uint64_t seed, unsigned jobs) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::printf("%-12s %-9s %9s %9s %9s %9s %9s %10s %9s %8s %7s\n", "kind", "simplices", "pairs", "disjoint",
              "touch", "cross", "wrong", "CGAL", "CGAL says", "crashes", "s");
  constexpr int kKinds = static_cast<int>(Kind::count);
  std::uint64_t shares = 0;
  for (int k = 0; k < kKinds; ++k) shares += share_of(static_cast<Kind>(k));
  PairTally total;
  const auto begun = Clock::now();
  for (const int dim : {3, 2})
    for (int k = 0; k < kKinds; ++k) {
      const Kind kind = static_cast<Kind>(k);
      const auto start = Clock::now();
      const std::uint64_t pairs = ((dim == 3 ? count : count / 5) * share_of(kind) + shares - 1) / shares;
      const PairTally t = sum_in_children<PairTally>(
          pairs, kPairBatch, jobs, [&](Batch b) { return batch_of_pairs(kind, dim, seed, b); },
          [&](Batch b, int status) {
            std::fprintf(stderr, "%s, %dD: the process died (status %d) between pairs %llu and %llu\n",
                         test::name_of(kind).c_str(), dim, status, static_cast<unsigned long long>(b.begin),
                         static_cast<unsigned long long>(b.end));
            PairTally lost;
            lost.pairs = b.end - b.begin;
            lost.crashes = 1;
            return lost;
          });
      print_row(test::name_of(kind), dim == 3 ? "triangles" : "segments", t, since(start));
      total += t;
    }
  print_row("total", "", total, since(begun));
  return total.differences();
}

}  // namespace lrb::torture
