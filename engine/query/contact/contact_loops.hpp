#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/query/walk/contact_region.hpp"

namespace lrb {

/// Chains edges between numbered points into loops: closed where all points have two edges, else open from
/// one branch point or end to the next. Uses every edge once.
std::vector<ContactLoop> chain_edges(std::span<const std::array<std::uint32_t, 2>> edges,
                                     const std::vector<Eigen::Vector3d>& points);

}  // namespace lrb
