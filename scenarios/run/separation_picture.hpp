#pragma once

#include <string>

#include "engine/query/collide.hpp"

namespace lrb::run {

/// Draws two bodies that are apart under the wrappers that prove it: as they come in panel (a), refined as
/// far as was needed in panel (b).
void draw_separation(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                     const Separation& separation, const std::string& path);

}  // namespace lrb::run
