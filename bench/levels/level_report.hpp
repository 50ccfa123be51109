#pragma once

#include <string>
#include <vector>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/camera.hpp>

namespace lrb::levels {

struct LevelReportOptions {
  std::vector<double> shares;  ///< tolerances of the panels, as fractions of the box's largest side
  render::ViewDirection view;
  unsigned threads = 1;
  std::string command;  ///< for the page
};

/// Throws InputError unless the body has wrappers and the tolerances fit a picture. Sorts `shares` and
/// removes duplicates.
void check_drawable(const LrbRep& rep, std::vector<double>& shares);

/// Draws the wrappers of a body, their deviations and face counts, and a free simplification for comparison
/// if there is one. Writes pictures, numbers (levels.json) and the page (index.html) to a folder. Everything
/// is computed before anything is written. Returns notes for the user. `options.shares` must be as left by
/// check_drawable().
std::vector<std::string> write_level_report(const LrbRep& rep, const LevelReportOptions& options,
                                            const std::string& folder);

}  // namespace lrb::levels
