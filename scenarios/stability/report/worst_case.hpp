#pragma once
/// Draws one case that was put to one method: what it should have answered, and what it did.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/query/collide.hpp"
#include "render/overlay.hpp"
#include "render/rasterize.hpp"
#include "scenarios/cases/families.hpp"

namespace lrb::stability {

/// The text above the picture. Counts of pairs are added to the counters.
struct WorstCaseText {
  std::string title;   ///< family and method
  std::string answer;  ///< what became of the case: "refused: ...", "separate, should be touching"
  std::vector<render::OverlayCounter> counters;
};

/// The colours of the marks.
render::Rgba found_colour();   ///< expected, and answered
render::Rgba missed_colour();  ///< expected, not answered
render::Rgba extra_colour();   ///< answered, not expected

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

}  // namespace lrb::stability
