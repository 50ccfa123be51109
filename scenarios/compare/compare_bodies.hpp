#pragma once
/// Two recorded runs of one body each, such as two builds of it, beside each other.

#include "render/image.hpp"
#include "scenarios/compare/side_by_side.hpp"

namespace lrb::compare {

/// Returns true if both runs are of one body.
bool of_one_body(const Runs& runs);

/// Returns numbers of both LRB-reps: faces, regions, layers, outermost wrapper.
report::PageTable body_table(const Runs& runs);
/// Returns what each pass of two constructions made; a table without rows for other runs.
report::PageTable pass_table(const Runs& runs);
/// Returns how the faces of hull or wrapper change from event to event in both.
report::PageChart faces_chart(const Runs& runs);

/// Draws both wrappers as they are after the last event, coloured by region, seen by one camera.
render::Image draw_bodies(const Runs& runs, const run::ProgressReport& progress);

}  // namespace lrb::compare
