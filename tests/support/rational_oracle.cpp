#include "tests/support/rational_oracle.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "tests/support/hull_oracle.hpp"

namespace lrb::oracle {
namespace {

/// Small integers as they are, when every coordinate is one.
bool are_small_integers(const std::vector<std::vector<const double*>>& sets, std::size_t dim) {
  for (const auto& set : sets) {
    for (const double* p : set) {
      for (std::size_t k = 0; k < dim; ++k) {
        if (!(std::fabs(p[k]) <= 16) || p[k] != std::floor(p[k])) return false;
      }
    }
  }
  return true;
}

std::vector<Points<std::int64_t>> to_small_integers(const std::vector<std::vector<const double*>>& sets,
                                                    std::size_t dim) {
  std::vector<Points<std::int64_t>> r;
  for (const auto& set : sets) {
    r.emplace_back();
    for (const double* p : set) {
      Point<std::int64_t> x(dim);
      for (std::size_t k = 0; k < dim; ++k) x[k] = static_cast<std::int64_t>(p[k]);
      r.back().push_back(std::move(x));
    }
  }
  return r;
}

}  // namespace

int meet_of_simplices(const double* const* a, const double* const* b, std::size_t n) {
  const std::vector<std::vector<const double*>> sets{{a, a + n}, {b, b + n}};
  const int dim = static_cast<int>(n) - 1;
  if (are_small_integers(sets, n)) {
    const auto p = to_small_integers(sets, n);
    return meet_of(p[0], p[1], dim);
  }
  const auto p = to_integers(sets, n);
  return meet_of(p[0], p[1], dim);
}

int orientation(const std::vector<const double*>& points) {
  const std::size_t n = points.size() - 1;
  const auto p = to_integers({points}, n)[0];
  std::vector<std::vector<cpp_rational>> m(n, std::vector<cpp_rational>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) m[i][k] = cpp_rational(p[i + 1][k] - p[0][k]);
  }
  int sign = 1;
  for (std::size_t c = 0; c < n; ++c) {  // Gauss
    std::size_t r = c;
    while (r < n && m[r][c] == 0) ++r;
    if (r == n) return 0;
    if (r != c) {
      std::swap(m[r], m[c]);
      sign = -sign;
    }
    if (m[c][c] < 0) sign = -sign;
    for (std::size_t i = c + 1; i < n; ++i) {
      const cpp_rational f = m[i][c] / m[c][c];
      for (std::size_t k = c; k < n; ++k) m[i][k] -= f * m[c][k];
    }
  }
  return sign;
}

int affine_dimension_of(const std::vector<const double*>& points, std::size_t dim) {
  return affine_dimension(to_integers({points}, dim)[0]);
}

}  // namespace lrb::oracle
