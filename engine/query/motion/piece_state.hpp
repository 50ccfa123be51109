#pragma once
/// A piece of a motion at one t, in doubles.

#include "engine/query/motion/motion.hpp"

namespace lrb {

struct PieceState {
  Pose pose;               ///< of the body: Motion::at()
  Eigen::Matrix3d turned;  ///< r exp(s [turn])
};

/// Returns a piece at a t from its begin to its end.
PieceState state_of(const Motion::Piece& piece, double t);

}  // namespace lrb
