#pragma once

#include <span>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/levels/free_simplification.hpp"
#include "scenarios/levels/level_pictures.hpp"
#include "scenarios/report/charts/gnuplot.hpp"
#include "scenarios/report/page/page.hpp"

namespace lrb::levels {

/// How many faces it takes to be off by no more than a distance.
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

/// Returns the curve for print, both axes logarithmic.
report::Gnuplot curve_for_print(const LevelCurve& curve);
/// Returns the curve for the page.
report::PageChart curve_for_page(const LevelCurve& curve);

}  // namespace lrb::levels
