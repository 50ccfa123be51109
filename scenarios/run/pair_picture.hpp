#pragma once

#include <string>

#include "engine/query/explain.hpp"

namespace lrb::run {

/// Draws two faces with the bodies about them: where they meet, or else the line between their nearest points
/// and a plane across it, which has them on different sides. Throws EnvironmentError if the file cannot be
/// written.
void draw_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
               const PairExplanation& pair, const std::string& path);

}  // namespace lrb::run
