#pragma once
/// Watching a query from outside the engine: derive from CollideProbe, override what is of interest, and give
/// it to collide(). The answer is the same as without; each event costs a virtual call.

#include <cstdint>

#include "engine/query/collide.hpp"

namespace lrb {

class CollideProbe {
 public:
  virtual ~CollideProbe() = default;
  /// A simplex of A was compared exactly with one of B. depth_a, depth_b: number of regions between each and
  /// the outside.
  virtual void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a,
                         std::uint32_t depth_b);
  /// A region of a body's wrapper was refined, which brought in as many faces. After a face test that hit,
  /// that test is the cause.
  virtual void refine(Side side, RegionId region, std::uint32_t faces_added);
  /// A region was taken back in: a coarse query has asked the bodies for a first pair and goes on with wrappers.
  virtual void coarsen(Side side, RegionId region, std::uint32_t faces_removed);
  /// Two simplices meet: part of the answer. They are real, but for coarse queries.
  virtual void contact(SimplexId a, SimplexId b, exact::Meet meet);
};

/// Does what collide() in collide.hpp does, and tells the probe everything that happens, in order. What the
/// probe throws ends the query.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, CollideProbe& probe);

}  // namespace lrb
