#pragma once
/// An oracle for engine/exact that shares neither code nor method with it: simplices meet if a linear program
/// over their barycentric coordinates is feasible, and their relative interiors meet if it stays so with all
/// coordinates positive. Solved by the simplex method on integers (Edmonds' integer pivoting, Bland's rule),
/// so that no answer depends on rounding. Doubles become integers by an exact power of two per axis.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace lrb::oracle {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

/// A point with coordinates of type T: std::int64_t for small grids, cpp_int for all else.
template <class T>
using Point = std::vector<T>;
template <class T>
using Points = std::vector<Point<T>>;

/// maximise c.x subject to A x = b, x >= 0, b >= 0: every tableau entry is an integer over one common
/// denominator.
template <class T>
class IntegerSimplex {
 public:
  /// rows: equations, each with `variables` coefficients and the right side last.
  IntegerSimplex(std::vector<std::vector<T>> rows, std::size_t variables)
      : rows_(std::move(rows)), variables_(variables), basis_(rows_.size()) {
    for (auto& row : rows_) {
      if (row.back() < 0) {
        for (auto& x : row) x = -x;
      }
    }
    for (std::size_t i = 0; i < rows_.size(); ++i)
      basis_[i] = variables_ + i;  // artificial, columns not kept
  }

  bool feasible() {
    // Minimise the sum of the artificial variables: its reduced costs are the column sums.
    objective_.assign(variables_ + 1, T(0));
    for (const auto& row : rows_) {
      for (std::size_t j = 0; j <= variables_; ++j) objective_[j] += row[j];
    }
    run();
    if (objective_[variables_] != 0) return false;
    drive_out_artificials();
    return true;
  }

  /// After feasible(): is the maximum of variable k positive?
  bool can_be_positive(std::size_t k) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (basis_[i] == k && rows_[i][variables_] != 0) return true;
    }
    objective_.assign(variables_ + 1, T(0));
    objective_[k] = denominator_;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (basis_[i] != k) continue;
      for (std::size_t j = 0; j <= variables_; ++j) objective_[j] -= rows_[i][j];
    }
    run();
    return objective_[variables_] != 0;
  }

 private:
  void pivot(std::size_t r, std::size_t c) {
    const T p = rows_[r][c];
    const auto eliminate = [&](std::vector<T>& row) {
      const T f = row[c];
      for (std::size_t j = 0; j <= variables_; ++j) row[j] = T(row[j] * p - f * rows_[r][j]) / denominator_;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (i != r) eliminate(rows_[i]);
    }
    eliminate(objective_);
    denominator_ = p;
    basis_[r] = c;
  }

  void run() {
    for (;;) {
      std::size_t c = 0;
      while (c < variables_ && (is_basic(c) || objective_[c] <= 0)) ++c;
      if (c == variables_) return;
      std::size_t r = rows_.size();
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (rows_[i][c] <= 0) continue;
        if (r == rows_.size()) {
          r = i;
          continue;
        }
        const T left = rows_[i][variables_] * rows_[r][c], right = rows_[r][variables_] * rows_[i][c];
        if (left < right || (left == right && basis_[i] < basis_[r])) r = i;
      }
      if (r == rows_.size()) throw std::logic_error("unbounded: barycentric coordinates cannot be");
      pivot(r, c);
    }
  }

  bool is_basic(std::size_t c) const { return std::find(basis_.begin(), basis_.end(), c) != basis_.end(); }

  void drive_out_artificials() {
    for (std::size_t i = 0; i < rows_.size();) {
      if (basis_[i] < variables_) {
        ++i;
        continue;
      }
      std::size_t c = 0;
      while (c < variables_ && (is_basic(c) || rows_[i][c] == 0)) ++c;
      if (c == variables_) {  // a redundant equation
        rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(i));
        basis_.erase(basis_.begin() + static_cast<std::ptrdiff_t>(i));
        continue;
      }
      if (rows_[i][c] < 0) {
        for (auto& x : rows_[i]) x = -x;  // its right side is 0
      }
      pivot(i, c);
      ++i;
    }
  }

  std::vector<std::vector<T>> rows_;
  std::size_t variables_;
  std::vector<std::size_t> basis_;
  std::vector<T> objective_;
  T denominator_ = 1;
};

