#pragma once
/// The two-body query: decides whether two bodies intersect, finds the intersecting real faces, and
/// classifies the relation of the bodies.
///
/// There are two algorithms. `complete` never misses a contact: it descends OBB trees over the real faces,
/// whose nodes bound everything beneath, and tests exactly at the leaves (proof in tree_query.hpp). `paper`
/// is section 4 of the paper to the letter: recursion through lids that were hit. It misses contacts under
/// lids that are not touched. It is kept to reproduce the paper's figures and to show where the paper's
/// algorithm fails.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <lrbscope/contact.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {

// The request.

enum class Mode : std::uint8_t {
  all_pairs,
  first_pair,  ///< finds one crossing pair, if there is one; the relation is exact
  /// Decides whether the surfaces intersect. The first intersecting pair ends the query. Relation::touching
  /// then refers to that pair only: others may cross.
  any_pair,
};
constexpr auto enum_names(Mode) {
  return std::to_array<EnumName<Mode>>(
      {{Mode::all_pairs, "all"}, {Mode::first_pair, "first"}, {Mode::any_pair, "any"}});
}

enum class Recursion : std::uint8_t {
  complete,
  paper,          ///< each pair of regions is recursed into once
  paper_strict,   ///< each region is refined once; its new faces are tested only against the new faces of the
                  ///< regions it hit
  paper_wrapper,  ///< new faces are tested against the whole current wrapper of the other body
  // With boxes, as queries on LRB-reps of small regions; they can miss contacts as well:
  paper_boxes,          ///< only the larger region is refined; its floor is tested against one list of faces
  paper_wrapper_boxes,  ///< the same against the whole current wrapper of the other body
};

constexpr auto enum_names(Recursion) {
  return std::to_array<EnumName<Recursion>>({{Recursion::complete, "complete"},
                                             {Recursion::paper, "paper"},
                                             {Recursion::paper_strict, "paper_strict"},
                                             {Recursion::paper_wrapper, "paper_wrapper"},
                                             {Recursion::paper_boxes, "paper_boxes"},
                                             {Recursion::paper_wrapper_boxes, "paper_wrapper_boxes"}});
}
const char* to_string(Recursion r);

enum class Predicates : std::uint8_t {
  exact,
  /// Without the exact fallback. The answer can be wrong; exists to measure the cost and benefit of
  /// exactness.
  floating,
};
constexpr auto enum_names(Predicates) {
  return std::to_array<EnumName<Predicates>>(
      {{Predicates::exact, "exact"}, {Predicates::floating, "floating"}});
}

/// Default for the maximum number of pairs of a query. A pair takes 25 bytes while pairs are found and
/// sorted, and 650 with its contact (docs/measurements.md): 0.8 GB and 1.4 GB in total.
inline constexpr std::uint64_t kMaxPairs = std::uint64_t{1} << 25;
inline constexpr std::uint64_t kMaxPairsWithContacts = std::uint64_t{1} << 21;

struct CollideRequest {
  Mode mode = Mode::all_pairs;
  Recursion recursion = Recursion::complete;
  Predicates predicates = Predicates::exact;  ///< for pairs and relation; contacts are always exact
  WrapperMode wrapper = WrapperMode::regularised;
  bool contacts = false;  ///< fill CollideResult::contacts and CollideResult::regions (all_pairs)
  /// Decide CollideResult::interiors_overlap for intersecting bodies (all_pairs).
  bool interiors_overlap = false;

