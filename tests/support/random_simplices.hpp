#pragma once
/// RandomEngine simplices of every awkward kind, reproducible from a seed.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include <doctest/doctest.h>

namespace lrb::test {

using Rng = std::mt19937_64;

inline int random_int(Rng& rng, int low, int high) {
  return low + static_cast<int>(rng() % static_cast<std::uint64_t>(high - low + 1));
}
inline double random_unit(Rng& rng) {
  return static_cast<double>(rng() >> 11) * 0x1p-53;
}

/// Returns the number of rounds to run: `standard` times LRB_EXACT_EFFORT (a number, 1 if unset).
inline int effort(int standard) {
  const char* text = std::getenv("LRB_EXACT_EFFORT");
  const double factor = text == nullptr ? 1 : std::atof(text);
  return static_cast<int>(standard * factor);
}

/// Two triangles (3 coordinates each point), or two segments (the first two corners, z ignored).
struct SimplexPair {
  std::array<std::array<double, 3>, 6> p{};
  std::array<const double*, 3> a() const { return {p[0].data(), p[1].data(), p[2].data()}; }
  std::array<const double*, 3> b() const { return {p[3].data(), p[4].data(), p[5].data()}; }
};

enum class Kind {
  grid,         ///< coordinates 0 .. 3: all degeneracies
  tiny_grid,    ///< coordinates 0 .. 1
  collinear,    ///< a grid; corners of many triangles are on one line or equal
  underflow,    ///< real or nudged, scaled so that determinants are about the least double
  nudged_grid,  ///< a grid, some coordinates moved by one unit in the last place
  real,         ///< random doubles in [0, 1)
  shared,       ///< random doubles; corners of b copied from a, or affine combinations of them, rounded
  coplanar,     ///< random doubles in a plane, rounded
  far_grid,     ///< a nudged grid moved by 1e8 or 1e16
  scaled,       ///< nudged or real, each axis scaled by up to 1e-150 .. 1e150
  sliver,       ///< thin triangles along nearly one line
  wide,         ///< as shared, some coordinates 1e-17 instead of 0: too far apart for 64-bit fixed point
  extreme,      ///< denormals, zeros and 1e308 mixed
  count
};

/// Rounds for one kind: the oracle's integers are thousands of bits long for the extreme ones.
inline int rounds_for(Kind k, int standard) {
  return effort(k == Kind::extreme ? (standard + 4) / 5 : standard);
}

inline double nudge(Rng& rng, double x) {
  const int r = random_int(rng, 0, 5);
  if (r == 0) return std::nextafter(x, std::numeric_limits<double>::infinity());
  if (r == 1) return std::nextafter(x, -std::numeric_limits<double>::infinity());
  return x;
}

template <int kHigh>
void fill_grid(Rng& rng, SimplexPair& s) {
  for (auto& p : s.p)
    for (double& x : p) x = random_int(rng, 0, kHigh);
}

inline void fill_nudged_grid(Rng& rng, SimplexPair& s) {
  fill_grid<3>(rng, s);
  for (auto& p : s.p)
    for (double& x : p) x = nudge(rng, x);
}

inline void fill_far_grid(Rng& rng, SimplexPair& s) {
  fill_grid<3>(rng, s);
  const double far = random_int(rng, 0, 1) == 0 ? 1e8 : 1e16;
  for (auto& p : s.p)
    for (double& x : p) x = nudge(rng, x * 2 + far);
}

inline void fill_real(Rng& rng, SimplexPair& s) {
  for (auto& p : s.p)
    for (double& x : p) x = random_unit(rng);
}

inline void fill_scaled(Rng& rng, SimplexPair& s) {
  fill_nudged_grid(rng, s);
  if (random_int(rng, 0, 1) == 0) fill_real(rng, s);
  for (std::size_t k = 0; k < 3; ++k) {
    const double factor = std::ldexp(1.0, random_int(rng, -498, 498));
    for (auto& p : s.p) p[k] *= factor;
  }
}

/// Replaces some corners of b by corners of a or by rounded points of a.
inline void share_corners(Rng& rng, SimplexPair& s) {
  for (std::size_t j = 3; j < 6; ++j) {
    const int r = random_int(rng, 0, 3);
    if (r == 0) s.p[j] = s.p[static_cast<std::size_t>(random_int(rng, 0, 2))];
    if (r != 1) continue;
    const double u = random_unit(rng), v = random_int(rng, 0, 1) * random_unit(rng);
    for (std::size_t k = 0; k < 3; ++k)
      s.p[j][k] = s.p[0][k] + u * (s.p[1][k] - s.p[0][k]) + v * (s.p[2][k] - s.p[0][k]);
  }
}

inline void fill_shared(Rng& rng, SimplexPair& s) {
  fill_real(rng, s);
  share_corners(rng, s);
}

inline void fill_coplanar(Rng& rng, SimplexPair& s) {
  const double f = random_unit(rng), g = random_unit(rng);
  const bool lattice = random_int(rng, 0, 1) == 1;
  for (auto& p : s.p) {
    p[0] = lattice ? random_int(rng, 0, 3) : random_unit(rng);
    p[1] = lattice ? random_int(rng, 0, 3) : random_unit(rng);
    p[2] = p[0] * f + p[1] * g;
    const double x = p[0];
    p[0] = 0.8 * x - 0.6 * p[1];
    p[1] = 0.6 * x + 0.8 * p[1];
  }
}

inline void fill_sliver(Rng& rng, SimplexPair& s) {
  const std::array<double, 3> d{random_unit(rng), random_unit(rng), random_unit(rng)};
  for (auto& p : s.p) {
    const double t = random_unit(rng) * 4 - 2;
    for (std::size_t k = 0; k < 3; ++k) p[k] = nudge(rng, d[k] * t);
  }
}

inline void fill_collinear(Rng& rng, SimplexPair& s) {
  fill_grid<2>(rng, s);
  for (std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    if (random_int(rng, 0, 3) == 0) continue;
    const int t = random_int(rng, -1, 2);
    for (std::size_t k = 0; k < 3; ++k)
      s.p[first + 2][k] = s.p[first][k] + t * (s.p[first + 1][k] - s.p[first][k]);
    std::swap(s.p[first + 2], s.p[first + static_cast<std::size_t>(random_int(rng, 0, 2))]);
  }
}

inline void fill_underflow(Rng& rng, SimplexPair& s) {
  fill_grid<3>(rng, s);
  if (random_int(rng, 0, 1) == 0) fill_real(rng, s);
  share_corners(rng, s);
  const bool in_plane = random_int(rng, 0, 1) == 0;  // then products of two factors are
  const double factor = std::ldexp(1.0, random_int(rng, 0, 18) - (in_plane ? 541 : 361));
  for (auto& p : s.p)
    for (double& x : p) x = nudge(rng, x) * factor;
}

inline void fill_wide(Rng& rng, SimplexPair& s) {
  fill_grid<2>(rng, s);
  for (auto& p : s.p) {
    for (double& x : p) {
      if (x == 0) x = random_int(rng, 0, 2) * 1e-17;
      if (x == 1) x = random_int(rng, 0, 1) == 0 ? 1 : 0.1;
    }
  }
  share_corners(rng, s);
}

inline void fill_extreme(Rng& rng, SimplexPair& s) {
  for (auto& p : s.p) {
    for (double& x : p) {
      static constexpr double kValues[] = {0, 1, 4.9e-324, 2.2e-308, 1e-160, 1e160, 8e307, 1.7e308};
      x = kValues[random_int(rng, 0, 7)] * (random_int(rng, 0, 1) == 0 ? 1 : -1);
    }
  }
}

/// Each kind in the order of Kind.
struct KindEntry {
  const char* name;
  void (*fill)(Rng& rng, SimplexPair& s);
};
inline constexpr KindEntry kKinds[] = {
    {"grid", fill_grid<3>},        {"tiny_grid", fill_grid<1>},       {"collinear", fill_collinear},
    {"underflow", fill_underflow}, {"nudged_grid", fill_nudged_grid}, {"real", fill_real},
    {"shared", fill_shared},       {"coplanar", fill_coplanar},       {"far_grid", fill_far_grid},
    {"scaled", fill_scaled},       {"sliver", fill_sliver},           {"wide", fill_wide},
    {"extreme", fill_extreme}};

inline std::string name_of(Kind k) {
  return kKinds[static_cast<int>(k)].name;
}

inline SimplexPair random_pair(Rng& rng, Kind kind) {
  SimplexPair s;
  kKinds[static_cast<int>(kind)].fill(rng, s);
  return s;
}

/// Calls check(random, pair, kind) for `rounds` random pairs of each kind; grids, whose oracle is fast, get
/// `grid_factor` more. Each call must return true.
template <class Check>
void for_each_kind(std::uint64_t seed, int rounds, int grid_factor, const Check& check) {
  for (int k = 0; k < static_cast<int>(Kind::count); ++k) {
    const Kind kind = static_cast<Kind>(k);
    const bool is_grid = kind == Kind::grid || kind == Kind::tiny_grid || kind == Kind::collinear;
    Rng rng(seed + static_cast<std::uint64_t>(k));
    const int n = rounds_for(kind, rounds) * (is_grid ? grid_factor : 1);
    int wrong = 0;
    for (int i = 0; i < n; ++i) wrong += check(rng, random_pair(rng, kind), kind) ? 0 : 1;
    CHECK_MESSAGE(wrong == 0, name_of(kind) << ": " << wrong << " of " << n << " disagree");
  }
}

}  // namespace lrb::test
