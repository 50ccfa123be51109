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
  const auto from_first = [&](std::size_t i, std::size_t k) { return cpp_int(p[i][k] - p[0][k]); };
  const auto minor = [&](std::size_t i, std::size_t j) {
    return cpp_int(from_first(i, 0) * from_first(j, 1) - from_first(i, 1) * from_first(j, 0));
  };
  if (n == 2) return minor(1, 2).sign();
  return cpp_int(minor(1, 2) * from_first(3, 2) + minor(2, 3) * from_first(1, 2) +
                 minor(3, 1) * from_first(2, 2))
      .sign();
}

int affine_dimension_of(const std::vector<const double*>& points, std::size_t dim) {
  return affine_dimension(to_integers({points}, dim)[0]);
}

}  // namespace lrb::oracle
