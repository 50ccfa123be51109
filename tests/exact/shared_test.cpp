#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "tests/support/hull_oracle.hpp"
#include "tests/support/random_simplices.hpp"
#include <lrbscope/contact.hpp>

using namespace lrb;
using lrb::test::Kind;

namespace {

using Ids = std::array<VertexId, 3>;

/// Gives b some of a's vertices, by index and by coordinates.
Ids share_vertices(test::Rng& rng, test::SimplexPair& s, std::size_t n) {
  Ids ids{3, 4, 5};
  std::array<bool, 3> used{};
  for (std::size_t j = 0; j < n; ++j) {
    const auto i = static_cast<std::size_t>(test::random_int(rng, 0, 5));
    if (i >= n || used[i]) continue;
    used[i] = true;
    ids[j] = VertexId(i);
    s.p[3 + j] = s.p[i];
  }
  return ids;
}

/// Nothing but the shared face: the hulls stay apart if any of the corners that are not shared is given a
/// positive weight. A linear program decides this for each such corner, without geometry.
bool only_in_shared(const test::SimplexPair& s, const Ids& ids, std::size_t n) {
  const auto a = s.a(), b = s.b();
  const auto p = oracle::to_integers({{a.begin(), a.begin() + static_cast<std::ptrdiff_t>(n)},
                                      {b.begin(), b.begin() + static_cast<std::ptrdiff_t>(n)}},
                                     n);
  const int dim = static_cast<int>(n) - 1;
  if (oracle::affine_dimension(p[0]) < dim || oracle::affine_dimension(p[1]) < dim) return false;
  std::vector<bool> a_shared(n, false);
  std::vector<bool> b_shared(n, false);
  for (std::size_t j = 0; j < n; ++j) {
    b_shared[j] = ids[j] < n;
    if (b_shared[j]) a_shared[ids[j]] = true;
  }
  if (std::count(b_shared.begin(), b_shared.end(), true) == static_cast<std::ptrdiff_t>(n)) return false;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t i = 0; i < n; ++i) {
      if (side == 0 ? a_shared[i] : b_shared[i]) continue;
      if (oracle::meet_with_positive_weight(p[0], p[1], side * n + i)) return false;
    }
  }
  return true;
}

void compare(std::uint64_t seed, std::size_t n, int rounds) {
  std::array<int, static_cast<std::size_t>(Kind::count)> total{}, positive{};
  test::for_each_kind(seed, rounds, 1, [&](test::Rng& rng, test::SimplexPair s, Kind kind) {
    const Ids ia{0, 1, 2}, ib = share_vertices(rng, s, n);
    const bool expected = only_in_shared(s, ib, n);
    const auto a = s.a(), b = s.b();
    auto* const test = n == 3 ? exact::meet_only_in_shared : exact::meet_only_in_shared_2d;
    ++total[static_cast<std::size_t>(kind)];
    positive[static_cast<std::size_t>(kind)] += expected;
    return test(a.data(), ia.data(), b.data(), ib.data()) == expected &&
           test(b.data(), ib.data(), a.data(), ia.data()) == expected;
  });
  for (std::size_t k = 0; k < total.size(); ++k) CHECK(positive[k] < total[k]);
}

}  // namespace

TEST_CASE("triangles of a complex intersect only in shared corners and edges") {
  compare(21, 3, 1500);
}
TEST_CASE("segments of a complex intersect only in shared corners") {
  compare(22, 2, 1500);
}

TEST_CASE("a triangle with a repeated vertex has no area") {
  const double o[3] = {0, 0, 0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
  const double* const a[3] = {o, o, x};
  const double* const b[3] = {o, y, z};
  const VertexId ia[3] = {0, 0, 1}, ib[3] = {0, 2, 3};
  CHECK_FALSE(exact::meet_only_in_shared(a, ia, b, ib));
  CHECK_FALSE(exact::meet_only_in_shared(b, ib, a, ia));
}
