#include <algorithm>
#include <limits>

#include "bench/methods/triangles.hpp"
#include "bench/quantities/number_method.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>

namespace lrb::stability {
namespace {

using methods::Stopwatch;

Motion motion_of(const NumberQuery& q) {
  return Motion::linear(Pose::translation(q.from), q.to);
}

NumberAnswer answer_of(const NumberQuery& q, DistanceRequest request) {
  request.relation = false;
  const Stopwatch watch;
  const DistanceResult r = distance(q.a, Pose{}, q.b, Pose{}, request);
  const double us = watch.microseconds();
  // Only a lower bound may be known; records contain finite numbers.
  return {r.lower, std::min(r.upper, std::numeric_limits<double>::max()), us};
}

NumberAnswer our_distance(const NumberQuery& q, Setting tolerance) {
  DistanceRequest request;
  request.tolerance = tolerance.value_or(0) * q.size;
  return answer_of(q, request);
}

NumberAnswer distance_in_steps(const NumberQuery& q, Setting steps) {
  DistanceRequest request;
  request.max_steps = static_cast<std::uint64_t>(steps.value_or(100));
  return answer_of(q, request);
}

NumberAnswer within(const NumberQuery& q, Setting share) {
  DistanceRequest request;
  request.within = share.value_or(0.05) * q.size;
  return answer_of(q, request);
}

NumberAnswer our_first_contact(const NumberQuery& q, Setting tolerance) {
  FirstContactRequest request;
  request.relation = false;
  if (tolerance) request.tolerance = *tolerance;
  const Stopwatch watch;
  const FirstContactResult r = first_contact(q.a, Motion::still({}), q.b, motion_of(q), request);
  const double us = watch.microseconds();
  if (r.outcome == MotionOutcome::undecided)
    throw InputError("undecided, as reported by the method: closer than rounding errors");
  if (r.outcome == MotionOutcome::never) return {kNever, kNever, us};
  return {r.t0, r.t1, us};
}

NumberAnswer our_depth(const NumberQuery& q, Setting) {
  ClashRequest request;
  request.volume = false;
  const Stopwatch watch;
  const ClashResult r = clash(q.a, Pose{}, q.b, Pose{}, request);
  const double us = watch.microseconds();
  if (!r.depth) throw InputError("undecided, as reported by the method: not a closed solid");
  return {r.depth->lower, r.depth->upper, us};
}

/// Runs the exact query at n + 1 equally spaced times.
NumberAnswer sampled(const NumberQuery& q, int n) {
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

NumberMethod ours(Quantity quantity, const char* title, NumberAnswer (*ask)(const NumberQuery&, Setting)) {
  NumberMethod m;
  m.info.name = "ours";
  m.info.title = title;
  m.info.remark = "An interval that must contain the number.";
  m.info.role = methods::Role::ours;
  m.info.style = {"lrbscope", "#0072b2", "circle"};
  m.quantity = quantity;
  m.proves = true;
  m.ask = ask;
  return m;
}

/// Returns a method of lrbscope that computes less than the narrowest interval. For charts only.
NumberMethod less(const char* name, const char* title, const char* remark, methods::MethodStyle style,
                  NumberAnswer (*ask)(const NumberQuery&, Setting)) {
  NumberMethod m = ours(Quantity::distance, title, ask);
  m.info.name = name;
  m.info.remark = remark;
  m.info.role = methods::Role::ours_other;
  m.info.traits.set(methods::Trait::hard_cases, false);
  m.info.style = std::move(style);
  return m;
}

NumberMethod sampled_method(int n) {
  constexpr int kTooFewForHardCases = 10;
  NumberMethod m;
  m.info.name = "sampled-" + std::to_string(n);
  m.info.title = "exact query, " + std::to_string(n) + " steps";
  m.info.remark =
      "lrbscope's exact query at equally spaced times; returns the first at which the bodies collide.";
  m.info.traits.set(methods::Trait::hard_cases, n > kTooFewForHardCases);
  m.info.style = {"exact query at 10, 100, 1000 times", "#6b6b6b", "crossRot"};
  m.quantity = Quantity::first_contact;
  m.ask = [n](const NumberQuery& q, Setting) { return sampled(q, n); };
  return m;
}

}  // namespace

std::vector<NumberMethod> own_number_methods() {
  return {with_parameter(ours(Quantity::distance, "lrbscope, distance", our_distance), "tolerance",
                         {0.1, 0.01, 1e-3, 1e-6, 0}),
          with_parameter(less("ours-budget", "lrbscope, distance in N steps",
                              "The interval after N steps (pairs of nodes expanded).",
                              {"lrbscope, within a budget", "#56b4e9", "rect"}, distance_in_steps),
                         "steps", {3, 10, 30, 100, 300}),
          with_parameter(less("ours-within", "lrbscope, within 5 % of the diagonal?",
                              "A proven yes or no; the interval is the bound known by then.",
                              {"lrbscope, yes or no: within a distance?", "#0072b2", "rectRounded"}, within),
                         "within", {0.05}),
          with_parameter(ours(Quantity::first_contact, "lrbscope, first contact", our_first_contact),
                         "tolerance", {1e-6, 1e-9, 1e-12}),
          ours(Quantity::depth, "lrbscope, clash", our_depth),
          sampled_method(10),
          sampled_method(100),
          sampled_method(1000)};
}

}  // namespace lrb::stability
