#pragma once
/// Draws the expected and the actual answer of a method to one case.

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
  std::string answer;  ///< the outcome: "refused: ...", "separate, should be touching"
  std::vector<render::OverlayCounter> counters;
};

/// Draws both bodies translucent, and the simplices of all expected and answered pairs coloured by their mark
/// (of several marks: missed before extra before found). A close-up of the wrong pairs is added if they are
/// small compared to the bodies, or a wrong pair without the rest of the bodies if marks are all over them.
/// `answered`: nullopt if the method returned no list; all expected pairs are then drawn as found. Pairs are
/// of real simplices, in any order; 3D or 2D. Throws InputError if world coordinates are not finite or a pair
/// refers to no real simplex.
render::Image worst_case_picture(const cases::Case& c, std::span<const SimplexPair> expected,
                                 const std::optional<std::vector<SimplexPair>>& answered,
                                 const WorstCaseText& text, render::Rasterizer& rasterizer);

/// Draws the same picture into a PNG file.
void draw_worst_case(const cases::Case& c, std::span<const SimplexPair> expected,
                     const std::optional<std::vector<SimplexPair>>& answered, const WorstCaseText& text,
                     const std::string& path, render::Rasterizer& rasterizer);

// Drawing all worst cases of a grid.

/// The expected and the actual answer to a record's case. `answered`: nullopt if there was no answer or it
/// contains no list of pairs.
struct AnsweredPairs {
  std::vector<SimplexPair> expected;
  std::optional<std::vector<SimplexPair>> answered;
};

/// Draws the worst case of every cell that has one into folder/worst/FAMILY-METHOD.png, and removes the
/// pictures of earlier runs. `ask` runs a case again; `progress` is called before each case. Cases that
/// cannot be drawn (coordinates that are not finite, families that are not in all_families()) get no picture.
/// Returns (|cells|) paths relative to the folder, for ReportOptions::pictures; empty for cells without a
/// picture. Throws EnvironmentError if drawing or writing fails.
std::vector<std::string> draw_worst_cases(
    const Grid& grid, const std::string& folder, const std::function<AnsweredPairs(const Record&)>& ask,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace lrb::stability
