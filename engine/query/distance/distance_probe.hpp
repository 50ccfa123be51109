#pragma once
/// Watching how the bounds of a distance tighten, from outside the engine: derive from BoundsProbe and give
/// it to distance(). The answer is the same as without; what is told costs a look at all pairs that wait.

#include <cstdint>
#include <vector>

#include "engine/query/distance/distance.hpp"

namespace lrb {

/// What is known of a number after some work.
struct Bounds {
  std::uint64_t work = 0;       ///< done until then, in steps that the query names
  double lower = 0, upper = 0;  ///< hold the number; `upper` is infinite where none is known yet
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

class BoundsProbe {
 public:
  virtual ~BoundsProbe() = default;
  /// Bounds became narrower: in the order of the work.
  virtual void bounds(const Bounds& known) = 0;
};

/// Keeps what it is told.
class BoundsCourse final : public BoundsProbe {
 public:
  void bounds(const Bounds& known) override { course.push_back(known); }
  std::vector<Bounds> course;
};

/// Does what distance() in distance.hpp does, and tells the probe what is known, after more and more work:
/// the last bounds lie within those of the answer, and are the answer's unless `within` or a tolerance asks
/// for less. Work is counted in pairs of nodes opened and pairs of simplices measured in doubles or exactly.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, BoundsProbe& probe);

}  // namespace lrb
