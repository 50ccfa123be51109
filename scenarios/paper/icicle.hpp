#pragma once

#include <string>

#include "scenarios/paper/close_up.hpp"

namespace lrb::paper {

/// The refinement trees of both bodies in the time step of a collision that took most comparisons, as icicle
/// charts in one SVG. A row is a depth, from the outermost wrapper down; a box is a region, right under the
/// one that hid it; under a refined region, boxes of its real faces. Width: the faces of the wrapper that the
/// query ended with, each as wide as the next. Colour: refined, tested but not refined, neither.
std::string icicle_svg(const PaperPair& pair, const CloseUp& collision);

/// The time step that it shows: an index into collision.steps.
std::size_t busiest_step(const CloseUp& collision);

}  // namespace lrb::paper
