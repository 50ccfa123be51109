#pragma once

#include <algorithm>
#include <array>

#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

/// A cell in few numbers, the same for page and print.
struct CellSummary {
  std::uint64_t cases = 0, wrong = 0, refused = 0, crashed = 0, timed_out = 0;
  int first_failing = -1;  ///< the lowest dial setting with a failure; -1: none

  /// Returns the number of failures. A refusal is none, because it gives no wrong answer; it has a mark of
  /// its own.
  std::uint64_t failures() const { return wrong + crashed + timed_out; }
  std::uint64_t answered() const { return cases - refused; }
  double failure_share() const {
    return answered() == 0 ? 0 : static_cast<double>(failures()) / static_cast<double>(answered());
  }
  /// Returns how bad it is, from 0 (no failure) to 4; see kLevelNames.
  int level() const {
    const double share = failure_share();
    return share <= 0 ? 0 : share < 0.01 ? 1 : share < 0.1 ? 2 : share < 0.5 ? 3 : 4;
  }
  bool only_refused() const { return failures() == 0 && refused > 0; }
};

inline constexpr std::array<const char*, 5> kLevelNames = {"none fails", "under 1 %", "under 10 %",
                                                           "under half", "half or more"};

inline CellSummary summarise(const Cell& cell) {
  CellSummary s;
  for (int d = 0; d < kDialSettings; ++d) {
    const auto i = static_cast<std::size_t>(d);
    s.cases += cell.cases[i];
    s.wrong += cell.wrong[i];
    s.refused += cell.refused[i];
    s.crashed += cell.crashed[i];
    s.timed_out += cell.timed_out[i];
    if (s.first_failing < 0 && cell.wrong[i] + cell.crashed[i] + cell.timed_out[i] > 0) s.first_failing = d;
  }
  return s;
}

/// Returns all families put to one method, as one cell.
inline Cell sum_of_column(const Grid& grid, std::size_t method) {
  Cell sum;
  for (std::size_t f = 0; f < grid.families.size(); ++f) {
    const Cell& c = grid.at(f, method);
    for (std::size_t i = 0; i < kDialSettings; ++i) {
      sum.cases[i] += c.cases[i];
      sum.wrong[i] += c.wrong[i];
      sum.refused[i] += c.refused[i];
      sum.crashed[i] += c.crashed[i];
      sum.timed_out[i] += c.timed_out[i];
    }
  }
  return sum;
}

}  // namespace lrb::stability
