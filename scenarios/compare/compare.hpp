#pragma once
/// Comparison of two recorded runs of one body each, such as two builds of it.

#include <optional>
#include <string>
#include <vector>

#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/render/image.hpp>

namespace lrb::compare {

/// Returns true if both runs are of one body.
bool of_one_body(const Runs& runs);

/// Returns statistics of both LRB-reps: faces, regions, layers, outermost wrapper.
report::PageTable body_table(const Runs& runs);
/// Returns the results of each pass of two constructions; a table without rows for other runs.
report::PageTable pass_table(const Runs& runs);
/// Returns the numbers of faces of front or wrapper over the events of both.
report::PageChart faces_chart(const Runs& runs);

/// Draws both wrappers after the last event, coloured by region, with one camera.
render::Image draw_bodies(const Runs& runs, const run::ProgressReport& progress);

/// Returns the first difference of the two runs as text: their bodies and requests, and the first differing
/// event or answer. Returns nullopt if they are equal.
std::optional<std::string> first_difference(const Runs& runs);

/// Returns the views of both runs' pages for a page in `folder`; empty if one of them has no page.
std::vector<report::PageView> views_of(const Runs& runs, const std::string& folder);

/// Writes folder/index.html and folder/compare.png: the first difference, answers and work step by step, and
/// the distribution of the work in each. For runs of one body: the changes of front or wrapper, and the
/// regions of both. Returns first_difference(). Throws InputError if one run has one body and the other two.
std::optional<std::string> write_comparison(const Runs& runs, const std::string& command,
                                            const std::string& folder, const run::ProgressReport& progress);

}  // namespace lrb::compare
