#pragma once

#include "render/image.hpp"
#include "scenarios/paper/close_up.hpp"

namespace lrb::paper {

/// Face tests over both bodies, in the easiest and the hardest of their collisions: a row of panels each, one
/// logarithmic scale for all. Every face of the wrappers as the last time step left them is coloured by the
/// number of its face tests over all counted time steps. Throws EnvironmentError if nothing can be drawn
/// here.
render::Image draw_heat_maps(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest);

}  // namespace lrb::paper
