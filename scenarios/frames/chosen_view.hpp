#pragma once
/// Chooses where to look from, when nobody says.

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::run {

/// Returns the direction, of many all round and from above, from which the bodies hide least of the contacts
/// of the last step that has any; where several hide about as little, the one nearest to `like`. Returns
/// `like` if there is no contact.
Eigen::Vector3d least_hidden(const RecordedRun& recorded, const Eigen::Vector3d& up,
                             const Eigen::Vector3d& like);

/// Shows both bodies wholly in close-ups of the contacts that would be hardly closer, and so cut off parts of
/// them for nothing.
void widen_close_ups(const RecordedRun& recorded, std::vector<render::FrameSpec::View>& views);

}  // namespace lrb::run
