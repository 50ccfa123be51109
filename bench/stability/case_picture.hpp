#pragma once
/// The content of a worst case's picture: two posed bodies, and a mark on each of their simplices.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "bench/cases/families.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/render/draw_list.hpp>

namespace lrb::stability {

// Scales and translates cases of any size and position for drawing, from bodies of size 1e-120 to bodies at
// 1e16.

/// A convex piece of a face in a picture's frame. `edges[i]`: the side from corner i to the next one belongs
/// to the face's outline. With two corners it is a segment of a 2D body.
struct Piece {
  std::vector<Eigen::Vector3d> corners;
  std::vector<bool> edges;
};

/// The posed real simplices of one body, in world coordinates.
class PosedBody {
 public:
  /// Throws InputError, which names the first vertex whose world coordinates are not finite, if there is one.
  PosedBody(const LrbRep& rep, const Pose& pose);

  std::uint32_t size() const { return rep_->real_simplex_count(); }
  Piece simplex(SimplexId s) const;
  Eigen::AlignedBox3d box(SimplexId s) const;
  const Eigen::AlignedBox3d& box() const { return box_; }
  int dim() const { return rep_->dim(); }

 private:
  const LrbRep* rep_;
  std::vector<Eigen::Vector3d> x_;  ///< (|V|); vertices used only by pseudo faces may not be finite
  Eigen::AlignedBox3d box_;
};

/// Returns the length of a box's diagonal. Its square may overflow a double.
double diagonal(const Eigen::AlignedBox3d& box);

/// Maps a box of the world to the cube [-1, 1]^3: its centre to the origin, its longest side to 2.
class PictureFrame {
 public:
  explicit PictureFrame(const Eigen::AlignedBox3d& box);

  /// Maps a point. Differences are taken first, which is exact near the centre, even far from the world's
  /// origin.
  Eigen::Vector3d operator()(const Eigen::Vector3d& world) const {
    return (world * before_ - centre_) / radius_;
  }
  /// Returns the part of a piece in [-reach, reach]^3, or no corners if it is empty. A piece may be 1e60
  /// times larger than the cube, so it is clipped with 100 digits.
  Piece cut(const Piece& world, double reach) const;

 private:
  Eigen::Vector3d centre_;
  double before_ = 1;  ///< scale that keeps differences of the largest doubles finite
  double radius_ = 1;
};

using Pairs = std::vector<SimplexPair>;

/// The mark of a simplex. Of several marks the last one in this order is shown.
enum class Mark : std::uint8_t { none, found, extra, missed };
render::Rgba colour_of(Mark m);

/// The comparison of expected and answered pairs; each list ascending.
struct Verdict {
  Pairs found, missed, extra;
  bool listed = false;  ///< the method returned a list; otherwise all expected pairs count as found

  /// Returns the pairs of the most severe non-empty kind.
  const Pairs& worst() const { return !missed.empty() ? missed : !extra.empty() ? extra : found; }
};
Verdict compare(std::span<const SimplexPair> expected, const std::optional<Pairs>& answered);

/// The two bodies in world coordinates, and the mark of every real simplex.
struct CasePicture {
  std::array<PosedBody, 2> bodies;
  std::array<std::vector<Mark>, 2> marks;
  Eigen::AlignedBox3d box;
  /// If a mark is on every simplex, as in minimised cases: the intersections of the worst pairs, or the
  /// segments between their closest points. The bodies then have their own colours, because marks would not
  /// distinguish anything.
  std::vector<Piece> places;
  Mark worst = Mark::none;

  /// Throws InputError if a pair refers to no real simplex, or the bodies cannot be drawn.
  CasePicture(const cases::Case& c, const Verdict& verdict);

  bool flat() const { return bodies[0].dim() == 2; }
  bool shows(Mark m) const;
  /// Returns true if marks all over the bodies would hide one another.
  bool crowded() const;
  bool all_marked() const;

 private:
  void mark(const Pairs& pairs, Mark m);
  void add_place(const SimplexPair& pair);
};

/// Returns a draw list: bodies translucent, marks in their colours. Geometry outside [-reach, reach]^3 of the
/// frame is clipped.
render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame, double reach);

/// Adds a dot for each mark smaller than `least`, in units of the frame.
void add_dots(render::DrawList& list, const CasePicture& s, const PictureFrame& frame, double reach,
              double least);

}  // namespace lrb::stability
