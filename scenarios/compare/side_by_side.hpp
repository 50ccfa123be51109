#pragma once
/// Two recorded runs of the same steps side by side: pictures on one scale with one camera, and charts.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/render/image.hpp>

namespace lrb::compare {

struct Runs {
  std::array<const record::Recording*, 2> of;
  std::array<std::string, 2> names;
  std::array<const spec::Scenario*, 2> scenarios;
  std::array<std::string, 2> pages = {};  ///< of the runs, as paths; empty: no page
};

/// Returns the number of steps that both runs have.
std::size_t step_count(const Runs& runs);
/// Returns true if all events of a step were stored.
bool is_whole(const record::Recording& run, std::size_t step);
/// Returns the step with the most box tests in both runs together, of those stored completely in both. Throws
/// InputError if there is none.
std::size_t busiest_step(const Runs& runs);
/// Returns a sentence that names the truncated runs; empty if there are none.
std::string cut_words(const Runs& runs);
/// Throws InputError if a folder contains a run, whose page would be overwritten. `option`: the one that
/// names the folder.
void reject_folder_of_run(const std::string& folder, const std::string& option = "-o");

/// Meaning of the colours: box tests if both runs have recorded pairs of nodes, else face tests.
pictures::FrameSpec::ColourBy common_colours(const Runs& runs);

/// Draws one view of a run after an event. `framing`: the content of the picture.
render::Panel panel_after(const frames::RecordedRun& recorded, pictures::FrameSpec frame,
                          trace::EventId event, const std::string& title, const pictures::Framing& framing,
                          const record::ProgressReport& progress);
/// Draws panels beside each other, without letters.
render::Image in_a_row(const std::vector<render::Panel>& panels);

/// Draws the bodies of both runs at the end of a step, coloured by common_colours() on one scale. If the
/// bodies have the same numbers of faces in both and the values differ, a third picture shows the difference
/// per face.
render::Image draw(const Runs& runs, std::size_t step, const record::ProgressReport& progress);

/// Adds charts of the tests of boxes and of faces by step.
void add_work_charts(report::Document& doc, const Runs& runs);

/// Return a counter, and the number of pairs found, summed over all steps.
std::uint64_t sum_of(const record::Recording& run, std::uint64_t Counters::*counter);
std::uint64_t pairs_of(const record::Recording& run);

/// Returns a table of counters and pairs, summed over all steps: a row for each run.
report::Table totals_of(const Runs& runs);

}  // namespace lrb::compare
