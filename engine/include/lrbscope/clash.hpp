#pragma once
/// Classification of the contact of two solids, decided exactly, with a separating translation and proven
/// bounds of the penetration depth and of the shared volume.
///
/// The solids are those bounded by the world triangles, whose corners are the doubles given by Pose::apply().
/// A translation moves these corners by exactly the same vector.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// The relation of two solids. A *piece* of a surface is a connected part that is entirely inside the other
/// solid, entirely outside, or on its surface.
enum class ClashKind : std::uint8_t {
  apart,             ///< no common point, and the distance exceeds the clearance
  within_clearance,  ///< no common point, and the distance is at most the clearance
  touching_point,    ///< disjoint interiors; surfaces intersect in points only
  touching_edge,     ///< disjoint interiors; surfaces intersect along lines, in no area
  touching_face,     ///< disjoint interiors; surfaces intersect in an area
  protrudes,  ///< interiors overlap, and neither surface is divided: each of its components has at most one
              ///< piece outside the other solid
  pierces,  ///< A passes through B: a component of A's surface has two or more pieces outside B, none of B's
            ///< has two outside A
  cuts_through,  ///< A divides B: a component of B's surface has two or more pieces outside A
  a_inside_b,    ///< B contains A entirely; surfaces may touch
  b_inside_a,
  equal,      ///< the same solid
  undecided,  ///< the bodies are not apart, but the solids are ill-defined or the work exceeds a limit: see
              ///< ClashResult::reason
};
constexpr auto enum_names(ClashKind) {
  return std::to_array<EnumName<ClashKind>>({{ClashKind::apart, "apart"},
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

/// The reason why a kind is undecided: the first of these that applies.
enum class ClashReason : std::uint8_t {
  none,    ///< the kind is decided
  a_open,  ///< LrbRep::closed() is false
  b_open,
  a_overlaps,  ///< LrbRep::overlaps_itself() is true, so that the faces bound no unique solid
  b_overlaps,
  flat_face,       ///< a face that intersects the other body has no area in the world, due to rounding
  many_cells,      ///< a face has more cells than kInteriorCellsPerFace, or they do not match along an edge
  faces_coincide,  ///< faces coincide, and no point beside them was proven to be inside both
};
constexpr auto enum_names(ClashReason) {
  return std::to_array<EnumName<ClashReason>>(
      {{ClashReason::none, ""},
       {ClashReason::a_open, "A bounds no solid"},
       {ClashReason::b_open, "B bounds no solid"},
       {ClashReason::a_overlaps, "A intersects itself"},
       {ClashReason::b_overlaps, "B intersects itself"},
       {ClashReason::flat_face, "a face that intersects the other body has no area in the world"},
       {ClashReason::many_cells, "the other body cuts a face into too many cells"},
       {ClashReason::faces_coincide,
        "faces coincide, and no point beside them is proven to be inside both"}});
}

struct ClashRequest {
  /// Maximum distance at which disjoint solids are `within_clearance`. Finite, at least 0; world units.
  double clearance = 0;
  /// Direction in which B is to leave A, any length except 0; enables ClashResult::along.
  std::optional<Eigen::Vector3d> along;
  bool depth = true;   ///< compute ClashResult::depth and ClashResult::translation
  bool volume = true;  ///< compute ClashResult::volume
  /// Stop narrowing depths soon after this number of queries and of points located in the bodies; 0: no
  /// limit. The bounds are proven in any case. The volume has no such limit.
  std::uint64_t max_steps = 0;
};

/// Proven bounds of a number.
struct ProvedInterval {
  double lower = 0, upper = 0;
};

/// Numbers of pieces of a solid's surface by their location relative to the other solid.
struct SurfacePieces {
  std::uint32_t inside = 0, outside = 0;
  std::uint32_t max_outside = 0;  ///< the maximum for one component of the surface
  bool on_same = false;  ///< an area coincides with the other's surface, with both solids on the same side
  bool on_opposite = false;  ///< an area coincides with the other's surface, with the solids on opposite
                             ///< sides
};

struct ClashResult {
  ClashKind kind = ClashKind::undecided;
  ClashReason reason = ClashReason::none;  ///< other than none only if the kind is undecided
  bool shares_faces = false;  ///< surfaces coincide in an area, with both solids on the same side of it
  Answer interiors_overlap = Answer::unknown;
  std::array<SurfacePieces, 2> pieces;  ///< of A's surface and of B's; counted if the surfaces intersect
  /// The distance of the solids, world units.
  ProvedInterval distance;
  /// The penetration depth: the length of the shortest translation of B after which the interiors are
  /// disjoint; 0 if they do not overlap. nullopt if a body is not closed. The upper end is the length of
  /// `translation`, infinite if none was found. In bodies that intersect themselves, interior is decided by
  /// parity, as for CollideResult::relation.
  std::optional<ProvedInterval> depth;
  /// A separation vector (cf. minimum translational distance, Cameron and Culley 1986): translated by it, B
  /// is proven to share no interior point with A.
  Eigen::Vector3d translation{0, 0, 0};
  /// For ClashRequest::along: how far B has to move in that direction until the interiors are disjoint for
  /// the first time. They overlap after every move shorter than the lower end, and are disjoint after a move
  /// by the upper end.
  std::optional<ProvedInterval> along;
  /// The volume of the intersection of the solids, world units cubed. nullopt for bodies that are not closed
  /// or intersect themselves, unless they are disjoint.
  std::optional<ProvedInterval> volume;
  bool finished = true;  ///< false: max_steps was reached before depths were as narrow as without a limit
};

/// Classifies the contact of body `a` at pose_a and body `b` at pose_b, with its depth. Poses may be any
/// finite affine maps. Throws InputError unless both bodies are 3D and world coordinates are finite, and for
/// an invalid request.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request = {});

/// Throws InputError for a request that clash() rejects for a body like `a`: a negative or non-finite
/// clearance, a direction of length zero, 2D bodies.
void check_request(const LrbRep& a, const ClashRequest& request);

// Observing the convergence of a clash query: derive from ClashProbe and pass it to clash(). The answer is
// the same with and without a probe.

class ClashProbe {
 public:
  virtual ~ClashProbe() = default;
  /// The bounds of the distance of disjoint bodies became narrower; work as for distance().
  virtual void distance(const Bounds& known) = 0;
  /// The bounds of the depth of overlapping bodies became narrower. The lower bound is proven. The upper
  /// bound is the shortest separation vector found so far, initially infinite; it is proven only in the last
  /// call, which reports the answer. Work counts queries and steps in which EPA polytopes were expanded.
  virtual void depth(const Bounds& known) = 0;
};

/// Records all bounds.
class ClashHistory final : public ClashProbe {
 public:
  void distance(const Bounds& known) override { of_distance.push_back(known); }
  void depth(const Bounds& known) override { of_depth.push_back(known); }
  std::vector<Bounds> of_distance, of_depth;
};

/// Returns the same as clash() without a probe, and reports the bounds while they converge.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, ClashProbe& probe);

}  // namespace lrb
