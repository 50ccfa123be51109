#pragma once
/// Finds poses at which two bodies are some way apart, or in each other.

#include <cstdint>

#include "engine/query/collide.hpp"
#include "engine/query/walk/query_context.hpp"
#include "scenarios/bodies/shapes/random_pose.hpp"

namespace lrb::bench {

struct Approach {
  Pose pose;                           ///< of B; A's moves nothing
  Eigen::Vector3d direction{0, 0, 1};  ///< from A to B: the one that B came along
};

/// Turns B at random, and moves it along random directions until it first meets A, and on.
class Approaches {
 public:
  /// Keeps references to the bodies. `diagonal`: of the larger one.
  Approaches(const LrbRep& a, const LrbRep& b, double diagonal, std::uint64_t seed);

  /// Returns the next one, `depth` diagonals beyond first contact; negative: apart.
  Approach next(double depth);

 private:
  bool meets(const Pose& pose_b);

  const LrbRep &a_, &b_;
  double diagonal_;
  shapes::RandomEngine random_;
  QueryContext context_;
  CollideRequest request_;
};

}  // namespace lrb::bench
