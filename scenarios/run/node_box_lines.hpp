#pragma once

#include <cstdint>
#include <span>

#include "render/scene.hpp"
#include "trace/trace.hpp"
#include "trace/tree_shape.hpp"

namespace lrb::run {

/// Adds the boxes of the nodes of one depth of a body's tree that the walk came to in `events`: those that
/// met another node's, and those that parted from all of them.
void add_node_boxes(render::Scene& scene, const trace::TreeShape& tree, Side side, const Pose& pose,
                    std::uint32_t depth, std::span<const trace::Event> events, const render::Style& style);

}  // namespace lrb::run
