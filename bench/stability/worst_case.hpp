#pragma once
/// Draws one case that was put to one method: what it should have answered, and what it did.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/stability/outcome_grid.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::stability {

/// The text above the picture. Counts of pairs are added to the counters.
struct WorstCaseText {
  std::string title;   ///< family and method
  std::string answer;  ///< what became of the case: "refused: ...", "separate, should be touching"
  std::vector<render::OverlayCounter> counters;
};

/// Draws both bodies translucent, and the simplices of all expected and answered pairs in the colours of what
/// became of them (with several marks: missed before extra before found). Beside it is a close-up of where
/// the answer is wrong, if that is small against the bodies. `answered` is nothing if the method gave no
/// list; everything expected is then drawn as such. Pairs are of real simplices, in any order; 3D or 2D.
/// Throws InputError if the world coordinates are not finite or a pair names no real simplex.
render::Image worst_case_picture(const cases::Case& c, std::span<const SimplexPair> expected,
                                 const std::optional<std::vector<SimplexPair>>& answered,
                                 const WorstCaseText& text, render::Rasterizer& rasterizer);

/// Draws the same into a PNG file.
void draw_worst_case(const cases::Case& c, std::span<const SimplexPair> expected,
                     const std::optional<std::vector<SimplexPair>>& answered, const WorstCaseText& text,
                     const std::string& path, render::Rasterizer& rasterizer);

// Draws all worst cases of a grid.

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
