#pragma once
/// Translations of B that part two bodies, proved by the exact query.

#include <optional>

#include "engine/query/clash/unit_bodies.hpp"
#include "engine/query/distance/distance_impl.hpp"

namespace lrb::parting {

/// A translation after which two bodies are apart.
struct PartingMove {
  Vector3d translation{0, 0, 0};  ///< world
  double length = 0;              ///< at least the translation's, rounded up
};

class Parting {
 public:
  Parting(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, const UnitBodies& bodies);

  /// Returns true if the bodies are apart, as the exact query sees them, once B's pose is moved by `s` times
  /// `n` (units).
  bool is_apart(const Vector3d& n, double s);
  /// Proves that B moved along n by `s` or little more is apart from A. Returns nothing if it cannot.
  std::optional<PartingMove> prove(const Vector3d& n, double s);
  /// Proves that B moved along n by exactly `s` n is apart from A, or by little more: returns that s (units).
  std::optional<double> prove_along(const Vector3d& n, double s);
  /// Returns the least of some distances along n, up to `most`, at which the bodies are apart, narrowed down
  /// to where they just met; `most` if it is none of them. Finds the way out that is nearest in general, not
  /// always.
  double least_apart(const Vector3d& n, double most, int samples);
  /// Returns how many queries were asked.
  std::uint64_t asked() const { return asked_; }

 private:
  struct Moved {
    Pose pose;
    Vector3d by;  ///< what it is moved by, rounded once
  };
  Moved moved(const Vector3d& n, double s) const;
  bool is_proved(const Moved& m, double more);

  const LrbRep &a_, &b_;
  const Pose &pose_a_, &pose_b_;
  const UnitFrame& frame_;
  double reach_ = 0;         ///< the largest world coordinate of B
  std::uint64_t asked_ = 0;  ///< queries
  QueryContext query_;
  DistanceContext distance_;
};

}  // namespace lrb::parting
