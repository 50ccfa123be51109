#pragma once
/// Two recorded runs of the same steps beside each other: pictures on one scale with one camera, and charts.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/render/image.hpp>

namespace lrb::compare {

struct Runs {
  std::array<const run::Recording*, 2> of;
  std::array<std::string, 2> names;
  std::array<const spec::Scenario*, 2> scenarios;
  std::array<std::string, 2> pages = {};  ///< of the runs, as paths; empty: there is none
};

/// Returns the number of steps that both runs have.
std::size_t step_count(const Runs& runs);
/// Returns true if all events of a step were stored.
bool is_whole(const run::Recording& run, std::size_t step);
/// Returns the step at which both together test most boxes, of those that are whole in both. Throws
/// InputError if none is.
std::size_t busiest_step(const Runs& runs);
/// Says which of the runs were cut, in a sentence; empty if none was.
std::string cut_words(const Runs& runs);
/// Throws InputError if a folder holds a run of its own, whose page would be lost.
void refuse_folder_of_run(const std::string& folder);

/// What colours mean: box tests where both runs have recorded pairs of nodes, else face tests.
render::FrameSpec::ColourBy common_colours(const Runs& runs);

/// Draws the bodies of both runs at the end of a step, coloured by common_colours() on one scale, and where
/// the bodies have as many faces in both and these differ, a third picture: how much more each face has in
/// one of the runs than in the other.
render::Image draw(const Runs& runs, std::size_t step, const run::ProgressReport& progress);

/// Adds charts of the tests of boxes and of faces by step.
void add_work_charts(report::Document& doc, const Runs& runs);

/// Return a counter, and the number of pairs found, summed over all steps.
std::uint64_t sum_of(const run::Recording& run, std::uint64_t Counters::*counter);
std::uint64_t pairs_of(const run::Recording& run);

/// Returns a table of counters and pairs, summed over all steps: a row for each run.
report::Table totals_of(const Runs& runs);

}  // namespace lrb::compare
