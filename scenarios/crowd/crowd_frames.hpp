#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"
#include "scenarios/run/frame_job.hpp"

namespace lrb::crowd {

/// Draws the steps that are to be drawn into folder/frames/: all bodies, a colour a kind; with the lids that
/// the queries of the step left of their wrappers, where the view wants them; faces in contact and the curves
/// in which bodies meet. `text` goes into every PNG.
run::DrawnFrames draw_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                            const std::vector<std::pair<std::string, std::string>>& text,
                            const run::ProgressReport& progress);

/// A step in one sentence.
std::string crowd_caption(const CrowdRun& run, std::uint32_t step);

}  // namespace lrb::crowd
