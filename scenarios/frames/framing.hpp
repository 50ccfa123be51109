#pragma once

#include <vector>

#include "render/pictures/frame_spec.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// Collects the points that a sequence shows. If `spec` isolates regions, these regions, with a margin if the
/// rest is shown as a ghost; if it explodes bodies, the displaced regions.
Framing frame_sequence(const std::vector<const LrbRep*>& reps, const trace::Trace& trace,
                       const std::vector<CollideResult>& results, const render::FrameSpec& spec);

}  // namespace lrb::run
