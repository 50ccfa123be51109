#pragma once

#include <array>

#include <Eigen/Core>

#include "render/draw_list.hpp"

namespace lrb::run {

/// How the edges of a box look.
struct BoxLook {
  render::Rgba colour;
  float width = 1, dash = 0;
  bool through = false;  ///< seen through what hides it
};

/// Adds the twelve edges of a box in the world: four round each end, and four between. `half`: from the
/// centre to the middles of three sides.
void add_box(render::DrawList& list, const Eigen::Vector3d& centre,
             const std::array<Eigen::Vector3d, 3>& half, const BoxLook& look);

}  // namespace lrb::run
