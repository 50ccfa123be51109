#pragma once
/// The points that cameras show, and the directions that are chosen if none is given.

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::run {

/// Collects the points that a sequence shows. If `spec` isolates regions, these are the points of the
/// regions, with some room around them if the rest is drawn as a ghost. Exploded regions count where they are
/// drawn.
Framing frame_sequence(const RecordedRun& recorded, const render::FrameSpec& spec);

/// Returns the direction, of many all round and from above, from which the bodies hide least of the contacts
/// of the last step that has any; where several hide about as little, the one nearest to `like`. Returns
/// `like` if there is no contact.
Eigen::Vector3d least_hidden(const RecordedRun& recorded, const Eigen::Vector3d& up,
                             const Eigen::Vector3d& like);

/// Shows both bodies wholly in close-ups of the contacts that would be hardly closer, and so cut off parts of
/// them for nothing.
void widen_close_ups(const RecordedRun& recorded, std::vector<render::Look::View>& views);

}  // namespace lrb::run
