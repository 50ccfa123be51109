#pragma once

#include "scenarios/json/json_node.hpp"
#include "scenarios/scenario.hpp"

namespace lrb {

inline constexpr double kLeastDpi = 24, kMostDpi = 2400;

/// The "frames" part of a scenario, over `fallback`.
FrameSpec read_frames(const JsonNode& node, const FrameSpec& fallback);

}  // namespace lrb
