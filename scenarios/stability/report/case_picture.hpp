#pragma once
/// What a worst case's picture shows: two posed bodies, and what became of each of their simplices.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/query/collide.hpp"
#include "render/draw_list.hpp"
#include "scenarios/stability/report/picture_frame.hpp"

namespace lrb::stability {

using Pairs = std::vector<SimplexPair>;

/// Of several for one simplex, the last one counts.
enum class Mark : std::uint8_t { none, found, extra, missed };
render::Rgba colour_of(Mark m);

/// Expected and answered pairs, told apart. Each ascending.
struct Verdict {
  Pairs found, missed, extra;
  bool listed = false;  ///< the method gave a list; else all that is expected counts as found

  /// The pairs to look at.
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
  /// Marks all over the bodies would hide one another.
  bool crowded() const;

 private:
  void mark(const Pairs& pairs, Mark m);
};

/// Bodies translucent, marks in their colours; what lies beyond [-reach, reach]^3 of the frame is cut off.
render::DrawList draw_list(const CasePicture& s, const PictureFrame& frame, double reach);

/// A mark smaller than `least`, in the frame's unit, becomes a dot.
void add_dots(render::DrawList& list, const CasePicture& s, const PictureFrame& frame, double reach,
              double least);

}  // namespace lrb::stability
