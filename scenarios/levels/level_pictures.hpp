#pragma once

#include <span>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "render/camera.hpp"
#include "render/image.hpp"
#include "scenarios/bodies/level_figures.hpp"

namespace lrb::levels {

/// The body in the pictures, and how it is seen.
struct ShownBody {
  const LrbRep* rep;
  double size;  ///< largest side of the body's box, which distances are shares of
  render::ViewDirection view;
  unsigned threads;
};

/// A panel's wrapper.
struct ShownLevel {
  bodies::LevelFigures figures;
  double sampled = 0;  ///< the largest distance found on its lids; mesh's unit
};

/// Draws the body and its wrappers side by side, each with its faces and what it is proved to be off.
render::Image draw_wrappers(const ShownBody& shown, std::span<const ShownLevel> levels);

/// Draws how far the lids of each wrapper are from the body, on one scale for all, and notes the largest
/// distance of each level.
render::Image draw_distances(const ShownBody& shown, std::span<ShownLevel> levels);

/// Returns what stands below a panel.
std::string caption_of(const bodies::LevelFigures& level, double size);

/// Returns a positive number with three significant digits, rounded upward: a bound stays one.
std::string upward_text(double value);

}  // namespace lrb::levels
