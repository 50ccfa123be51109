#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "engine/clash/clash_parts.hpp"
#include "engine/distance/distance_context.hpp"

namespace lrb {

/// A translation after which two bodies are separate.
struct SeparatingTranslation {
  Vector3d translation{0, 0, 0};  ///< world
  double length = 0;              ///< at least the translation's length, rounded up
};

/// Tests and proves translations of B that separate it from A. Tests use the exact any-pair query on the
/// rounded pose. Proofs add the distance query, with a margin above the rounding of the pose and of the
/// corners.
class SeparationSearch {
 public:
  SeparationSearch(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const UnitBodies& bodies);

  /// Returns true if the exact query finds the bodies separate after B's pose is translated by `s` times `n`
  /// (units).
  bool is_separated(const Vector3d& n, double s);
  /// Proves that a translation of B along n by `s` or slightly more separates it from A. Returns nullopt if
  /// the proof fails.
  std::optional<SeparatingTranslation> prove(const Vector3d& n, double s);
  /// Proves that a translation of B by exactly s n, for `s` or a slightly larger s, separates it from A.
  /// Returns that s (units), or nullopt if the proof fails.
  std::optional<double> prove_along(const Vector3d& n, double s);
  /// Returns the least of some sampled lengths along n, up to `most`, at which the bodies are separate,
  /// refined by bisection up to `resolution`, or `most` if no sample separates. Usually, but not always,
  /// finds the first separation.
  double least_separation(const Vector3d& n, double most, int samples, double resolution);
  /// Returns the number of queries.
  std::uint64_t query_count() const { return query_count_; }

 private:
  struct Moved {
    Pose pose;
    Vector3d by;  ///< the displacement, rounded once
  };
  Moved moved(const Vector3d& n, double s) const;
  bool is_proved(const Moved& m, double more);

  const LrbRep &a_, &b_;
  const Pose &pose_a_, &pose_b_;
  const UnitFrame& frame_;
  double reach_ = 0;               ///< the largest world coordinate of B
  double margin_;                  ///< kSeparationMargin, for the sizes of the bodies
  std::uint64_t query_count_ = 0;  ///< number of queries
  QueryContext query_;
  DistanceContext distance_;
};

}  // namespace lrb
