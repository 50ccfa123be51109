#pragma once
/// The colours of pages, light and dark. Pages get them as CSS variables (root_css()); charts for print use
/// the light ones. Colours shared with pictures come from the palette.

#include <array>
#include <span>
#include <string>
#include <string_view>

#include <lrbscope/render/style.hpp>

namespace lrb::render {

/// A CSS variable. Pages of a dark system theme use `dark`.
struct PageColour {
  std::string_view name;  ///< without the leading dashes
  Rgba light, dark;
};

namespace page {

// Backgrounds, texts and lines.
inline constexpr PageColour kPaper{"paper", {251, 251, 250}, {21, 23, 26}};
inline constexpr PageColour kCard{"card", kWhite, {28, 31, 35}};
inline constexpr PageColour kInk{"ink", {29, 31, 34}, {230, 231, 232}};
inline constexpr PageColour kSoft{"soft", {98, 103, 110}, {154, 160, 168}};
inline constexpr PageColour kLine{"line", {226, 227, 228}, {46, 50, 56}};
inline constexpr PageColour kAccent{"accent", palette::kBlue, {108, 184, 234}};
inline constexpr PageColour kGrid{"grid", {236, 236, 234}, {42, 46, 51}};
inline constexpr PageColour kBad{"bad", {179, 38, 30}, {255, 138, 128}};
inline constexpr PageColour kGood{"good", {0, 112, 79}, {47, 193, 152}};

/// Series of charts, by number. The yellow is darker than the palette's, so that lines are visible on white.
inline constexpr std::array<PageColour, 7> kSeries = {{{"s0", palette::kBlue, palette::kSkyBlue},
                                                       {"s1", palette::kVermillion, {240, 128, 60}},
                                                       {"s2", palette::kGreen, {47, 193, 152}},
                                                       {"s3", palette::kPurple, {221, 149, 189}},
                                                       {"s4", {181, 137, 0}, {230, 194, 41}},
                                                       {"s5", palette::kSkyBlue, {143, 208, 245}},
                                                       {"s6", {107, 107, 107}, {169, 169, 169}}}};

// Grids of outcomes.
inline constexpr PageColour kWrong{"wrong", palette::kVermillion, {255, 154, 82}};
inline constexpr PageColour kCrashed{"crashed", {20, 22, 26}, kWhite};
inline constexpr PageColour kTimedOut{"timed", {160, 69, 138}, {231, 155, 211}};
inline constexpr PageColour kRejected{"refused", {154, 160, 166}, {132, 139, 148}};
inline constexpr PageColour kOnlyRejected{"hatch", {228, 230, 232}, {51, 56, 63}};
/// Backgrounds of cells: pale blue for no failures, then increasingly orange.
inline constexpr std::array<PageColour, 5> kLevels = {{{"level-0", {226, 238, 246}, {27, 48, 64}},
                                                       {"level-1", {253, 241, 220}, {58, 49, 34}},
                                                       {"level-2", {251, 220, 174}, {87, 58, 28}},
                                                       {"level-3", {245, 180, 107}, {124, 72, 23}},
                                                       {"level-4", {232, 138, 60}, {168, 90, 18}}}};
/// Text on the last of them.
inline constexpr PageColour kOnLevel4{"on-4", kInk.light, kWhite};

}  // namespace page

/// Returns "#rrggbb", without the alpha.
std::string css(Rgba c);

/// Returns the CSS rules that define the colours as variables of a page's root, for both themes.
std::string root_css(std::span<const PageColour> colours);

/// The variables of every page, and of grids of outcomes.
std::string page_root_css();
std::string grid_root_css();

}  // namespace lrb::render
