#pragma once
/// Reading poses and motions of a scenario, and what the motions that need no query come to.

#include <vector>

#include "scenarios/io/json/json_node.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

/// 12 numbers (row-major 3x4), or {position, axis, degrees}.
Pose read_pose(const io::JsonNode& node);
Motion read_motion(const io::JsonNode& node);

/// Poses of B, one a step, for every kind but approach (approach.hpp). `start` is the body's own pose,
/// applied first.
std::vector<Pose> poses_of(const Motion& motion, const Pose& start);

/// first, then second.
Pose then(const Pose& first, const Pose& second);

}  // namespace lrb::spec
