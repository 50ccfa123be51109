#pragma once

#include <string>

#include "scenarios/paper/close_up.hpp"

namespace lrb::paper {

/// Returns the refinement trees of both bodies, in the time step of a collision that took most comparisons,
/// as icicle charts in one SVG. A row is a depth, from the outermost wrapper down. A box is a region, right
/// below the one that hid it; below a refined region are boxes of its real faces. Widths count the faces of
/// the wrapper that the query ended with, all equally wide. Colours: refined; tested but not refined;
/// neither.
std::string icicle_svg(const PaperPair& pair, const CloseUp& collision);

/// Returns the time step that it shows: an index into collision.steps.
std::size_t busiest_step(const CloseUp& collision);

}  // namespace lrb::paper
