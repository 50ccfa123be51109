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

/// Return what traces keep of how a run is drawn, as a part of a scenario's "frames", and read it: sizes,
/// style, views and columns, but not which moments. `name` names the trace in messages; empty text gives
/// `fallback`. Reading throws InputError.
std::string pictures_text(const FrameSpec& frames);
FrameSpec read_pictures(const std::string& text, const std::string& name, const FrameSpec& fallback = {});

}  // namespace lrb::spec
