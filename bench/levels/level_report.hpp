#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/levels/level_pictures.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/camera.hpp>

namespace lrb::levels {

/// A simplification that need not enclose the body, as far as CGAL measures it.
struct FreeMesh {
  std::uint32_t faces;
  double to_body, from_body;  ///< largest distance of its points from the body, and the reverse; mesh's unit
};

/// Simplifies the real faces to about these numbers of faces (descending), by the program lrbscope-simplify,
/// which is there where CGAL was when this was built. Returns nothing without it, for a 2D body, or if CGAL
/// does not take the mesh.
std::vector<FreeMesh> simplify_freely(const LrbRep& rep, std::span<const std::uint32_t> face_counts);

/// The number of faces that a body needs for each maximum deviation.
struct LevelCurve {
  double size;                               ///< largest side of the body's box
  std::uint32_t real_faces;                  ///< of the body
  std::vector<bodies::LevelFigures> proved;  ///< a wrapper for each distance, finest first
  std::vector<ShownLevel> shown;             ///< those that were measured, too
  std::vector<FreeMesh> free;                ///< most faces first; empty: there are none to compare with
};

/// Returns wrappers at many tolerances, from half of the least share to the largest, each once.
std::vector<bodies::LevelFigures> many_levels(const LrbRep& rep, std::span<const double> shares,
                                              unsigned threads);

/// Returns faces against deviation, both axes logarithmic.
report::Chart curve_chart(const LevelCurve& curve);

struct LevelReportOptions {
  std::vector<double> shares;  ///< tolerances of the panels, as shares of the largest side of the body's box
  render::ViewDirection view;
  unsigned threads = 1;
  std::string command;  ///< for the page
};

/// The most panels of a picture, and the least tolerance that its scale has room for.
inline constexpr std::size_t kMaxPanels = 24;
inline constexpr double kMinShare = 1e-6;

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
