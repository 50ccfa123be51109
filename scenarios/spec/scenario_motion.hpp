#pragma once
/// Reads poses and motions of a scenario, and computes the poses of those motions that need no query.

#include <vector>

#include "scenarios/io/json/json_node.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

/// Reads a pose: 12 numbers (3x4, row by row), or {position, axis, degrees}.
Pose read_pose(const io::JsonNode& node);
Motion read_motion(const io::JsonNode& node);

/// Returns the poses of B, one for each step, for every kind of motion but approach (approach.hpp). `start`
/// is the body's own pose, applied first.
std::vector<Pose> poses_of(const Motion& motion, const Pose& start);

/// Returns the pose that applies `first`, then `second`.
Pose then(const Pose& first, const Pose& second);

}  // namespace lrb::spec
