#pragma once
/// What can be asked of two bodies.

#include <cstdint>

#include "engine/lrb/wrapper.hpp"

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
  bool contacts = false;  ///< fill CollideResult::contacts and CollideResult::regions (all_pairs)
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

}  // namespace lrb
