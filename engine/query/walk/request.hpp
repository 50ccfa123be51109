#pragma once
/// The request: what can be asked about two bodies.

#include <cstdint>

#include "engine/core/enum_words.hpp"
#include "engine/lrb/wrapper.hpp"

namespace lrb {

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

}  // namespace lrb
