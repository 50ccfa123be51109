#pragma once
/// Draws the expected and the actual answer of a method to a case: two posed bodies, and a mark on each of
/// their simplices.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::stability {

using Pairs = std::vector<SimplexPair>;

/// The mark of a simplex. Of several marks the last one in this order is shown.
enum class Mark : std::uint8_t { none, found, extra, missed };
render::Rgba colour_of(Mark m);

/// The comparison of expected and answered pairs; each list ascending.
struct Verdict {
  Pairs found, missed, extra;
  bool listed = false;  ///< the method returned a list; otherwise all expected pairs count as found

  /// The most severe non-empty kind, and its pairs.
  Mark mark() const { return !missed.empty() ? Mark::missed : !extra.empty() ? Mark::extra : Mark::found; }
  const Pairs& worst() const { return !missed.empty() ? missed : !extra.empty() ? extra : found; }
};
Verdict compare(std::span<const SimplexPair> expected, const std::optional<Pairs>& answered);

/// The text above the picture. Counts of pairs are added to the counters.
struct WorstCaseText {
  std::string title;   ///< family and method
  std::string answer;  ///< the outcome: "refused: ...", "separate, should be touching"
  std::vector<render::OverlayCounter> counters;
};

/// Draws both bodies translucent, and the simplices of all expected and answered pairs coloured by their mark
/// (of several marks: missed before extra before found). A close-up of the wrong pairs is added if they are
/// small compared to the bodies.
/// `answered`: nullopt if the method returned no list; all expected pairs are then drawn as found. Pairs are
/// of real simplices, in any order; 3D or 2D. Throws InputError if a pair refers to no
/// real simplex, or a coordinate is not finite.
render::Image worst_case_picture(const cases::Case& c, std::span<const SimplexPair> expected,
                                 const std::optional<std::vector<SimplexPair>>& answered,
                                 const WorstCaseText& text, render::Rasterizer& rasterizer);

/// Draws the worst case of every cell that has one into folder/worst/FAMILY-METHOD.png, and removes the
/// pictures of earlier runs. `ask` runs a case again; `progress` is called before each case. Cases that
/// cannot be drawn (coordinates that are not finite, families that are not in all_families()) get no picture.
/// Returns (|cells|) paths relative to the folder, for ReportOptions::pictures; empty for cells without a
/// picture. Throws EnvironmentError if drawing or writing fails.
std::vector<std::string> draw_worst_cases(
    const Grid& grid, const std::string& folder, const std::function<Replay(const Record&)>& ask,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace lrb::stability
