#pragma once
/// What a worst case's picture shows: two posed bodies, and a mark on each of their simplices.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/query/collide.hpp"
#include "render/draw_list.hpp"
#include "scenarios/stability/report/picture_frame.hpp"

namespace lrb::stability {

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
