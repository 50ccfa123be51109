#pragma once

#include "engine/query/batch/workspace.hpp"
#include "engine/query/distance/distance_impl.hpp"

namespace lrb {

struct Workspace::Memory {
  DistanceContext context;  ///< its QueryContext serves collide(), too
  CollideResult result;
};

/// Answers into `answer`, whose memory is used again.
void collide_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const CollideRequest& request, QueryContext& context, Expected<CollideResult>& answer);

}  // namespace lrb
