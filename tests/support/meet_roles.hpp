#pragma once
/// The engine's test of two simplices, asked in several roles: which one is first and the order of corners
/// must not matter.

#include "tests/support/random_simplices.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::test {

/// One rotation, one reflection, one exchange. `expected`: an exact::Meet.
inline bool triangles_meet_as(const SimplexPair& s, int expected) {
  const auto a = s.a(), b = s.b();
  const double* const turned[3] = {a[1], a[2], a[0]};
  const double* const reflected[3] = {b[0], b[2], b[1]};
  return static_cast<int>(exact::meet_triangles(a.data(), b.data())) == expected &&
         static_cast<int>(exact::meet_triangles(b.data(), turned)) == expected &&
         static_cast<int>(exact::meet_triangles(turned, reflected)) == expected;
}

inline bool segments_meet_as(const SimplexPair& s, int expected) {
  const auto a = s.a(), b = s.b();
  const double* const flipped[2] = {a[1], a[0]};
  return static_cast<int>(exact::meet_segments(a.data(), b.data())) == expected &&
         static_cast<int>(exact::meet_segments(b.data(), flipped)) == expected;
}

}  // namespace lrb::test
