#include "scenarios/spec/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "scenarios/bodies/shapes.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/random.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::spec {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Equal to v.norm(), unless squares of coordinates overflow or underflow.
double length_of(const Eigen::Vector3d& v) {
  int exponent = 0;
  std::frexp(v.cwiseAbs().maxCoeff(), &exponent);
  return std::ldexp(deterministic::scaled_direction(v).norm(), exponent);
}

constexpr double kFar = 1e150;  // coordinates whose squares are still finite

Eigen::Vector3d read_axis(const io::JsonNode& node) {
  const Eigen::Vector3d axis = node.vector();
  if (axis.isZero(0)) node.fail("expected a direction other than zero");
  return axis;
}

double read_degrees(const io::JsonNode& node) {
  return node.number(-kFar, kFar);
}

std::uint32_t read_steps(const io::JsonNode& node, const char* key, std::uint32_t fallback,
                         std::uint32_t least) {
  const auto n = node.get(key);
  return n ? static_cast<std::uint32_t>(n->integer(least, kMaxSteps)) : fallback;
}

std::vector<Motion::Keyframe> read_keyframes(const io::JsonNode& node) {
  std::vector<Motion::Keyframe> out;
  for (const io::JsonNode& item : node.items(1)) {
    item.object({"step", "position", "axis", "degrees"});
    Motion::Keyframe k;
    k.step = static_cast<std::uint32_t>(item.at("step").integer(0, kMaxSteps));
    if (out.empty() ? k.step != 0 : k.step <= out.back().step)
      item.at("step").fail(out.empty() ? "expected the first keyframe at step 0"
                                       : "expected keyframes in ascending order of their steps");
    k.position = item.at("position").vector();
    if (const auto n = item.get("axis")) k.axis = read_axis(*n);
    if (const auto n = item.get("degrees")) k.degrees = read_degrees(*n);
    out.push_back(k);
  }
  return out;
}

void read_turn(const io::JsonNode& node, Motion& m) {
  if (const auto n = node.get("axis")) m.axis = read_axis(*n);
  if (const auto n = node.get("degrees")) m.degrees = read_degrees(*n);
}

void read_approach(const io::JsonNode& node, Motion& m) {
  node.object(
      {"kind", "from", "target", "step_length", "axis", "degrees", "before", "into", "most_steps", "exact"});
  m.from = node.at("from").vector();
  if (m.from.isZero(0)) node.at("from").fail("expected a direction other than zero");
  if (const auto n = node.get("target")) m.target = n->vector();
  constexpr double kShortest = 1e-6;  // as a share of the bodies' diagonals: a million steps across
  if (const auto n = node.get("step_length")) m.step_length = n->number(kShortest, 1);
  read_turn(node, m);
  m.before = read_steps(node, "before", m.before, 0);
  m.into = read_steps(node, "into", m.into, 0);
  m.steps = read_steps(node, "most_steps", 10'000, 1);
  if (const auto n = node.get("exact")) m.exact = n->boolean();
}

Pose turned(const Eigen::Vector3d& axis, double degrees, const Eigen::Vector3d& position) {
  return degrees == 0 ? Pose::translation(position) : Pose::rotation(axis, degrees * kDegree, position);
}

std::vector<Pose> keyframe_poses(const std::vector<Motion::Keyframe>& keys) {
  std::vector<Pose> out = {turned(keys[0].axis, keys[0].degrees, keys[0].position)};
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const std::uint32_t span = keys[i].step - keys[i - 1].step;
    for (std::uint32_t s = 1; s <= span; ++s) {
      const double t = static_cast<double>(s) / span;
      const Motion::Keyframe &a = keys[i - 1], &b = keys[i];
      out.push_back({deterministic::rotation_between(
                         deterministic::scaled_direction(a.axis).normalized(), a.degrees * kDegree,
                         deterministic::scaled_direction(b.axis).normalized(), b.degrees * kDegree, t),
                     a.position + t * (b.position - a.position)});
    }
  }
  return out;
}

}  // namespace

Pose then(const Pose& first, const Pose& second) {
  return {second.r * first.r, second.r * first.t + second.t};
}

Pose read_pose(const io::JsonNode& node) {
  if (node.is_array()) {
    const std::vector<double> x = node.numbers(12);
    return io::pose_of(std::span<const double, 12>(x.data(), 12));
  }
  node.object({"position", "axis", "degrees"});
  Eigen::Vector3d position(0, 0, 0), axis(0, 0, 1);
  if (const auto n = node.get("position")) position = n->vector();
  if (const auto n = node.get("axis")) axis = read_axis(*n);
  const auto degrees = node.get("degrees");
  return turned(axis, degrees ? read_degrees(*degrees) : 0, position);
}

