#pragma once
/// Watching a query from outside the engine: derive from CollideProbe, override what is of interest, and give
/// it to collide(). The answer is the same as without; each event costs a virtual call.

#include <cstdint>

#include "engine/query/collide.hpp"
#include "engine/query/walk/watch.hpp"

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
  /// A region was taken back in: a coarse query has asked the bodies for a first pair and goes on with
  /// wrappers.
  virtual void coarsen(Side side, RegionId region, std::uint32_t faces_removed);
  /// Two simplices meet: part of the answer. They are real, but for coarse queries.
  virtual void contact(SimplexId a, SimplexId b, exact::Meet meet);

  /// Returns how much is to be told, which must not change during a query. What follows is told only from
  /// EventLevel::nodes on.
  virtual EventLevel level() const;
  /// The walk came to a pair of nodes. Returns what is to stand for it as NodeVisit::parent of pairs beneath
  /// it.
  virtual std::uint32_t node_pair(const NodeVisit& visit);
  /// Told at EventLevel::all: the plane of the simplex of `whose` body parts two simplices.
  virtual void plane_test(SimplexId a, SimplexId b, Side whose);
  /// What decided the face test that was told last.
  virtual void tested_by(TestedBy how);
  /// A vertex of `whose` body was located in the other one.
  virtual void point(Side whose, VertexId v, Where where);
  /// A phase begins. walked_a, walked_b: what is walked of each body: 0 for the body, i + 1 for level i.
  virtual void begin(Phase phase, std::uint32_t walked_a, std::uint32_t walked_b);
  /// The phase that began last ends; Phase says what `count` counts.
  virtual void end(Phase phase, std::uint64_t count);
};

/// Does what collide() in collide.hpp does, and tells the probe everything that happens, in order. What the
/// probe throws ends the query.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request, CollideProbe& probe);

}  // namespace lrb
