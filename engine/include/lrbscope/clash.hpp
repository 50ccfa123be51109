#pragma once
/// What kind of contact two solids have, and how deep it is: the kind, decided exactly; a translation that
/// parts them; bounds of the depth and of the volume that they share, as intervals that are proved.
///
/// All of it is about the solids that the triangles of the world bound, whose corners are the doubles that
/// Pose::apply() gives. A translation moves those corners by exactly the same vector.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// How two solids lie to each other. A *piece* of one's surface is a connected part of it that is wholly
/// inside the other solid, wholly outside, or on its surface.
enum class ClashKind : std::uint8_t {
  apart,             ///< no point in common, and further apart than the clearance
  within_clearance,  ///< no point in common, and at most the clearance apart
  touching_point,    ///< interiors share no point; surfaces meet in points alone
  touching_edge,     ///< interiors share no point; surfaces meet along lines, in no area
  touching_face,     ///< interiors share no point; surfaces meet in an area
  protrudes,         ///< interiors overlap, and neither is parted: each has one piece at most outside the
                     ///< other (of each component of its surface)
  pierces,           ///< A goes through B: A is parted, into pieces outside of B; B is not
  cuts_through,      ///< A parts B: of B, two pieces or more of a component lie outside A
  a_inside_b,        ///< B holds all of A, whether or not surfaces touch
  b_inside_a,
  equal,      ///< the same solid
  undecided,  ///< the bodies are not apart, but it is not clear what solids they are, or the work is too
              ///< much: ClashResult::reason
};
constexpr auto words_of(ClashKind) {
  return std::to_array<EnumWord<ClashKind>>({{ClashKind::apart, "apart"},
                                             {ClashKind::within_clearance, "within_clearance"},
                                             {ClashKind::touching_point, "touching_point"},
                                             {ClashKind::touching_edge, "touching_edge"},
                                             {ClashKind::touching_face, "touching_face"},
                                             {ClashKind::protrudes, "protrudes"},
                                             {ClashKind::pierces, "pierces"},
                                             {ClashKind::cuts_through, "cuts_through"},
                                             {ClashKind::a_inside_b, "a_inside_b"},
                                             {ClashKind::b_inside_a, "b_inside_a"},
                                             {ClashKind::equal, "equal"},
                                             {ClashKind::undecided, "undecided"}});
}
const char* to_string(ClashKind k);

/// Why a kind is undecided: the first of these that holds.
enum class ClashReason : std::uint8_t {
  none,    ///< it is decided
  a_open,  ///< LrbRep::closed() does not hold
  b_open,
  a_overlaps,  ///< LrbRep::overlaps_itself() holds, so that there is no one solid that the faces bound
  b_overlaps,
  flat_face,       ///< rounding in the world took its area from a face that meets the other body
  many_cells,      ///< a face is cut into more cells than kInteriorCellsPerFace, or into some that do not fit
  faces_coincide,  ///< faces coincide, and no point beside them was proved to be inside both
};
constexpr auto words_of(ClashReason) {
  return std::to_array<EnumWord<ClashReason>>(
      {{ClashReason::none, ""},
       {ClashReason::a_open, "A bounds no solid"},
       {ClashReason::b_open, "B bounds no solid"},
       {ClashReason::a_overlaps, "A intersects itself"},
       {ClashReason::b_overlaps, "B intersects itself"},
       {ClashReason::flat_face, "a face that meets the other body has no area in the world"},
       {ClashReason::many_cells, "the other body cuts a face into too many cells"},
       {ClashReason::faces_coincide,
        "faces coincide, and no point beside them is proved to be inside both"}});
}

struct ClashRequest {
  /// The distance up to which solids without a point in common are `within_clearance`. Finite, at least 0;
  /// unit: the world's.
  double clearance = 0;
  /// A direction of one's own, of any length but 0, along which B is to leave A.
  std::optional<Eigen::Vector3d> along;
  bool depth = true;   ///< find ClashResult::depth and ClashResult::translation
  bool volume = true;  ///< find ClashResult::volume
};

/// Two doubles that hold a number.
struct ProvedInterval {
  double lower = 0, upper = 0;
};

/// The pieces of a solid's surface, by where they lie to the other solid.
struct SurfacePieces {
  std::uint32_t inside = 0, outside = 0;
  std::uint32_t most_outside = 0;  ///< the most of one component of the surface
  bool on_same = false;            ///< an area lies on the other's surface, with both solids on the same side
  bool on_opposite = false;        ///< ..., with the solids on opposite sides
};

struct ClashResult {
  ClashKind kind = ClashKind::undecided;
  ClashReason reason = ClashReason::none;  ///< of a kind that is undecided, and of no other
  bool shares_faces = false;  ///< surfaces coincide over an area, with both solids on the same side of it
  Answer interiors_overlap = Answer::unknown;
  std::array<SurfacePieces, 2> pieces;  ///< of A's surface and of B's; counted where surfaces meet
  /// The distance of the solids.
  ProvedInterval distance;
  /// The penetration depth: the length of the shortest translation of B after which the interiors share no
  /// point. None for bodies that are not closed. If interiors do not overlap: 0. The upper end is the length
  /// of `translation`; infinite if none was found. Of bodies that intersect themselves, points that an odd
  /// number of faces hide count as interior, as for CollideResult::relation.
  std::optional<ProvedInterval> depth;
  /// Moved by this, B is proved to share no interior point with A: the solids are apart.
  Eigen::Vector3d translation{0, 0, 0};
  /// ClashRequest::along: how far B has to move in that direction until the interiors share no point for the
  /// first time: for all that is less than the lower end they do, and at the upper end they do not.
  std::optional<ProvedInterval> along;
  /// The volume that the solids share, unit cubed. None for bodies that are not closed or intersect
  /// themselves, unless they are apart.
  std::optional<ProvedInterval> volume;
};

/// Returns what kind of contact body `a` at pose_a and body `b` at pose_b have, and how deep it is. Both must
/// be 3D; poses may be any finite maps, and world coordinates must be finite. Throws InputError for these,
/// and for numbers of the request that have no meaning.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request = {});

/// Throws InputError for a request that clash() rejects, with bodies of the dimension of `a`: a clearance
/// that is negative or not finite, a direction without length, bodies in the plane.
void check_request(const LrbRep& a, const ClashRequest& request);

// Watching a clash query, from outside the engine: derive from ClashProbe and give it to clash(). The answer
// is the same as without.

class ClashProbe {
 public:
  virtual ~ClashProbe() = default;
  /// Bounds of the distance of bodies without a point in common became narrower; work as for a distance.
  virtual void distance(const Bounds& known) = 0;
  /// Bounds of the depth of bodies whose interiors overlap: the lower end is proved, the upper one is the
  /// shortest way out that was found so far, infinite at first, which only the last bounds, those of the
  /// answer, have proved. Work is counted in queries that were asked and steps in which hulls grew.
  virtual void depth(const Bounds& known) = 0;
};

/// Keeps what it is told.
class ClashCourse final : public ClashProbe {
 public:
  void distance(const Bounds& known) override { of_distance.push_back(known); }
  void depth(const Bounds& known) override { of_depth.push_back(known); }
  std::vector<Bounds> of_distance, of_depth;
};

/// Does what clash() in clash.hpp does, and tells the probe what is known, after more and more work.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, ClashProbe& probe);

}  // namespace lrb
