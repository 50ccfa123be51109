#pragma once
/// Where pictures are looked at from.

#include <vector>

#include <Eigen/Geometry>

#include "engine/lrb/lrb_rep.hpp"
#include "render/camera.hpp"
#include "scenarios/run/frame_spec.hpp"

namespace lrb::run {

/// What the cameras of a whole sequence have to show, so that the picture stands still while the bodies move.
struct Framing {
  std::vector<Eigen::Vector3d> points;    ///< of both bodies, in all steps shown
  std::vector<Eigen::Vector3d> contacts;  ///< of all contact regions, or of the faces of coarse answers; if
                                          ///< there are none, contact views show the whole
  int dim = 3;
};

/// Returns a view's camera. `progress` in [0, 1] is the share of the sequence that has passed, for orbits.
render::Camera camera_for(const render::FrameSpec::View& view, const Framing& framing, double width,
                          double height, double progress);

/// Returns the box around a body's real faces.
Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose = {});
/// Returns the box around all of its vertices, those of lids among them.
Eigen::AlignedBox3d box_with_lids(const LrbRep& rep, const Pose& pose = {});

/// Returns a direction from which a box is seen from its longer level side, aslant and slightly from above.
/// `up` is an axis.
Eigen::Vector3d broadside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& up);

}  // namespace lrb::run
