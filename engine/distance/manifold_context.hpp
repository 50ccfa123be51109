#pragma once
/// Contact manifolds with buffers that later queries reuse. Internal: users of the installed engine include
/// contact_manifold.hpp.

#include "engine/distance/manifold_points.hpp"
#include "engine/distance/near_pairs_context.hpp"
#include <lrbscope/contact_manifold.hpp>

namespace lrb {

struct ManifoldContext {
  NearPairsResult near;
  VertexStars stars[2];  ///< of A and of B
};

/// Finds the manifolds as contact_manifolds() does. `query`, `near`, `context`: buffers. `result`:
/// overwritten; must not be `previous`.
void contact_manifolds_into(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                            const ManifoldRequest& request, const ManifoldResult* previous, Workers& workers,
                            QueryContext& query, NearPairsContext& near, ManifoldContext& context,
                            ManifoldResult& result);

}  // namespace lrb
