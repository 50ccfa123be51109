#pragma once
/// Shows the run of a crowd: as pictures of its steps, and as data for its page.

#include <cstddef>
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

/// Size limits of a page, which opens in a second or two at these limits.
struct CrowdSceneLimits {
  std::size_t faces = 300'000;           ///< maximum of all kinds together for a 3D view
  std::size_t drawn_faces = 20'000'000;  ///< maximum of all bodies together for a 3D view
  std::size_t poses = 60'000;            ///< of bodies that moved, over all steps
  std::size_t queries = 100'000;         ///< over all steps
};

/// Returns the run as JSON, for the 3D view and the tables that follow the step (report/web/crowd.js): each
/// kind's real faces once; for each step the poses of the bodies that moved, and the queries. Beyond the
/// limits, steps are left out, evenly spaced, and the JSON says so. `pair_command`: the command that records
/// two bodies as a run of their own, without their names.
std::string crowd_scene_json(const spec::Crowd& crowd, const CrowdRun& run, const std::string& pair_command,
                             const CrowdSceneLimits& limits = {});

}  // namespace lrb::crowd
