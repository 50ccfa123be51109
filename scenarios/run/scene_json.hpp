#pragma once
/// Makes a run into data for its page: for the view in three dimensions, the table of events and the panel of
/// faces and regions (report/web/scene_*.js).

#include <cstddef>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "scenarios/frames/frames.hpp"
#include "scenarios/run/explanations.hpp"

namespace lrb::run {

/// Returns what distances and clashes of a run found, for the page's view: for each step that has one, the
/// way between the nearest points, or the way of B out of A; null if there is none.
nlohmann::json measured_json(const RecordedRun& p, const SceneFrame& frame);

/// How much a page holds at most; it opens in a second or two with all of that.
struct SceneLimits {
  std::size_t events = 200'000;
  std::size_t faces = 300'000;  ///< of both bodies; with more, there is no view in three dimensions
  std::size_t boxes = 4'096;    ///< of tree nodes, for each body
  ExplainLimits explained = {};
};

/// Where the page's reader finds more.
struct SceneSource {
  std::string trace_file;
  std::string why;  ///< see ReportText::why
};

/// Returns the run as JSON. Coordinates are rounded to float, relative to the middle of their body and in
/// units of the scene's size. What the limits leave out is said in it, with the trace as the place where
/// it is.
std::string scene_json(const RecordedRun& recorded, const SceneSource& source,
                       const SceneLimits& limits = {});

}  // namespace lrb::run
