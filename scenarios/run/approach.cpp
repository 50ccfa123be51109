#include "scenarios/run/approach.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "engine/query/collide_impl.hpp"
#include "scenarios/spec/scenario_motion.hpp"

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

Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion) {
  const double length = motion.step_length * (diagonal_of(a) + diagonal_of(b));
  // Beyond twice the distance, B is as far behind the target as it was before it.
  const auto whole_way =
      static_cast<std::uint32_t>(std::min<double>(motion.steps, std::ceil(2 * motion.from.norm() / length)));
  CollideRequest request;
  request.mode = Mode::first_pair;
  QueryContext context;
  NullProbe probe;
  Approach out;
  for (std::uint32_t step = 0; step <= whole_way && !out.met; ++step) {
    const Relation r =
        collide(a, pose_a, b, pose_at(motion, start, length, step), request, context, probe).relation;
    if (r == Relation::separate || r == Relation::undefined) continue;
    out.met = true;
    const std::uint32_t first = step - std::min(step, motion.before);
    out.first_contact = step - first;
    for (std::uint32_t s = first; s <= step + motion.into; ++s)
      out.poses.push_back(pose_at(motion, start, length, s));
  }
  if (!out.met) {
    const std::uint32_t wanted = motion.before + motion.into + 1;
    const std::uint32_t stride = std::max(1u, whole_way / wanted);
    for (std::uint32_t s = 0; s <= whole_way; s += stride)
      out.poses.push_back(pose_at(motion, start, length, s));
  }
  return out;
}

}  // namespace lrb::run
