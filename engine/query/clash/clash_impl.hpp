#pragma once
/// One clash query, with memory that later queries reuse. Internal: users of the installed engine include
/// clash.hpp.

#include "engine/query/clash/clash_probe.hpp"
#include "engine/query/distance/distance_impl.hpp"

namespace lrb {

/// Memory of a query; one for each thread.
struct ClashContext {
  QueryContext query;
  DistanceContext distance;
};

/// Answers as clash() in clash.hpp does. probe: null, or notified of bounds.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, ClashContext& context, ClashProbe* probe = nullptr);

/// Throws InputError if a request cannot be answered.
void check_request(const LrbRep& a, const ClashRequest& request);

}  // namespace lrb
