#pragma once
/// The corners of the intersection of two simplices by brute force: for every face of one and every face of
/// the other (as subsets of corners), the linear system for a common point with barycentric weights in
/// rationals. Where it has one solution and that is positive, the point is a basic point of the intersection.

#include <cstddef>
#include <vector>

#include "bench/stability/rational_oracles.hpp"
#include "tests/support/hull_oracle.hpp"

namespace lrb::oracle {

inline Point<cpp_rational> to_rational_point(const double* p, std::size_t dim) {
  return {p, p + dim};  // exact
}

/// A corner of the intersection, and the faces it was found on, as bit sets of corners.
struct Corner {
  Point<cpp_rational> x;
  unsigned on_a, on_b;
};

inline std::vector<Corner> intersection_corners(const Points<cpp_rational>& a,
                                                const Points<cpp_rational>& b) {
  const std::size_t n = a.size(), dim = a[0].size();
  std::vector<Corner> r;
  for (unsigned fa = 1; fa < (1u << n); ++fa) {
    for (unsigned fb = 1; fb < (1u << n); ++fb) {
      std::vector<std::vector<cpp_rational>> m(dim + 2);
      std::vector<std::size_t> of_a;
      for (std::size_t i = 0; i < n; ++i) {
        if ((fa >> i & 1u) == 0) continue;
        of_a.push_back(i);
        for (std::size_t k = 0; k < dim; ++k) m[k].push_back(a[i][k]);
        m[dim].emplace_back(1);
        m[dim + 1].emplace_back(0);
      }
      for (std::size_t j = 0; j < n; ++j) {
        if ((fb >> j & 1u) == 0) continue;
        for (std::size_t k = 0; k < dim; ++k) m[k].push_back(-b[j][k]);
        m[dim].emplace_back(0);
        m[dim + 1].emplace_back(1);
      }
      for (std::size_t k = 0; k < dim + 2; ++k) m[k].emplace_back(k < dim ? 0 : 1);
      if (m[0].size() - 1 > m.size()) continue;
      const auto x = unique_solution(m);
      if (!x || std::any_of(x->begin(), x->end(), [](const cpp_rational& w) { return w <= 0; })) continue;
      Point<cpp_rational> p(dim);
      for (std::size_t i = 0; i < of_a.size(); ++i) {
        for (std::size_t k = 0; k < dim; ++k) p[k] += (*x)[i] * a[of_a[i]][k];
      }
      r.push_back({p, fa, fb});
    }
  }
  return r;
}

/// True if x is in the convex hull of the chosen corners.
inline bool holds(const Points<cpp_rational>& simplex, unsigned chosen, const Point<cpp_rational>& x) {
  std::vector<std::vector<cpp_rational>> rows(x.size() + 1);
  std::size_t n = 0;
  for (std::size_t i = 0; i < simplex.size(); ++i) {
    if ((chosen >> i & 1u) == 0) continue;
    for (std::size_t k = 0; k < x.size(); ++k) rows[k].push_back(simplex[i][k]);
    rows[x.size()].emplace_back(1);
    ++n;
  }
  for (std::size_t k = 0; k < x.size(); ++k) rows[k].push_back(x[k]);
  rows[x.size()].emplace_back(1);
  return IntegerSimplex<cpp_rational>(rows, n).feasible();
}

}  // namespace lrb::oracle
