// Exact tests by kind of pair; an iteration is 1000 pairs, so that Time in ns is picoseconds per pair.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/exact/predicates.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/contact.hpp>

using namespace lrb;

namespace {

using Vec = std::array<double, 3>;
using Matrix = std::array<Vec, 3>;

/// Two triangles.
struct SimplexPair {
  std::array<Vec, 6> p{};
  std::array<const double*, 3> a() const { return {p[0].data(), p[1].data(), p[2].data()}; }
  std::array<const double*, 3> b() const { return {p[3].data(), p[4].data(), p[5].data()}; }
};

/// A rotation after which no coordinate is a round number.
Vec rotated(const Vec& p) {
  static const Matrix r = [] {
    const double a = 0.7, b = 1.1;
    return Matrix{Vec{std::cos(a), -std::sin(a) * std::cos(b), std::sin(a) * std::sin(b)},
                  Vec{std::sin(a), std::cos(a) * std::cos(b), -std::cos(a) * std::sin(b)},
                  Vec{0, std::sin(b), std::cos(b)}};
  }();
  Vec q{};
  for (std::size_t i = 0; i < 3; ++i) q[i] = ((r[i][0] * p[0] + r[i][1] * p[1]) + r[i][2] * p[2]) + 0.1;
  return q;
}

void rotate(SimplexPair& s) {
  for (auto& p : s.p) p = rotated(p);
}

enum class Case {
  near_miss_or_cross,
  flat,
  flat_rotated,
  flat_exact,
  corner,
  edge,
  same,
  flat_corner_rotated
};

SimplexPair make(shapes::RandomEngine& random, Case kind) {
  SimplexPair s;
  for (Vec& p : s.p)
    for (double& x : p) x = shapes::uniform(random);
  const bool flat = kind == Case::flat || kind == Case::flat_rotated || kind == Case::flat_corner_rotated;
  if (flat) {
    for (auto& p : s.p) p[2] = 0.25;
  }
  if (kind == Case::flat_exact) {  // exactly coplanar, in a plane not along an axis: short mantissas
    for (auto& p : s.p) {
      for (std::size_t k = 0; k < 2; ++k) p[k] = std::floor(p[k] * 0x1p20) * 0x1p-20;
      p[2] = p[0] * 0.375 + p[1] * 0.625;
    }
  }
  if (kind == Case::corner || kind == Case::edge || kind == Case::same || kind == Case::flat_corner_rotated) {
    s.p[4] = s.p[0];
  }
  if (kind == Case::edge || kind == Case::same) s.p[3] = s.p[2];
  if (kind == Case::same) s.p[5] = s.p[1];
  if (kind != Case::flat && kind != Case::flat_exact) rotate(s);
  return s;
}

void meet_triangles(benchmark::State& state, Case kind) {
  shapes::RandomEngine random(5);
  std::vector<SimplexPair> pairs(1000);
  for (auto& s : pairs) s = make(random, kind);
  const auto before = exact::exact_fallbacks();
  std::uint64_t calls = 0, meets = 0;
  for (auto _ : state) {
    for (const auto& s : pairs) {
      meets += exact::meet_triangles(s.a().data(), s.b().data()) != exact::Meet::disjoint;
    }
    calls += pairs.size();
  }
  benchmark::DoNotOptimize(meets);
  state.counters["meet"] = static_cast<double>(meets) / static_cast<double>(calls);
  state.counters["fallbacks"] =
      static_cast<double>(exact::exact_fallbacks() - before) / static_cast<double>(calls);
}

void only_in_shared(benchmark::State& state, Case kind, std::array<VertexId, 3> ib) {
  shapes::RandomEngine random(6);
  std::vector<SimplexPair> pairs(1000);
  for (auto& s : pairs) s = make(random, kind);
  const VertexId ia[3] = {0, 1, 2};
  std::uint64_t calls = 0, clean = 0;
  for (auto _ : state) {
    for (const auto& s : pairs)
      clean += exact::meet_only_in_shared(s.a().data(), ia, s.b().data(), ib.data());
    calls += pairs.size();
  }
  benchmark::DoNotOptimize(clean);
  state.counters["clean"] = static_cast<double>(clean) / static_cast<double>(calls);
}

}  // namespace

BENCHMARK_CAPTURE(meet_triangles, random, Case::near_miss_or_cross);
BENCHMARK_CAPTURE(meet_triangles, coplanar_axis, Case::flat);
BENCHMARK_CAPTURE(meet_triangles, coplanar_rotated_and_rounded, Case::flat_rotated);
BENCHMARK_CAPTURE(meet_triangles, coplanar_exact_oblique, Case::flat_exact);
BENCHMARK_CAPTURE(meet_triangles, shared_corner, Case::corner);
BENCHMARK_CAPTURE(meet_triangles, shared_edge, Case::edge);
BENCHMARK_CAPTURE(meet_triangles, identical, Case::same);
BENCHMARK_CAPTURE(meet_triangles, shared_corner_nearly_coplanar, Case::flat_corner_rotated);
BENCHMARK_CAPTURE(only_in_shared, no_corner, Case::near_miss_or_cross, {3, 4, 5});
BENCHMARK_CAPTURE(only_in_shared, one_corner, Case::corner, {3, 0, 5});
BENCHMARK_CAPTURE(only_in_shared, one_corner_nearly_coplanar, Case::flat_corner_rotated, {3, 0, 5});
BENCHMARK_CAPTURE(only_in_shared, edge, Case::edge, {2, 0, 5});
BENCHMARK_MAIN();
