#pragma once

#include "scenarios/io/json/json_node.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

inline constexpr double kLeastDpi = 24, kMostDpi = 2400;
/// The greatest depth of tree nodes whose boxes can be asked for.
inline constexpr std::uint32_t kMostDepth = 64;

/// Returns what a run's frames are if nothing is said.
FrameSpec default_frames(Show show);

/// Reads the "frames" part of a scenario; what it leaves out is as in `fallback`.
FrameSpec read_frames(const io::JsonNode& node, const FrameSpec& fallback);

}  // namespace lrb::spec
