/// What is kept is the pair of simplices that was nearest: measured where the bodies are now, it gives an
/// upper end, and the direction for slabs, before the walk begins. All else is proved anew.

#include "engine/query/collide_impl.hpp"
#include "engine/query/distance/distance_impl.hpp"

namespace lrb {

class CoherentDistance::Work {
 public:
  Work(const LrbRep& a, const LrbRep& b, const DistanceRequest& request) : a_(a), b_(b), request_(request) {}

  DistanceResult distance(const Pose& pose_a, const Pose& pose_b) {
    const DistanceResult result = lrb::distance(a_, pose_a, b_, pose_b, request_, context_, &last_);
    last_ = {result.witness[0].simplex, result.witness[1].simplex};
    return result;
  }

 private:
  const LrbRep &a_, &b_;
  const DistanceRequest request_;
  DistanceContext context_;
  std::array<SimplexId, 2> last_ = {kNull, kNull};  ///< the witness
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
