/// What is kept from the last step:
/// - the pair of simplices that was nearest. Measured where the bodies are now, it gives an upper end, and
///   the direction for slabs, before the walk begins. If the surfaces met in it and still do, there is no
///   walk.
/// - how the bodies lie. If the surfaces did not meet, and nothing can have come as much nearer since as they
///   were apart, they do not meet on the way from there to here either: then one holds the other now if it
///   did before.
/// - planes that hold pairs of nodes apart: as long as they do, what lies under the nodes is not looked at.
/// That no other pair is nearer is proved anew.

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
    DistanceRequest ask = request_;
    ask.relation = request_.relation && !lies_as_before;
    DistanceResult result = lrb::distance(a_, pose_a, b_, pose_b, ask, context_, &before_);
    // What is proved apart is apart; only a walk that stopped early has not found that out.
    if (lies_as_before) result.relation = result.lower > 0 ? relation_ : Relation::unresolved;
    before_.likely = {result.witness[0].simplex, result.witness[1].simplex};
    apart_ = result.lower;
    relation_ = result.relation;
    poses_ = now;
    return result;
  }

 private:
  bool is_relation_kept(const PosePair& now) const {
    // Boxes, which decide where a body is no solid, move with each pose.
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
