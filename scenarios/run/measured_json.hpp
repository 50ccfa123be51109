#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scenarios/run/frame_job.hpp"
#include "scenarios/run/scene_frame.hpp"

namespace lrb::run {

/// Returns what distances and clashes of a run found, for the page's view: for each step that has one, the
/// way between the nearest points, or the way of B out of A; null if there is none.
nlohmann::json measured_json(const RecordedRun& p, const SceneFrame& frame);

}  // namespace lrb::run
