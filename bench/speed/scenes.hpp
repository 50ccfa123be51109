#pragma once
/// Makes what a point of a chart leads to: a question as a scenario, run, with trace, pictures and page.

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/speed/metrics.hpp"
#include "scenarios/record/recorded_run.hpp"

namespace lrb::bench {

/// The name of a data set and a class of poses.
using SceneKey = std::pair<std::string, PoseClass>;

/// Chooses for each data set and class of poses the question that most methods answer worst. Writes
/// folder/scenes/SET-CLASS.scenario.json and its run, folder/scenes/SET-CLASS/; keeps those that are there.
/// Returns their pages, relative to the folder.
std::map<SceneKey, std::string> write_scenes(const std::vector<DataSet>& sets,
                                             const std::vector<Point>& points, const std::string& folder,
                                             const run::ProgressReport& progress);

}  // namespace lrb::bench
