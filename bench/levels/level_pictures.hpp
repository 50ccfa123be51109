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

/// The body in the pictures, and its view.
struct ShownBody {
  const LrbRep* rep;
  double size;  ///< largest side of the body's box; distances are fractions of it
  render::ViewDirection view;
  unsigned threads;
};

/// The wrapper of a panel.
struct ShownLevel {
  bodies::LevelFigures figures;
  double sampled = 0;  ///< largest sampled distance of its lids; mesh's unit
};

/// Draws the body and its wrappers side by side, each with its number of faces and its proven maximum
/// deviation.
render::Image draw_wrappers(const ShownBody& shown, std::span<const ShownLevel> levels);

/// Draws the distance of each wrapper's lids from the body, on a common scale, and stores the largest
/// distance found for each level in `levels`.
render::Image draw_distances(const ShownBody& shown, std::span<ShownLevel> levels);

/// Returns the caption of a panel.
std::string caption_of(const bodies::LevelFigures& level, double size);

/// Returns a positive number with three significant digits, rounded up, so that it remains an upper bound.
std::string upward_text(double value);

/// A piece of a lid, small enough for one colour.
struct LidPiece {
  /// Mesh's frame; 2D: the third is not used.
  std::array<Eigen::Vector3d, 3> x{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double off = 0;  ///< distance of its centroid from the nearest real face; mesh's unit
};

struct MeasuredLids {
  std::vector<LidPiece> pieces;
  /// The largest distance at the pieces' centroids and the lids' corners: at most the true maximum, up to
  /// rounding.
  double largest = 0;
};

/// Splits lids into pieces with edges of at most `longest` (mesh's unit), and measures each. The result does
/// not depend on the number of threads.
MeasuredLids measure_lids(const LrbRep& rep, std::span<const FaceId> lids, double longest, unsigned threads);

}  // namespace lrb::levels
