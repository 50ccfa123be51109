#pragma once
/// Draws all worst cases of a grid.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/query/collide.hpp"
#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

/// What should have been answered to a record's case, and what was: nothing, if there was no answer or one
/// without a list of pairs.
struct AnsweredPairs {
  std::vector<SimplexPair> expected;
  std::optional<std::vector<SimplexPair>> answered;
};

/// Draws the worst case of every cell that has one into folder/worst/FAMILY-METHOD.png, and removes pictures
/// of an earlier run. `ask` puts a case to its method again; `progress` is called before each. Cases that
/// cannot be drawn (coordinates that are not finite, families that are not in all_families()) get no picture.
/// Returns (|cells|) paths relative to the folder, for ReportOptions::pictures; empty where there is no
/// picture. Throws EnvironmentError if drawing or writing fails.
std::vector<std::string> draw_worst_cases(
    const Grid& grid, const std::string& folder, const std::function<AnsweredPairs(const Record&)>& ask,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace lrb::stability