/// Dimension of the affine hull, by fraction-free elimination.
template <class T>
int affine_dimension(const Points<T>& points) {
  std::vector<Point<T>> m;
  for (std::size_t i = 1; i < points.size(); ++i) {
    m.push_back(points[i]);
    for (std::size_t k = 0; k < points[i].size(); ++k) m.back()[k] -= points[0][k];
  }
  std::size_t rank = 0;
  for (std::size_t c = 0; c < points[0].size() && rank < m.size(); ++c) {
    std::size_t r = rank;
    while (r < m.size() && m[r][c] == 0) ++r;
    if (r == m.size()) continue;
    std::swap(m[r], m[rank]);
    for (std::size_t i = rank + 1; i < m.size(); ++i) {
      const T f = m[i][c];
      for (std::size_t k = 0; k < m[i].size(); ++k) m[i][k] = m[i][k] * m[rank][c] - f * m[rank][k];
    }
    ++rank;
  }
  return static_cast<int>(rank);
}

struct HullMeet {
  bool share_a_point = false;
  bool interiors_share_a_point = false;
};

/// Equations for a common point of two hulls. Variables: the weights of a's points, then of b's; and if
/// `with_margin`, a last variable t that is taken off each weight first, so that all weights are at least t.
template <class T>
std::vector<std::vector<T>> common_point_equations(const Points<T>& a, const Points<T>& b, bool with_margin) {
  const std::size_t n = a.size() + b.size() + (with_margin ? 1 : 0), dim = a[0].size();
  std::vector<std::vector<T>> rows(dim + 2, std::vector<T>(n + 1, T(0)));
  for (std::size_t k = 0; k < dim; ++k) {
    for (std::size_t i = 0; i < a.size(); ++i) rows[k][i] = a[i][k];
    for (std::size_t j = 0; j < b.size(); ++j) rows[k][a.size() + j] = -b[j][k];
  }
  for (std::size_t i = 0; i < a.size(); ++i) rows[dim][i] = 1;
  for (std::size_t j = 0; j < b.size(); ++j) rows[dim + 1][a.size() + j] = 1;
  if (with_margin) {
    for (auto& row : rows) {
      for (std::size_t j = 0; j + 1 < n; ++j) row[n - 1] += row[j];
    }
  }
  rows[dim][n] = rows[dim + 1][n] = 1;
  return rows;
}

/// The convex hulls of two sets of points, any dimension.
template <class T>
HullMeet hulls_meet(const Points<T>& a, const Points<T>& b) {
  const std::size_t n = a.size() + b.size() + 1;
  IntegerSimplex<T> lp(common_point_equations(a, b, true), n);
  HullMeet r;
  r.share_a_point = lp.feasible();
  if (r.share_a_point) r.interiors_share_a_point = lp.can_be_positive(n - 1);
  return r;
}

/// True if the hulls have a common point in which the point with number k (b's follow a's) can have weight.
template <class T>
bool meet_with_positive_weight(const Points<T>& a, const Points<T>& b, std::size_t k) {
  IntegerSimplex<T> lp(common_point_equations(a, b, false), a.size() + b.size());
  return lp.feasible() && lp.can_be_positive(k);
}

/// Finite doubles as integers: each axis multiplied by a power of two of its own.
inline std::vector<Points<cpp_int>> to_integers(const std::vector<std::vector<const double*>>& sets,
                                                std::size_t dim) {
  std::vector<Points<cpp_int>> r;
  for (const auto& set : sets) r.emplace_back(set.size(), Point<cpp_int>(dim));
  for (std::size_t k = 0; k < dim; ++k) {
    int least = 2000;
    for (const auto& set : sets) {
      for (const double* p : set) {
        if (p[k] != 0) least = std::min(least, std::ilogb(p[k]) - 52);
      }
    }
    for (std::size_t s = 0; s < sets.size(); ++s) {
      for (std::size_t i = 0; i < sets[s].size(); ++i) {
        const double x = sets[s][i][k];
        if (x == 0) continue;
        const int e = std::ilogb(x) - 52;
        const double mantissa = std::scalbn(x, -e);  // an integer below 2^53
        r[s][i][k] = static_cast<std::int64_t>(mantissa);
        r[s][i][k] <<= e - least;
      }
    }
  }
  return r;
}

/// 0 disjoint, 1 touch, 2 cross: cross if relative interiors share a point, the hulls have full dimension
/// (`simplex_dim`) each and do not lie in one plane (line) of that dimension.
template <class T>
int meet_of(const Points<T>& a, const Points<T>& b, int simplex_dim) {
  const HullMeet m = hulls_meet(a, b);
  if (!m.share_a_point) return 0;
  if (!m.interiors_share_a_point) return 1;
  Points<T> both = a;
  both.insert(both.end(), b.begin(), b.end());
  const bool full = affine_dimension(a) == simplex_dim && affine_dimension(b) == simplex_dim;
  return full && affine_dimension(both) > simplex_dim ? 2 : 1;
}

}  // namespace lrb::oracle
