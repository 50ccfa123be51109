#pragma once
/// Chooses the default view direction.

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::run {

/// Returns the direction, of many all around and from above, from which the bodies hide least of the contacts
/// of the last step with contacts; of similar ones, the one closest to `like`. Returns `like` if there is no
/// contact.
Eigen::Vector3d least_hidden(const RecordedRun& recorded, const Eigen::Vector3d& up,
                             const Eigen::Vector3d& like);

/// Shows both bodies completely in close-ups of the contacts that would magnify little and only cut off
/// parts.
void widen_close_ups(const RecordedRun& recorded, std::vector<render::FrameSpec::View>& views);

}  // namespace lrb::run
