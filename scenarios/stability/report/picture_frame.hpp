#pragma once
/// Brings cases of any size and place to where they can be drawn, with bodies of 1e-120 as well as at 1e16.

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/cases/families.hpp"

namespace lrb::stability {

/// A convex piece of a face in a picture's frame; `edges[i]` tells whether the side from corner i to the next
/// one belongs to the face's outline. With two corners it is a segment of a 2D body.
struct Piece {
  std::vector<Eigen::Vector3d> corners;
  std::vector<bool> edges;
};

/// The posed real simplices of one body, in world coordinates.
class PosedBody {
 public:
  /// Throws InputError that names the first vertex whose world coordinates are not finite.
  PosedBody(const LrbRep& rep, const Pose& pose);

  std::uint32_t size() const { return rep_->real_simplex_count(); }
  Piece simplex(SimplexId s) const;
  Eigen::AlignedBox3d box(SimplexId s) const;
  const Eigen::AlignedBox3d& box() const { return box_; }
  int dim() const { return rep_->dim(); }

 private:
  const LrbRep* rep_;
  std::vector<Eigen::Vector3d> x_;  ///< (|V|); vertices that only pseudo faces use may not be finite
  Eigen::AlignedBox3d box_;
};

/// Returns the length of a box's diagonal, whose square may not fit into a double.
double diagonal(const Eigen::AlignedBox3d& box);

/// Maps a box of the world to the cube [-1, 1]^3: its middle to the origin, its longest side to 2.
class PictureFrame {
 public:
  explicit PictureFrame(const Eigen::AlignedBox3d& box);

  /// Maps a point. Takes differences first, which is exact near the middle, however far that is from the
  /// world's origin.
  Eigen::Vector3d operator()(const Eigen::Vector3d& world) const {
    return (world * before_ - middle_) / radius_;
  }
  /// Returns what of a piece lies in [-reach, reach]^3; no corners if nothing does. A piece may be 1e60 times
  /// as large as the cube, so it is cut with 100 digits.
  Piece cut(const Piece& world, double reach) const;

 private:
  Eigen::Vector3d middle_;
  double before_ = 1;  ///< keeps differences of the largest doubles finite
  double radius_ = 1;
};

}  // namespace lrb::stability
