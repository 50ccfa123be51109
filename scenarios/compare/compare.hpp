#pragma once
/// Two recorded runs of one body each, such as two builds of it, beside each other.

#include <optional>
#include <string>
#include <vector>

#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/render/image.hpp>

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

/// Returns where the two runs begin to differ, in words: their bodies and requests, and the first event or
/// answer that is not the same; nothing if they are the same.
std::optional<std::string> first_difference(const Runs& runs);

/// Returns the views of both runs' pages for a page in `folder`; none if one of them has no page.
std::vector<report::PageView> views_of(const Runs& runs, const std::string& folder);

/// Writes folder/index.html and folder/compare.png: what differs first, answers and work step by step, and
/// where the work went in each. Of runs of one body: how the hull or the wrapper changed, and the regions of
/// both. Returns first_difference(). Throws InputError if one run is of one body and the other of two.
std::optional<std::string> write_comparison(const Runs& runs, const std::string& command,
                                            const std::string& folder, const run::ProgressReport& progress);

}  // namespace lrb::compare
