#pragma once

#include <string>
#include <vector>

#include "render/camera.hpp"
#include "scenarios/bodies/level_figures.hpp"

namespace lrb::levels {

struct LevelReportOptions {
  std::vector<double> shares;  ///< tolerances of the panels, as shares of the largest side of the body's box
  render::ViewDirection view;
  unsigned threads = 1;
  std::string command;  ///< for the page
};

/// The most panels of a picture, and the least tolerance that its scale has room for.
inline constexpr std::size_t kMostPanels = 24;
inline constexpr double kLeastShare = 1e-6;

/// Throws InputError unless there is something to draw: a body with wrappers, at tolerances that fit a
/// picture.
void check_drawable(const LrbRep& rep, std::vector<double>& shares);

/// Draws the wrappers of a body, how far they are off and how many faces that takes, beside a free
/// simplification where there is one; writes pictures, numbers (levels.json) and the page (index.html) to a
/// folder. Everything is computed before anything is written. Returns notes for people. `options.shares` as
/// check_drawable() leaves them.
std::vector<std::string> write_level_report(const LrbRep& rep, const LevelReportOptions& options,
                                            const std::string& folder);

}  // namespace lrb::levels
