#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::levels {

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
