#include "engine/core/error.hpp"
#include "engine/query/clash/clash.hpp"
#include "engine/query/distance/distance.hpp"
#include "engine/query/motion/first_contact.hpp"
#include "scenarios/methods/body_parts.hpp"
#include "scenarios/stability/quantities/number_method.hpp"

namespace lrb::stability {
namespace {

using methods::Stopwatch;

Motion motion_of(const Asked& q) {
  return Motion::linear(Pose::translation(q.from), q.to);
}

NumberAnswer our_distance(const Asked& q) {
  DistanceRequest request;
  request.relation = false;
  const Stopwatch watch;
  const DistanceResult r = distance(q.a, Pose{}, q.b, Pose{}, request);
  return {r.lower, r.upper, watch.microseconds()};
}

NumberAnswer our_first_contact(const Asked& q) {
  FirstContactRequest request;
  request.relation = false;
  const Stopwatch watch;
  const FirstContactResult r = first_contact(q.a, Motion::still({}), q.b, motion_of(q), request);
  const double us = watch.microseconds();
  if (r.outcome == MotionOutcome::undecided) throw InputError("as near as rounding: it says so");
  if (r.outcome == MotionOutcome::never) return {kNever, kNever, us};
  return {r.t0, r.t1, us};
}

NumberAnswer our_depth(const Asked& q) {
  ClashRequest request;
  request.volume = false;
  const Stopwatch watch;
  const ClashResult r = clash(q.a, Pose{}, q.b, Pose{}, request);
  const double us = watch.microseconds();
  if (!r.depth) throw InputError("a body that bounds no solid: it says so");
  return {r.depth->lower, r.depth->upper, us};
}

/// Asks the exact query at n + 1 equal times.
NumberAnswer sampled(const Asked& q, int n) {
  const Motion motion = motion_of(q);
  CollideRequest any;
  any.mode = Mode::any_pair;
  const Stopwatch watch;
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    if (!collide(q.a, Pose{}, q.b, motion.at(t), any).pairs.empty()) return {t, t, watch.microseconds()};
  }
  return {kNever, kNever, watch.microseconds()};
}

NumberMethod ours(Quantity quantity, const char* title, NumberAnswer (*ask)(const Asked&)) {
  NumberMethod m;
  m.info.name = "ours";
  m.info.title = title;
  m.info.remark = "An interval, which is to hold the number.";
  m.info.role = methods::Role::ours;
  m.quantity = quantity;
  m.proves = true;
  m.ask = ask;
  return m;
}

NumberMethod sampled_method(int n) {
  NumberMethod m;
  m.info.name = "sampled-" + std::to_string(n);
  m.info.title = "exact query, " + std::to_string(n) + " steps";
  m.info.remark = "Our exact query at equal times; says the first at which bodies meet.";
  m.quantity = Quantity::first_contact;
  m.ask = [n](const Asked& q) { return sampled(q, n); };
  return m;
}

}  // namespace

std::vector<NumberMethod> own_number_methods() {
  return {ours(Quantity::distance, "lrbscope, distance", our_distance),
          ours(Quantity::first_contact, "lrbscope, first contact", our_first_contact),
          ours(Quantity::depth, "lrbscope, clash", our_depth), sampled_method(100), sampled_method(1000)};
}

}  // namespace lrb::stability
