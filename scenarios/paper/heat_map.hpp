#pragma once

#include "render/image.hpp"
#include "scenarios/paper/close_up.hpp"

namespace lrb::paper {

/// Draws the face tests on both bodies, in the easiest and the hardest of their collisions: a row of panels
/// for each, with one logarithmic scale for all. Every face of the wrappers that the last time step ended
/// with is coloured by the number of its face tests over all counted time steps. Throws EnvironmentError if
/// nothing can be drawn on this machine.
render::Image draw_heat_maps(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest);

}  // namespace lrb::paper
