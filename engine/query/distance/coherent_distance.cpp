/// Distances along a motion. Kept from the previous step:
/// - The pair of simplices that was closest. Measured at the new poses, it gives an upper bound and the
///   direction of slabs before the traversal begins. If the surfaces intersected in it and still do, nothing
///   is traversed.
/// - The relation of the bodies. If the surfaces were disjoint, and no points can have approached by as much
///   as the distance was, they do not intersect anywhere on the path between the steps: one body contains the
///   other now if it did then.
/// - Planes that separate pairs of nodes: as long as they do, these nodes are not expanded.
/// That no other pair is closer is proven anew in each step.

#include <cmath>
#include <limits>

#include "engine/query/collide_impl.hpp"
#include "engine/query/distance/distance_impl.hpp"
#include "engine/query/distance/nearer_by.hpp"

namespace lrb {

class CoherentDistance::Work {
 public:
  Work(const LrbRep& a, const LrbRep& b, const DistanceRequest& request) : a_(a), b_(b), request_(request) {}

  DistanceResult distance(const Pose& pose_a, const Pose& pose_b) {
    const PosePair now{pose_a, pose_b};
    const bool lies_as_before = request_.relation && is_relation_kept(now);
    // A relation that is kept need not be computed.
    DistanceRequest ask = request_;
    ask.relation = request_.relation && !lies_as_before;
    DistanceResult result = lrb::distance(a_, pose_a, b_, pose_b, ask, context_, &before_);
    // Kept only if this step proves a positive distance, which an early stop may not.
    if (lies_as_before) result.relation = result.lower > 0 ? relation_ : Relation::unresolved;
    // Where the bounds of the next step begin.
    before_.likely = {result.witness[0].simplex, result.witness[1].simplex};
    apart_ = result.lower;
    relation_ = result.relation;
    poses_ = now;
    return result;
  }

 private:
  bool is_relation_kept(const PosePair& now) const {
    // Only for solids: the relation of open bodies is decided by boxes, which move with each pose. NaN or an
    // unknown distance keeps nothing.
    return a_.closed() && b_.closed() && apart_ > 0 && std::isfinite(apart_) &&
           nearer_by(a_, b_, poses_, now, apart_) < apart_;
  }

  const LrbRep &a_, &b_;
  const DistanceRequest request_;
  DistanceContext context_;
  // Of the last answer:
  KnownFromBefore before_;
  double apart_ = 0;  ///< the lower end
  Relation relation_ = Relation::undefined;
  PosePair poses_;
};

CoherentDistance::CoherentDistance(const LrbRep& a, const LrbRep& b, const DistanceRequest& request)
    : work_(std::make_unique<Work>(a, b, request)) {}
CoherentDistance::~CoherentDistance() = default;
CoherentDistance::CoherentDistance(CoherentDistance&&) noexcept = default;
CoherentDistance& CoherentDistance::operator=(CoherentDistance&&) noexcept = default;

DistanceResult CoherentDistance::distance(const Pose& pose_a, const Pose& pose_b) {
  return work_->distance(pose_a, pose_b);
}

}  // namespace lrb
