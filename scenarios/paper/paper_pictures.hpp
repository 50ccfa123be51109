#pragma once

#include <string>

#include "scenarios/paper/sweep.hpp"
#include <lrbscope/render/image.hpp>

namespace lrb::paper {

/// Draws the face tests on both bodies, in the easiest and the hardest of their collisions: panels side by
/// side for each, with one logarithmic scale for all. Every face of the wrappers at the end of the last time
/// step is coloured by the number of its face tests over all counted time steps. Throws EnvironmentError if
/// drawing is not available on this machine.
render::Image draw_heat_maps(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest);

/// Returns the refinement trees of both bodies, in the time step of a collision with the most comparisons, as
/// icicle charts in one SVG. A row is a depth, from the outermost wrapper down. A box is a region, right
/// below the one that hid it; below a refined region are boxes of its real faces. Widths count the faces of
/// the wrapper at the end of the query, all equally wide. Colours: refined; tested but not refined; neither.
std::string icicle_svg(const PaperPair& pair, const CloseUp& collision);

/// Returns the time step in the chart: an index into collision.steps.
std::size_t busiest_step(const CloseUp& collision);

}  // namespace lrb::paper