Motion read_motion(const io::JsonNode& node) {
  using Kind = Motion::Kind;
  Motion m;
  m.kind = node.at("kind").choice<Kind>();
  switch (m.kind) {
    case Kind::poses:
      node.object({"kind", "poses"});
      for (const io::JsonNode& item : node.at("poses").items(1)) m.poses.push_back(read_pose(item));
      break;
    case Kind::keyframes:
      node.object({"kind", "keyframes"});
      m.keyframes = read_keyframes(node.at("keyframes"));
      break;
    case Kind::sweep:
      node.object({"kind", "from", "to", "axis", "degrees", "steps"});
      m.from = node.at("from").vector();
      m.to = node.at("to").vector();
      read_turn(node, m);
      m.steps = read_steps(node, "steps", 30, 1);
      break;
    case Kind::approach:
      read_approach(node, m);
      break;
    case Kind::spin:
      node.object({"kind", "axis", "degrees", "steps"});
      m.degrees = 360;
      read_turn(node, m);
      m.steps = read_steps(node, "steps", 36, 1);
      break;
  }
  return m;
}

std::vector<Pose> poses_of(const Motion& motion, const Pose& start) {
  std::vector<Pose> moves;
  switch (motion.kind) {
    case Motion::Kind::poses:
      moves = motion.poses;
      break;
    case Motion::Kind::keyframes:
      moves = keyframe_poses(motion.keyframes);
      break;
    case Motion::Kind::sweep:
      for (std::uint32_t i = 0; i < motion.steps; ++i) {
        const double t = motion.steps == 1 ? 0 : static_cast<double>(i) / (motion.steps - 1);
        moves.push_back(turned(motion.axis, motion.degrees * t, motion.from + t * (motion.to - motion.from)));
      }
      break;
    case Motion::Kind::spin:
      for (std::uint32_t i = 0; i < motion.steps; ++i)
        moves.push_back(turned(motion.axis, motion.degrees * i / motion.steps, {0, 0, 0}));
      break;
    case Motion::Kind::approach:
      break;
  }
  for (Pose& move : moves) move = then(start, move);
  return moves;
}

namespace {

/// The steps of an approach. After `count` of them B is as far beyond the target as it started before it.
struct Steps {
  const Motion& motion;
  const Pose& start;
  double length;
  std::uint32_t count;

  /// Returns the pose of B after `step` steps.
  Pose pose(std::uint32_t step) const {
    const Eigen::Vector3d position =
        motion.target + motion.from * (1 - length * step / length_of(motion.from));
    const double angle = motion.degrees * step * std::numbers::pi / 180;
    return then(start, motion.degrees == 0 ? Pose::translation(position)
                                           : Pose::rotation(motion.axis, angle, position));
  }

  /// Returns the whole motion, from 0 to 1.
  lrb::Motion whole() const {
    lrb::Motion::Piece piece;
    piece.first = start;
    piece.turn = deterministic::scaled_direction(motion.axis).normalized() *
                 (motion.degrees * count * std::numbers::pi / 180);
    piece.from = motion.target + motion.from;
    piece.to = motion.target + motion.from * (1 - length * count / length_of(motion.from));
    return lrb::Motion(std::vector<lrb::Motion::Piece>{piece});
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
  const lrb::Motion whole = steps.whole();
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
                       const Motion& motion, bool watched) {
  const double length =
      motion.step_length * (shapes::box_of(a).diagonal().norm() + shapes::box_of(b).diagonal().norm());
  // After twice the distance, B is as far beyond the target as it started before it.
  const auto whole_way = static_cast<std::uint32_t>(
      std::min<double>(motion.steps, std::ceil(2 * length_of(motion.from) / length)));
  const Steps steps{motion, start, length, whole_way};
  FirstContactRequest request;
  request.max_steps = 200'000;
  FirstContactHistory reported;
  const FirstContactResult found =
      watched ? first_contact(a, lrb::Motion::still(pose_a), b, steps.whole(), request, reported)
              : first_contact(a, lrb::Motion::still(pose_a), b, steps.whole(), request);
  Approach out;
  out.search = trace::measured(found, std::move(reported.history));
  const bool inside = is_inside(found.at_begin);
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

}  // namespace lrb::spec
