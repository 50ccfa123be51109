#pragma once
/// What a worst case's picture shows: two posed bodies, and a mark on each of their simplices.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "bench/cases/families.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/render/draw_list.hpp>

namespace lrb::stability {

// Brings cases of any size and place to where they can be drawn, with bodies of 1e-120 as well as at 1e16.

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

using Pairs = std::vector<SimplexPair>;

/// What became of a simplex. A simplex with several marks shows the last of these.
enum class Mark : std::uint8_t { none, found, extra, missed };
render::Rgba colour_of(Mark m);

/// RightAnswer and answered pairs, told apart; each list ascending.
struct Verdict {
  Pairs found, missed, extra;
  bool listed = false;  ///< the method gave a list; else everything expected counts as found

  /// Returns the pairs to look at.
  const Pairs& worst() const { return !missed.empty() ? missed : !extra.empty() ? extra : found; }
};
Verdict compare(std::span<const SimplexPair> expected, const std::optional<Pairs>& answered);

/// The two bodies in world coordinates, and the mark of every real simplex.
struct CasePicture {
  std::array<PosedBody, 2> bodies;
  std::array<std::vector<Mark>, 2> marks;
  Eigen::AlignedBox3d box;

  /// Throws InputError if a pair names no real simplex, or the bodies cannot be drawn.
  CasePicture(const cases::Case& c, const Verdict& verdict);

  bool flat() const { return bodies[0].dim() == 2; }
  bool shows(Mark m) const;
  /// Returns true if marks all over the bodies would hide one another.
  bool crowded() const;

 private:
  void mark(const Pairs& pairs, Mark m);
};

/// Makes a draw list: bodies translucent, marks in their colours. What lies beyond [-reach, reach]^3 of the
/// frame is cut off.
render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame, double reach);

/// Adds a dot for each mark smaller than `least`, in the frame's unit.
void add_dots(render::DrawList& list, const CasePicture& s, const PictureFrame& frame, double reach,
              double least);

}  // namespace lrb::stability
