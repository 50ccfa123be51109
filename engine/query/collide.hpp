#pragma once
/// The two-body query: do two bodies meet, which real faces do, and how do the bodies lie to each other?
///
/// Two algorithms. `complete` never misses: a tree over blocks of real faces whose bounds hold everything
/// beneath, so that every pair that meets is reached, and an exact test at the leaves (see tree_query.hpp for
/// the proof). `paper` is section 4 of the paper to the letter: recursion through lids that hit. It misses
/// contacts under lids that nothing touches, and is kept to reproduce the paper's figures and to show where
/// it fails.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/lrb/pose.hpp"
#include "engine/lrb/wrapper.hpp"
#include "engine/query/contact.hpp"
#include "engine/query/probe.hpp"

namespace lrb {

enum class Mode : std::uint8_t {
  all_pairs,
  first_pair,  ///< one pair that crosses, if there is one; the relation is exact
  any_pair,    ///< do the surfaces meet? The first pair that does ends the query, and Relation::touching then
               ///< says no more than that this pair touches: others may cross
};

enum class Recursion : std::uint8_t {
  complete,
  paper,         ///< each pair of regions is recursed into once
  paper_strict,  ///< each region is refined once; its new faces meet only the new faces of what it hit
};

const char* to_string(Recursion r);

enum class Predicates : std::uint8_t {
  exact,
  floating,  ///< without the exact fallback: the answer can be wrong; to measure what exactness costs and
             ///< saves
};

struct CollideRequest {
  Mode mode = Mode::all_pairs;
  Recursion recursion = Recursion::complete;
  Predicates predicates = Predicates::exact;  ///< for pairs and relation; contacts are always exact
  WrapperMode wrapper = WrapperMode::regularised;
  bool contacts = false;  ///< fill CollideResult::contacts and ::regions (all_pairs only)
  bool interiors_overlap =
      false;  ///< decide CollideResult::interiors_overlap for bodies that meet (all_pairs)

  /// No more than a scene needs. With any of these three the answer may be about wrappers instead of the
  /// bodies, and says so (CollideResult::error_bound). It never calls bodies separate that meet. Only
  /// `complete`, without contacts, interiors_overlap or unregularised wrappers (else InputError). What is
  /// needed of a body is made, and kept in the context, when it is first asked for; that is not counted.
  double tolerance = 0;         ///< regions no thicker than this stay closed; unit: the meshes'
  std::uint64_t max_tests = 0;  ///< face tests at most; 0: as many as it takes
  double max_time = 0;          ///< seconds at most, looked at every few face tests; 0: as long as it takes
  /// For separate bodies: find CollideResult::separation. Takes longer than the query.
  bool separation = false;

  bool is_coarse() const { return tolerance > 0 || max_tests > 0 || max_time > 0; }
};

/// How two bodies lie to each other.
enum class Relation : std::uint8_t {
  separate,    ///< no point in common
  crossing,    ///< at least two faces pass through each other's interior
  touching,    ///< surfaces meet, but no two faces cross
  a_inside_b,  ///< no surface contact; B holds A
  b_inside_a,
  undefined,   ///< no surface contact, and a body that is not closed: inside has no meaning
  unresolved,  ///< a coarse query did not prove the bodies apart; they are closer than the error bound, or
               ///< meet
};
const char* to_string(Relation r);

enum class Answer : std::uint8_t { no, yes, unknown };
const char* to_string(Answer a);

/// A pair of real simplices that meet (see LrbRep::face_of_simplex for the faces).
struct SimplexPair {
  SimplexId a, b;
  friend auto operator<=>(const SimplexPair&, const SimplexPair&) = default;
};

/// A certificate that two closed bodies are apart: their outermost wrappers, with these regions refined in
/// this order, meet nowhere, and none has a point in the other. No region can be taken back in without the
/// proof failing.
struct Separation {
  std::array<std::vector<RegionId>, 2> refined;      ///< A's and B's
  std::array<std::uint32_t, 2> face_count = {0, 0};  ///< of the two wrappers
};

/// What the query did. All are numbers of operations.
struct Counters {
  std::uint64_t face_tests = 0;  ///< exact comparisons of two simplices, pseudo or real (best: pairs found)
  std::uint64_t real_tests = 0;  ///< of these, both real
  std::uint64_t exact_fallbacks = 0;  ///< predicates that floating point could not decide
  std::uint64_t node_pairs = 0;       ///< complete: pairs of tree nodes expanded
  std::uint64_t box_tests = 0;        ///< complete: box against box
  std::uint64_t prefilter_tests =
      0;  ///< complete: simplex pairs that reached the box and plane tests of a leaf pair
  std::uint64_t refinements = 0;     ///< paper: refine operations; complete: equal to regions_opened
  std::uint64_t regions_opened = 0;  ///< regions excluded from either wrapper at the end
  std::vector<std::uint32_t> face_tests_by_level;  ///< by max(depth of a, depth of b) of the compared faces
};

struct CollideResult {
  Relation relation = Relation::separate;
  /// crossing, inside: yes; separate: no; touching: if requested; a body that is not closed: unknown. Yes
  /// takes for granted that rounding leaves the bodies a volume in the world. If requested, a crossing is yes
  /// only where that is proved, else unknown; a body inside another is not asked whether it has become flat.
  Answer interiors_overlap = Answer::unknown;
  Recursion recursion = Recursion::complete;  ///< the one that was used
  Mode mode = Mode::all_pairs;
  /// Ascending; at most one but for all_pairs. Coarse queries: with pseudo simplices (LrbRep::
  /// is_real_simplex()) where lids stayed closed; those meet or come within rounding of it.
  std::vector<SimplexPair> pairs;
  std::vector<exact::Meet> meets;               ///< (|pairs|) touch or cross
  std::vector<PairContactRecord> contacts;      ///< (|pairs|) if requested
  std::vector<ContactRegion> regions;           ///< connected groups of contacts, if requested
  std::array<std::vector<RegionId>, 2> opened;  ///< regions refined, A's and B's, in order
  /// 0: the answer is exact. Else the pairs are those of wrappers that are off the bodies by no more than
  /// this, both together, in the world: unresolved bodies are no further apart. Infinite: nothing is known.
  double error_bound = 0;
  bool finished = true;  ///< false: a limit was reached before the tolerance (or the exact answer) was
  std::optional<Separation> separation;  ///< if requested, separate, and not nearer than rounding
  Counters counters;
};

/// FNV-1a 64 over the pairs, each as u32 a, u32 b little-endian; cbf29ce484222325 for none.
std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs);

/// Memory that a query needs and the next one can use again. One per thread.
class QueryContext;

/// Body `a` at pose_a against body `b` at pose_b; both 3D or both 2D (else InputError). Poses must be finite,
/// and so must be the world coordinates of every vertex (else InputError, naming it).
template <class Probe>
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, QueryContext& context, Probe& probe);

/// The same without a probe, and with a context of its own.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request = {});

}  // namespace lrb
