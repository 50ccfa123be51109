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

  /// Limits on the effort. With any of these three the answer may be about wrappers instead of the bodies,
  /// and says so (CollideResult::error_bound). It never calls bodies separate that meet. Only for `complete`,
  /// without contacts, interiors_overlap or unregularised wrappers (else InputError). What a body needs for
  /// this is made when it is first asked for, and kept in the context; that time is not counted.
  double tolerance = 0;         ///< regions no thicker than this are not refined; unit: the meshes'
  std::uint64_t max_tests = 0;  ///< largest number of face tests; 0: no limit
  double max_time = 0;          ///< longest time in seconds, checked every few face tests; 0: no limit
  /// For separate bodies: finds CollideResult::separation. Takes longer than the query.
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
