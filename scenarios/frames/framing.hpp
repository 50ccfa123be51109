#pragma once

#include <vector>

#include "render/pictures/frame_spec.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// Collects what a sequence shows. Where `spec` isolates regions, that is these regions, with some room
/// round them if the rest is there as a ghost; where it explodes bodies, regions as they are moved.
Framing frame_sequence(const std::vector<const LrbRep*>& reps, const trace::Trace& trace,
                       const std::vector<CollideResult>& results, const render::FrameSpec& spec);

}  // namespace lrb::run
