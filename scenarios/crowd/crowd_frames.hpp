#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::crowd {

/// Draws the chosen steps into folder/frames/: all bodies, each kind in its colour; if the view shows
/// wrappers, the lids of the wrappers after the queries of the step; faces in contact, and the curves in
/// which bodies intersect. Writes `text` into every PNG.
run::DrawnFrames draw_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                            const std::vector<std::pair<std::string, std::string>>& text,
                            const run::ProgressReport& progress);

/// Returns the colour of a kind of bodies.
render::Rgba kind_colour(std::uint32_t kind);

/// Describes a step in one sentence.
std::string crowd_caption(const CrowdRun& run, std::uint32_t step);

/// Draws the same frames in memory. PaintedFrame::event is the number of the step.
std::vector<run::PaintedFrame> paint_crowd(const spec::Crowd& crowd, const CrowdRun& run,
                                           const run::ProgressReport& progress);

}  // namespace lrb::crowd
