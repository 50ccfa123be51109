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

/// A simplification that need not enclose the body, with its distances as measured by CGAL.
struct FreeMesh {
  std::uint32_t faces;
  double to_body, from_body;  ///< one-sided Hausdorff distances, sampled; mesh's unit
};

/// Simplifies the real faces to about these numbers of faces (descending) with the program lrbscope-simplify,
/// which exists if CGAL was found at build time. Returns an empty list without it, for a 2D body, or if CGAL
/// rejects the mesh.
std::vector<FreeMesh> simplify_freely(const LrbRep& rep, std::span<const std::uint32_t> face_counts);

/// The number of faces that a body needs for each maximum deviation.
struct LevelCurve {
  double size;                               ///< largest side of the body's box
  std::uint32_t real_faces;                  ///< of the body
  std::vector<bodies::LevelFigures> proved;  ///< one wrapper per tolerance, finest first
  std::vector<ShownLevel> shown;             ///< those that were also sampled
  std::vector<FreeMesh> free;                ///< most faces first; may be empty
};

/// Returns wrappers at many tolerances, from half of the smallest share to the largest, without duplicates.
std::vector<bodies::LevelFigures> many_levels(const LrbRep& rep, std::span<const double> shares,
                                              unsigned threads);

/// Returns the chart of faces over deviation, both axes logarithmic.
report::Chart curve_chart(const LevelCurve& curve);

struct LevelReportOptions {
  std::vector<double> shares;  ///< tolerances of the panels, as fractions of the box's largest side
  render::ViewDirection view;
  unsigned threads = 1;
  std::string command;  ///< for the page
};

/// Maximum number of panels, and minimum tolerance that the scale can show.
inline constexpr std::size_t kMaxPanels = 24;
inline constexpr double kMinShare = 1e-6;

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