  /// Limits that make a query *coarse* (error-bounded; docs/queries.md describes when to use which). Only for
  /// `complete`, without contacts, interiors_overlap or unregularised wrappers (else InputError).
  /// Intersecting bodies are never reported as separate. Coarse queries use levels of detail, which the first
  /// one creates unless LrbRep::levels() was called before or the file contained them. A query with max_time
  /// does not create them.
  ///
  /// tolerance: the relation is exact, and so is the answer in the modes that find one pair. The list of all
  /// pairs of crossing bodies may be that of wrappers whose deviation is at most `tolerance` each. Mesh
  /// units.
  double tolerance = 0;
  /// Limits on face tests and on time in seconds; 0: no limit. When a limit is reached, the best answer so
  /// far is returned. With increasing limits this is: nothing, the relation with one pair, the pairs of a
  /// level of detail (coarser levels first).
  std::uint64_t max_tests = 0;
  double max_time = 0;
  /// For separate bodies: compute CollideResult::separation. Takes longer than the query and is not subject
  /// to limits.
  bool separation = false;
  /// Maximum number of pairs; a query that finds more throws InputError. (Two bodies of n faces have up to
  /// n^2 pairs.) 0: kMaxPairs, or kMaxPairsWithContacts with contacts. The paper's recursions count a pair
  /// each time they find it.
  std::uint64_t max_pairs = 0;

  /// Also for NaN, which check_request() rejects.
  bool is_coarse() const { return !(tolerance <= 0) || max_tests > 0 || !(max_time <= 0); }
  std::uint64_t pair_limit() const {
    return max_pairs > 0 ? max_pairs : contacts ? kMaxPairsWithContacts : kMaxPairs;
  }
  friend bool operator==(const CollideRequest&, const CollideRequest&) = default;
};

// The result, and the work done.

/// The relation of two bodies.
enum class Relation : std::uint8_t {
  separate,  ///< no common point
  crossing,  ///< at least two faces cross in their interiors
  /// Surfaces intersect, but no two faces cross. The interiors may still overlap: two equal cubes, one
  /// shifted along an edge, overlap with flush sides, and no face crosses another.
  /// CollideResult::interiors_overlap decides it, if requested.
  touching,
  a_inside_b,  ///< no surface contact; B contains A
  b_inside_a,
  undefined,  ///< no surface contact and world AABBs that intersect, but a body is not closed, so that inside
              ///< is not defined
  /// A query with limits did not decide: the bodies intersect, or their distance is at most the error bound.
  unresolved,
};
constexpr auto enum_names(Relation) {
  return std::to_array<EnumName<Relation>>({{Relation::separate, "separate"},
                                            {Relation::crossing, "crossing"},
                                            {Relation::touching, "touching"},
                                            {Relation::a_inside_b, "a_inside_b"},
                                            {Relation::b_inside_a, "b_inside_a"},
                                            {Relation::undefined, "undefined"},
                                            {Relation::unresolved, "unresolved"}});
}
/// Returns true if one body contains the other.
constexpr bool is_inside(Relation r) {
  return r == Relation::a_inside_b || r == Relation::b_inside_a;
}
/// Returns the relation of the bodies in the other order.
constexpr Relation mirrored(Relation r) {
  if (r == Relation::a_inside_b) return Relation::b_inside_a;
  return r == Relation::b_inside_a ? Relation::a_inside_b : r;
}
const char* to_string(Relation r);

enum class Answer : std::uint8_t { no, yes, unknown };
constexpr auto enum_names(Answer) {
  return std::to_array<EnumName<Answer>>(
      {{Answer::no, "no"}, {Answer::yes, "yes"}, {Answer::unknown, "unknown"}});
}
const char* to_string(Answer a);

/// A pair of intersecting real simplices (see LrbRep::face_of_simplex() for their faces).
struct SimplexPair {
  SimplexId a, b;
  friend auto operator<=>(const SimplexPair&, const SimplexPair&) = default;
};

/// A certificate that two closed bodies are separate: if these regions are refined in this order, starting
/// with the outermost wrappers, the two wrappers do not intersect, and neither contains a point of the other.
/// The certificate is minimal: if any region is included again, the proof fails.
struct Separation {
  std::array<std::vector<RegionId>, 2> refined;      ///< regions of A and of B
  std::array<std::uint32_t, 2> face_count = {0, 0};  ///< of the two wrappers

  friend bool operator==(const Separation&, const Separation&) = default;
};

