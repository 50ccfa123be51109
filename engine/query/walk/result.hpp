#pragma once
/// The result: what a query answers, and how much work it took.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/enum_words.hpp"
#include "engine/query/walk/contact_region.hpp"
#include "engine/query/walk/request.hpp"

namespace lrb {

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

}  // namespace lrb
