#pragma once

#include "scenarios/io/json/json_node.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

inline constexpr double kLeastDpi = 24, kMostDpi = 2400;

/// The "frames" part of a scenario, over `fallback`.
FrameSpec read_frames(const io::JsonNode& node, const FrameSpec& fallback);

}  // namespace lrb::spec
