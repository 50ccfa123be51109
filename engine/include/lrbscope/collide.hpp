#pragma once
/// The two-body query: finds whether two bodies meet, which real faces do, and how the bodies lie to each
/// other.
///
/// There are two algorithms. `complete` never misses: it descends an OBB tree over real faces whose bounds
/// hold everything beneath, so that every pair that meets is reached, and tests exactly at the leaves (see
/// tree_query.hpp for the proof). `paper` is section 4 of the paper to the letter: recursion through lids
/// that hit. It misses contacts under lids that nothing touches, and is kept to reproduce the paper's figures
/// and to show where it fails.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <lrbscope/contact.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {

// The request: what can be asked about two bodies.

enum class Mode : std::uint8_t {
  all_pairs,
  first_pair,  ///< finds one pair that crosses, if there is one; the relation is exact
  /// Finds out whether the surfaces meet. The first pair that does ends the query, and Relation::touching
  /// then says no more than that this pair touches: others may cross.
  any_pair,
};
constexpr auto words_of(Mode) {
  return std::to_array<EnumWord<Mode>>(
      {{Mode::all_pairs, "all"}, {Mode::first_pair, "first"}, {Mode::any_pair, "any"}});
}

enum class Recursion : std::uint8_t {
  complete,
  paper,         ///< each pair of regions is recursed into once
  paper_strict,  ///< each region is refined once; its new faces meet only the new faces of what it hit
};

constexpr auto words_of(Recursion) {
  return std::to_array<EnumWord<Recursion>>({{Recursion::complete, "complete"},
                                             {Recursion::paper, "paper"},
                                             {Recursion::paper_strict, "paper_strict"}});
}
const char* to_string(Recursion r);

enum class Predicates : std::uint8_t {
  exact,
  /// Without the exact fallback: the answer can be wrong; exists to measure what exactness costs and saves.
  floating,
};
constexpr auto words_of(Predicates) {
  return std::to_array<EnumWord<Predicates>>(
      {{Predicates::exact, "exact"}, {Predicates::floating, "floating"}});
}

/// The largest number of pairs that a query keeps, unless the request gives another. A pair takes 25 bytes
/// while it is found and sorted, and 650 with its contact (docs/measurements.md): 0.8 GB, and 1.4 GB.
inline constexpr std::uint64_t kMostPairs = std::uint64_t{1} << 25;
inline constexpr std::uint64_t kMostPairsWithContacts = std::uint64_t{1} << 21;

struct CollideRequest {
  Mode mode = Mode::all_pairs;
  Recursion recursion = Recursion::complete;
  Predicates predicates = Predicates::exact;  ///< for pairs and relation; contacts are always exact
  WrapperMode wrapper = WrapperMode::regularised;
  bool contacts = false;  ///< fill CollideResult::contacts and CollideResult::regions (all_pairs)
  bool interiors_overlap =
      false;  ///< decide CollideResult::interiors_overlap for bodies that meet (all_pairs)

  /// Limits on the effort: coarse queries (docs/queries.md says when to use which). Only for `complete`,
  /// without contacts, interiors_overlap or unregularised wrappers (else InputError). Bodies that meet are
  /// never called separate. The levels that they walk are made when they are first asked for, unless
  /// LrbRep::levels() was called before or a file had them; a query with max_time does without rather than
  /// make them.
  ///
  /// tolerance: the relation is exact, and so is an answer of one pair; the list of all pairs of bodies that
  /// cross may be that of wrappers no further off than this, each. Unit: the meshes'.
  double tolerance = 0;
  /// Limits on tests (face tests; 0: no limit) and time (seconds; 0: no limit). Where a limit is reached the
  /// best answer so far is given: nothing, the relation with one pair, or that of a level, coarser ones
  /// first.
  std::uint64_t max_tests = 0;
  double max_time = 0;
  /// For separate bodies: finds CollideResult::separation. Takes longer than the query, and no limit ends it.
  bool separation = false;
  /// The largest number of pairs that are kept: a query that finds more ends with an InputError. (Two bodies
  /// of n faces have up to n * n.) 0: kMostPairs, or kMostPairsWithContacts. The paper's recursions count a
  /// pair each time they find it.
  std::uint64_t max_pairs = 0;

  bool is_coarse() const { return tolerance > 0 || max_tests > 0 || max_time > 0; }
  std::uint64_t pair_limit() const {
    return max_pairs > 0 ? max_pairs : contacts ? kMostPairsWithContacts : kMostPairs;
  }
  friend bool operator==(const CollideRequest&, const CollideRequest&) = default;
};

// The result: what a query answers, and how much work it took.

/// How two bodies lie to each other.
enum class Relation : std::uint8_t {
  separate,    ///< no point in common
  crossing,    ///< at least two faces pass through each other's interior
  touching,    ///< surfaces meet, but no two faces cross. The bodies may still share a volume: two equal
               ///< cubes, one shifted along an edge, overlap with their sides flush, and no face passes
               ///< through another. CollideResult::interiors_overlap tells, where it is asked for
  a_inside_b,  ///< no surface contact; B holds A
  b_inside_a,
  undefined,  ///< no surface contact, boxes in the world that meet, and a body that is not closed: inside has
              ///< no meaning
  /// A query within limits did not find out; the bodies meet, or are no further apart than the error bound.
  unresolved,
};
constexpr auto words_of(Relation) {
  return std::to_array<EnumWord<Relation>>({{Relation::separate, "separate"},
                                            {Relation::crossing, "crossing"},
                                            {Relation::touching, "touching"},
                                            {Relation::a_inside_b, "a_inside_b"},
                                            {Relation::b_inside_a, "b_inside_a"},
                                            {Relation::undefined, "undefined"},
                                            {Relation::unresolved, "unresolved"}});
}
const char* to_string(Relation r);

