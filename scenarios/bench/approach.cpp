#include "scenarios/bench/approach.hpp"

#include "engine/query/collide_impl.hpp"
#include "scenarios/bench/first_meeting.hpp"

namespace lrb::bench {

Approaches::Approaches(const LrbRep& a, const LrbRep& b, double diagonal, std::uint64_t seed)
    : a_(a), b_(b), diagonal_(diagonal), random_(seed) {
  request_.mode = Mode::first_pair;
}

bool Approaches::meets(const Pose& pose_b) {
  NullProbe probe;
  return !collide(a_, Pose{}, b_, pose_b, request_, context_, probe).pairs.empty();
}

Approach Approaches::next(double depth) {
  while (true) {
    Approach out;
    out.pose.r = shapes::random_rotation(random_);
    out.direction = shapes::random_direction(random_);
    const Eigen::Vector3d middle = shapes::box_of(a_).center() - out.pose.r * shapes::box_of(b_).center();
    const auto meets_at = [&](double s) {
      out.pose.t = middle + s * out.direction;
      return meets(out.pose);
    };
    const auto at = first_meeting(2 * diagonal_, 0, 0.004 * diagonal_, meets_at);
    if (!at) continue;
    out.pose.t = middle + (*at - depth * diagonal_) * out.direction;
    return out;
  }
}

}  // namespace lrb::bench
