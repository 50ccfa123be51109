#pragma once
/// The points that cameras show, and the directions that are chosen if none is given.

#include <optional>

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::frames {

/// Collects the points that a sequence shows. If `spec` isolates regions, these regions, with a margin if the
/// rest is shown as a ghost; if it explodes bodies, the displaced regions.
pictures::Framing frame_sequence(const RecordedRun& recorded, const pictures::FrameSpec& spec);

/// Returns the closest points of two bodies: what close-ups show without a contact. Returns
/// none for 2D bodies, and for bodies that meet or have no faces.
std::vector<Eigen::Vector3d> nearest_points(const pictures::PosedBodies& bodies);

/// Returns the direction from which a single thin body in upright position fills its pictures: across its
/// thinnest extent, if that is horizontal and less than a quarter of the largest. Returns nullopt for other
/// bodies, and if the pictures have views.
std::optional<Eigen::Vector3d> view_of_thin_body(const RecordedRun& recorded, const pictures::Look& look);

/// Returns the direction, of those across the line from A to B at the first step, from which the bodies hide
/// least of the contacts of the last step with contacts: both bodies and the gap between them are visible. If
/// their centres coincide: of directions all around and from above; of similar ones, the one closest to
/// `like`, which is returned without a contact. Returns `like` in 2D.
Eigen::Vector3d min_hidden(const RecordedRun& recorded, const Eigen::Vector3d& up,
                           const Eigen::Vector3d& like);

/// Returns two views side by side: the whole scene with the wrappers, and the contact with the bodies alone.
/// Both use the direction of the first given view.
std::vector<pictures::FrameSpec::View> whole_and_contact(
    const std::vector<pictures::FrameSpec::View>& as = {});

/// Shows both bodies completely in close-ups of the contacts that would magnify little and only cut off
/// parts. If no wrapper is drawn, titles do not name it.
void widen_close_ups(const RecordedRun& recorded, std::vector<pictures::Look::View>& views);

}  // namespace lrb::frames
