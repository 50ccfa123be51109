#pragma once
/// Converts the run of a crowd to data for its page: for the 3D view and the tables that follow the step
/// (report/web/crowd.js).

#include <cstddef>
#include <string>

#include "scenarios/crowd/crowd_run.hpp"

namespace lrb::crowd {

/// Size limits of a page, which opens in a second or two at these limits.
struct CrowdSceneLimits {
  std::size_t faces = 300'000;           ///< maximum of all kinds together for a 3D view
  std::size_t drawn_faces = 20'000'000;  ///< maximum of all bodies together for a 3D view
  std::size_t poses = 60'000;            ///< of bodies that moved, over all steps
  std::size_t queries = 100'000;         ///< over all steps
};

/// Returns the run as JSON: each kind's real faces once; for each step the poses of the bodies that moved,
/// and the queries. Beyond the limits, steps are left out, evenly spaced, and the JSON says so.
/// `pair_command`: the command that records two bodies as a run of their own, without their names.
std::string crowd_scene_json(const spec::Crowd& crowd, const CrowdRun& run, const std::string& pair_command,
                             const CrowdSceneLimits& limits = {});

}  // namespace lrb::crowd
