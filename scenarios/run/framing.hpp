#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "render/camera.hpp"
#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"

namespace lrb::run {

/// What the cameras of a whole sequence have to hold, so that the picture stands still while the bodies move.
struct Framing {
  std::vector<Eigen::Vector3d> points;    ///< of both bodies, in all steps shown
  std::vector<Eigen::Vector3d> contacts;  ///< of all contact regions, or of the faces of coarse answers;
                                          ///< none: contact views show the whole
  int dim = 3;
};

/// Where `spec` shows regions alone and no ghosts, those regions are what is to be held.
Framing frame_sequence(const std::vector<const LrbRep*>& reps, const trace::Trace& trace,
                       const std::vector<CollideResult>& results, const spec::FrameSpec& spec);

/// `progress` in [0, 1]: how much of the sequence has passed, for orbits.
render::Camera camera_for(const spec::FrameSpec::View& view, const Framing& framing, double width,
                          double height, double progress);

}  // namespace lrb::run
