#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "render/camera.hpp"
#include "scenarios/spec/scenario.hpp"
#include "trace/trace.hpp"

namespace lrb::run {

/// What the cameras of a whole sequence have to show, so that the picture stands still while the bodies move.
struct Framing {
  std::vector<Eigen::Vector3d> points;    ///< of both bodies, in all steps shown
  std::vector<Eigen::Vector3d> contacts;  ///< of all contact regions, or of the faces of coarse answers; if
                                          ///< there are none, contact views show the whole
  int dim = 3;
};

/// Collects what a sequence shows. Where `spec` isolates regions, that is these regions, with some room
/// round them if the rest is there as a ghost; where it explodes bodies, regions as they are moved.
Framing frame_sequence(const std::vector<const LrbRep*>& reps, const trace::Trace& trace,
                       const std::vector<CollideResult>& results, const spec::FrameSpec& spec);

/// Returns a view's camera. `progress` in [0, 1] is the share of the sequence that has passed, for orbits.
render::Camera camera_for(const spec::FrameSpec::View& view, const Framing& framing, double width,
                          double height, double progress);

}  // namespace lrb::run
