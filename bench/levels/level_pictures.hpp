#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "scenarios/bodies/body_figures.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/image.hpp>

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

/// A piece of a lid, small enough for one colour.
struct LidPiece {
  /// Mesh's frame; 2D: the third is not used.
  std::array<Eigen::Vector3d, 3> x{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double off = 0;  ///< distance of its middle from the nearest real face; mesh's unit
};

struct MeasuredLids {
  std::vector<LidPiece> pieces;
  /// The largest distance at the pieces' middles and the lids' corners: never more than the true largest one
  /// but for rounding.
  double largest = 0;
};

/// Cuts lids into pieces with edges no longer than `longest` (mesh's unit), and measures each. The same on
/// any number of threads.
MeasuredLids measure_lids(const LrbRep& rep, std::span<const FaceId> lids, double longest, unsigned threads);

}  // namespace lrb::levels
