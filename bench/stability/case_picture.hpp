#pragma once
/// Draws the expected and the actual answer of a method to a case: two posed bodies, and a mark on each of
/// their simplices.

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "bench/cases/families.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::stability {

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

/// The text above the picture. Counts of pairs are added to the counters.
struct WorstCaseText {
  std::string title;   ///< family and method
  std::string answer;  ///< the outcome: "refused: ...", "separate, should be touching"
  std::vector<render::OverlayCounter> counters;
};

/// Draws both bodies translucent, and the simplices of all expected and answered pairs coloured by their mark
/// (of several marks: missed before extra before found). A close-up of the wrong pairs is added if they are
/// small compared to the bodies.
/// `answered`: nullopt if the method returned no list; all expected pairs are then drawn as found. Pairs are
/// of real simplices, in any order; 3D or 2D. Throws InputError if world coordinates are not finite or a pair
/// refers to no real simplex.
render::Image worst_case_picture(const cases::Case& c, std::span<const SimplexPair> expected,
                                 const std::optional<std::vector<SimplexPair>>& answered,
                                 const WorstCaseText& text, render::Rasterizer& rasterizer);

/// Draws the worst case of every cell that has one into folder/worst/FAMILY-METHOD.png, and removes the
/// pictures of earlier runs. `ask` runs a case again; `progress` is called before each case. Cases that
/// cannot be drawn (coordinates that are not finite, families that are not in all_families()) get no picture.
/// Returns (|cells|) paths relative to the folder, for ReportOptions::pictures; empty for cells without a
/// picture. Throws EnvironmentError if drawing or writing fails.
std::vector<std::string> draw_worst_cases(
    const Grid& grid, const std::string& folder, const std::function<Replay(const Record&)>& ask,
    const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace lrb::stability