enum class Answer : std::uint8_t { no, yes, unknown };
constexpr auto words_of(Answer) {
  return std::to_array<EnumWord<Answer>>(
      {{Answer::no, "no"}, {Answer::yes, "yes"}, {Answer::unknown, "unknown"}});
}
const char* to_string(Answer a);

/// A pair of real simplices that meet (see LrbRep::face_of_simplex for the faces).
struct SimplexPair {
  SimplexId a, b;
  friend auto operator<=>(const SimplexPair&, const SimplexPair&) = default;
};

/// A certificate that two closed bodies are separate: if these regions of their outermost wrappers are
/// refined in this order, the wrappers meet nowhere, and none has a point in the other. No region can be
/// taken back in without the proof failing.
struct Separation {
  std::array<std::vector<RegionId>, 2> refined;      ///< A's and B's
  std::array<std::uint32_t, 2> face_count = {0, 0};  ///< of the two wrappers

  friend bool operator==(const Separation&, const Separation&) = default;
};

/// The work that the query did, in numbers of operations.
struct Counters {
  std::uint64_t face_tests = 0;  ///< exact comparisons of two simplices, pseudo or real (best: pairs found)
  std::uint64_t real_tests = 0;  ///< those of them in which both are real
  std::uint64_t exact_fallbacks = 0;  ///< predicates that the floating-point filter could not decide
  std::uint64_t node_pairs = 0;       ///< complete: pairs of tree nodes visited
  std::uint64_t box_tests = 0;        ///< complete: box against box
  std::uint64_t prefilter_tests =
      0;  ///< complete: pairs of simplices that reached the box and plane tests of a pair of leaves
  std::uint64_t refinements = 0;     ///< paper: refine operations; complete: equal to regions_opened
  std::uint64_t regions_opened = 0;  ///< regions excluded from either wrapper at the end
  std::vector<std::uint32_t> face_tests_by_level;  ///< by max(depth of a, depth of b) of the compared faces

  friend bool operator==(const Counters&, const Counters&) = default;
};

struct CollideResult {
  Relation relation = Relation::separate;
  /// Crossing, inside: yes. Separate: no. Touching: unknown unless requested (see Relation::touching: without
  /// the request, nobody notices that a stack of boxes sinks). A body that is not closed: unknown. Yes
  /// assumes that rounding leaves the bodies a volume in the world. If requested, a crossing is yes only
  /// where that is proved, else unknown; a body inside another is not checked for having become flat.
  Answer interiors_overlap = Answer::unknown;
  Recursion recursion = Recursion::complete;  ///< the recursion that was used
  Mode mode = Mode::all_pairs;
  /// Ascending; at most one pair unless all_pairs. Coarse queries: with pseudo simplices
  /// (LrbRep::is_real_simplex()) where lids were not refined; those meet or come within rounding of it.
  /// Contacts that a lid hides from the other body are not among them.
  std::vector<SimplexPair> pairs;
  std::vector<exact::Meet> meets;               ///< (|pairs|) touch or cross
  std::vector<PairContactRecord> contacts;      ///< (|pairs|) if requested
  std::vector<ContactRegion> regions;           ///< connected groups of contacts, if requested
  std::array<std::vector<RegionId>, 2> opened;  ///< regions refined, A's and B's, in order
  /// 0 if the answer is exact. Else the pairs are those of wrappers, and where two of their faces meet, both
  /// bodies are no further away than this together, in the world. Bodies that are unresolved are no further
  /// apart than this. Infinite: no level was reached, and the pair that there may be is one of those that
  /// cross.
  double error_bound = 0;
  bool finished = true;  ///< false: a limit was reached before the tolerance (or the exact answer) was
  std::optional<Separation> separation;  ///< if requested, separate, and not nearer than rounding
  Counters counters;
};

/// Make an answer and its counters as new, but keep their memory.
void clear(CollideResult& result);
void clear(Counters& counters);

/// Throws the InputError that the query found more pairs than `limit`.
[[noreturn]] void refuse_pairs(std::uint64_t limit);

/// Returns the FNV-1a hash (64 bits) of the pairs, each as u32 a, u32 b little-endian; cbf29ce484222325 for
/// none.
std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs);

/// Queries body `a` at pose_a against body `b` at pose_b; both must be 3D, or both 2D (else InputError).
/// Poses must be finite, and so must be the world coordinates of every vertex that a face uses (else
/// InputError, naming it). A vertex that no face uses need not, but may be refused where the body comes
/// near 1.8e308. To watch a query: observe.hpp.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request = {});

/// Throw InputError where collide() does before it begins: for bodies and poses that cannot be queried, and
/// for a tolerance or limit that is not finite or is combined with a request that must be exact. Programs
/// call these to reject input before the first of many queries.
void check_query(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
void check_request(const CollideRequest& request);

/// Tests every pair of real simplices exactly: the slow answer that the fast one is compared with. It shares
/// the predicates and the definition of world coordinates with the query, and nothing else: no tree, no
/// boxes. Throws InputError beyond kMostPairs.
struct BruteForceResult {
  std::vector<SimplexPair> pairs;  ///< ascending
  std::vector<exact::Meet> meets;  ///< (|pairs|)
  Relation relation = Relation::separate;
};

BruteForceResult brute_force(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

}  // namespace lrb