/// The work done by a query, as numbers of operations.
struct Counters {
  std::uint64_t face_tests = 0;  ///< exact tests of two simplices, pseudo or real (best: number of pairs)
  std::uint64_t real_tests = 0;  ///< exact tests of two real simplices
  std::uint64_t exact_fallbacks = 0;  ///< predicates that the floating-point filter could not decide
  std::uint64_t node_pairs = 0;       ///< complete: pairs of tree nodes visited
  std::uint64_t box_tests = 0;        ///< tests of two boxes; paper_boxes: also of a face and a box
  /// complete: pairs of simplices that reached the box and plane tests of a pair of leaves
  std::uint64_t prefilter_tests = 0;
  std::uint64_t refinements = 0;     ///< paper: refine operations; complete: equal to regions_opened
  std::uint64_t regions_opened = 0;  ///< number of regions excluded from either wrapper at the end
  std::vector<std::uint32_t> face_tests_by_level;  ///< by max(depth of a, depth of b) of the tested faces

  friend bool operator==(const Counters&, const Counters&) = default;
};

struct CollideResult {
  Relation relation = Relation::separate;
  /// Crossing or inside: yes. Separate: no. Touching: unknown unless requested (see Relation::touching:
  /// without the request a sinking stack of boxes goes unnoticed). A body that is not closed: unknown. Yes
  /// assumes that the bodies keep a volume under rounding of the world coordinates. If requested, crossing
  /// bodies are reported as yes only if that is proven, else unknown; a body inside another is not checked
  /// for zero volume.
  Answer interiors_overlap = Answer::unknown;
  Recursion recursion = Recursion::complete;  ///< the recursion that was used
  Mode mode = Mode::all_pairs;
  /// Ascending; at most one pair unless all_pairs. Coarse queries: contain pseudo simplices
  /// (LrbRep::is_real_simplex()) where lids were not refined, and such pairs intersect or are within rounding
  /// of it. Contacts hidden from the other body by a lid are missing.
  std::vector<SimplexPair> pairs;
  std::vector<exact::Meet> meets;               ///< (|pairs|) touch or cross
  std::vector<PairContactRecord> contacts;      ///< (|pairs|) if requested
  std::vector<ContactRegion> regions;           ///< connected groups of contacts, if requested
  std::array<std::vector<RegionId>, 2> opened;  ///< refined regions of A and of B, in order
  /// 0 if the answer is exact. Otherwise the pairs belong to wrappers: where two of their faces intersect,
  /// the distances to both bodies add up to at most this, in world units. The distance of unresolved bodies
  /// is at most this. Infinite: no level of detail was completed; the pair, if there is one, is one of the
  /// crossing pairs.
  double error_bound = 0;
  bool finished = true;  ///< false: a limit was reached before the tolerance (or the exact answer)
  std::optional<Separation> separation;  ///< if requested, for separate bodies whose distance exceeds
                                         ///< rounding
  Counters counters;
};

/// Reset a result or its counters, but keep their memory.
void clear(CollideResult& result);
void clear(Counters& counters);

/// Throws an InputError: the query found more than `limit` pairs.
[[noreturn]] void reject_pairs(std::uint64_t limit);

/// Returns the FNV-1a hash (64 bits) of the pairs, each as little-endian u32 a, u32 b; cbf29ce484222325 if
/// there are none.
std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs);

/// Queries body `a` at pose_a against body `b` at pose_b. Throws InputError unless both are 3D or both 2D,
/// the poses are finite, and the world coordinates of every vertex of a face are finite (naming the vertex).
/// Unused vertices are exempt, but may be rejected for bodies with world coordinates near 1.8e308. To observe
/// a query, see observe.hpp.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request = {});

/// Throw InputError under the conditions that collide() checks first: bodies and poses that cannot be
/// queried; a tolerance or limit that is not finite or is combined with a request that must be exact. For
/// programs that validate input before many queries.
void check_query(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
void check_request(const CollideRequest& request);

/// The result of brute force.
struct BruteForceResult {
  std::vector<SimplexPair> pairs;  ///< ascending
  std::vector<exact::Meet> meets;  ///< (|pairs|)
  Relation relation = Relation::separate;
};

/// Tests all pairs of real simplices with intersecting world AABBs (others cannot meet), as the reference for
/// collide(), with which it shares only predicates and world coordinates. Throws InputError as collide(), or
/// beyond kMaxPairs.
BruteForceResult brute_force(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

}  // namespace lrb
