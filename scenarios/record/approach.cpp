#include "scenarios/record/approach.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::run {
namespace {

/// Returns the pose of B after `step` steps of `length`.
Pose pose_at(const spec::Motion& m, const Pose& start, double length, std::uint32_t step) {
  const double way = m.from.norm();
  const Eigen::Vector3d position = m.target + m.from * (1 - length * step / way);
  const double angle = m.degrees * step * std::numbers::pi / 180;
  return spec::then(start,
                    m.degrees == 0 ? Pose::translation(position) : Pose::rotation(m.axis, angle, position));
}

}  // namespace

double diagonal_of(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

namespace {

/// The steps of an approach. After `count` of them B is as far beyond the target as it started before it.
struct Steps {
  const spec::Motion& motion;
  const Pose& start;
  double length;
  std::uint32_t count;

  Pose pose(std::uint32_t step) const { return pose_at(motion, start, length, step); }

  /// Returns the whole motion, from 0 to 1.
  Motion whole() const {
    Motion::Piece piece;
    piece.first = start;
    piece.turn = motion.axis.normalized() * (motion.degrees * count * std::numbers::pi / 180);
    piece.from = motion.target + motion.from;
    piece.to = motion.target + motion.from * (1 - length * count / motion.from.norm());
    return Motion(std::vector<Motion::Piece>{piece});
  }
};

/// Sets the time of first contact in steps of the poses; pose number `at` is `after` steps after the motion's
/// start.
void number_contact(const Steps& steps, double at, double after, trace::MeasuredApproach& search) {
  if (search.outcome != MotionOutcome::contact) return;
  const auto step_of = [&](double t) { return at + (t * steps.count - after); };
  search.step = {step_of(search.t0), step_of(search.t1)};
  search.length = {(*search.step)[0] * steps.length, (*search.step)[1] * steps.length};
}

/// Sets the poses at whole steps, given the first step after which contact is possible.
void find_step(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Steps& steps, std::uint32_t from,
               Approach& out) {
  CollideRequest request;
  request.mode = Mode::first_pair;
  Workspace workspace;
  for (std::uint32_t step = from; step <= steps.count && !out.met; ++step) {
    const Relation r = collide(a, pose_a, b, steps.pose(step), request, workspace).value().relation;
    if (r == Relation::separate || r == Relation::undefined) continue;
    out.met = true;
    const std::uint32_t first = step - std::min(step, steps.motion.before);
    out.first_contact = step - first;
    number_contact(steps, 0, first, out.search);
    for (std::uint32_t s = first; s <= step + steps.motion.into; ++s) out.poses.push_back(steps.pose(s));
  }
}

/// Sets the poses at whole steps before and after the first contact.
void stand_at_contact(const Steps& steps, double t, Approach& out) {
  out.met = true;
  const Motion whole = steps.whole();
  const auto before = std::min(steps.motion.before, static_cast<std::uint32_t>(t * steps.count));
  out.first_contact = before;
  number_contact(steps, before, t * steps.count, out.search);
  for (std::uint32_t i = 0; i <= before + steps.motion.into; ++i) {
    const double step = static_cast<double>(i) - before;
    out.poses.push_back(whole.at(step == 0 ? t : std::max(0.0, t + step / steps.count)));
  }
}

}  // namespace

Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion, bool watched) {
  const double length = motion.step_length * (diagonal_of(a) + diagonal_of(b));
  // After twice the distance, B is as far beyond the target as it started before it.
  const auto whole_way =
      static_cast<std::uint32_t>(std::min<double>(motion.steps, std::ceil(2 * motion.from.norm() / length)));
  const Steps steps{motion, start, length, whole_way};
  FirstContactRequest request;
  request.max_steps = 200'000;
  FirstContactHistory reported;
  const FirstContactResult found =
      watched ? first_contact(a, Motion::still(pose_a), b, steps.whole(), request, reported)
              : first_contact(a, Motion::still(pose_a), b, steps.whole(), request);
  Approach out;
  out.search = trace::measured(found, std::move(reported.history));
  const bool inside = found.at_begin == Relation::a_inside_b || found.at_begin == Relation::b_inside_a;
  if (!(motion.exact && found.is_contact() && !found.passed) || inside) {
    const auto from = static_cast<std::uint32_t>(found.t0 * whole_way);
    if (inside || found.outcome != MotionOutcome::never)
      find_step(a, pose_a, b, steps, inside || from == 0 ? 0 : from - 1, out);
  }
  if (!out.met && found.is_contact()) stand_at_contact(steps, found.t1, out);
  if (!out.met) {
    const std::uint32_t wanted = motion.before + motion.into + 1;
    const std::uint32_t stride = std::max(1u, whole_way / wanted);
    for (std::uint32_t s = 0; s <= whole_way; s += stride) out.poses.push_back(steps.pose(s));
  }
  return out;
}

std::string contact_step(const trace::MeasuredApproach& search) {
  if (!search.step) return {};
  const double step = (*search.step)[1];
  constexpr int kDecimals = 2;
  return step < 0 ? io::fixed_text(-step, kDecimals) + " steps before step 0"
                  : "step " + io::fixed_text(step, kDecimals);
}

std::string contact_way(const trace::MeasuredApproach& search) {
  if (!search.length) return {};
  const double length = (*search.length)[1];
  return length < 0 ? "B moves " + io::number_text(-length) + " from there until step 0"
                    : "after B has moved " + io::number_text(length) + " from step 0";
}

}  // namespace lrb::run
