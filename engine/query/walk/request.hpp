#pragma once
/// The request: what can be asked about two bodies.

#include <cstdint>

#include "engine/lrb/wrapper.hpp"

namespace lrb {

enum class Mode : std::uint8_t {
  all_pairs,
  first_pair,  ///< finds one pair that crosses, if there is one; the relation is exact
  /// Finds out whether the surfaces meet. The first pair that does ends the query, and Relation::touching
  /// then says no more than that this pair touches: others may cross.
  any_pair,
};

enum class Recursion : std::uint8_t {
  complete,
  paper,         ///< each pair of regions is recursed into once
  paper_strict,  ///< each region is refined once; its new faces meet only the new faces of what it hit
};

const char* to_string(Recursion r);

enum class Predicates : std::uint8_t {
  exact,
  /// Without the exact fallback: the answer can be wrong; exists to measure what exactness costs and saves.
  floating,
};

struct CollideRequest {
  Mode mode = Mode::all_pairs;
  Recursion recursion = Recursion::complete;
  Predicates predicates = Predicates::exact;  ///< for pairs and relation; contacts are always exact
  WrapperMode wrapper = WrapperMode::regularised;
  bool contacts = false;  ///< fill CollideResult::contacts and ::regions (all_pairs only)
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

  bool is_coarse() const { return tolerance > 0 || max_tests > 0 || max_time > 0; }
};

}  // namespace lrb
