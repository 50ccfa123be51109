#pragma once
/// Chooses where to look from, when nobody says.

#include <Eigen/Geometry>

#include "scenarios/run/frame_job.hpp"

namespace lrb::run {

/// Returns the box around a body's real faces.
Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose = {});
/// Returns the box around all of its vertices, those of lids among them.
Eigen::AlignedBox3d box_with_lids(const LrbRep& rep, const Pose& pose = {});

/// Returns a direction from which a box is seen from its longer level side, aslant and slightly from above.
/// `up` is an axis.
Eigen::Vector3d broadside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& up);

/// Returns the direction, of many all round and from above, from which the bodies hide least of the contacts
/// of the last step that has any; where several hide about as little, the one nearest to `like`. Returns
/// `like` if there is no contact.
Eigen::Vector3d least_hidden(const RecordedRun& recorded, const Eigen::Vector3d& up,
                             const Eigen::Vector3d& like);

/// Shows both bodies wholly in close-ups of the contacts that would be hardly closer, and so cut off parts of
/// them for nothing.
void widen_close_ups(const RecordedRun& recorded, std::vector<spec::FrameSpec::View>& views);

}  // namespace lrb::run
