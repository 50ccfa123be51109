#pragma once
/// Watching a clash query, from outside the engine: derive from ClashProbe and give it to clash(). The answer
/// is the same as without.

#include <vector>

#include "engine/query/clash/clash.hpp"
#include "engine/query/distance/distance_probe.hpp"

namespace lrb {

class ClashProbe {
 public:
  virtual ~ClashProbe() = default;
  /// Bounds of the distance of bodies without a point in common became narrower; work as for a distance.
  virtual void distance(const Bounds& known) = 0;
  /// Bounds of the depth of bodies whose interiors overlap: the lower end is proved, the upper one is the
  /// shortest way out that was found so far, infinite at first, which only the last bounds, those of the
  /// answer, have proved. Work is counted in queries that were asked and steps in which hulls grew.
  virtual void depth(const Bounds& known) = 0;
};

/// Keeps what it is told.
class ClashCourse final : public ClashProbe {
 public:
  void distance(const Bounds& known) override { of_distance.push_back(known); }
  void depth(const Bounds& known) override { of_depth.push_back(known); }
  std::vector<Bounds> of_distance, of_depth;
};

/// Does what clash() in clash.hpp does, and tells the probe what is known, after more and more work.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, ClashProbe& probe);

}  // namespace lrb
