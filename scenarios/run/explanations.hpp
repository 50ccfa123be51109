#pragma once
/// Explains a run's pairs of faces, and its steps without any, for its page (report/page/scene_why.js).

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scenarios/run/frame_job.hpp"
#include "scenarios/run/scene_frame.hpp"

namespace lrb::run {

/// How much a page explains at most.
struct ExplainLimits {
  std::size_t pairs = 8'000;
  std::size_t steps = 200;
};

/// What is explained: events and steps that the page has. Ascending.
struct Explained {
  const std::vector<trace::EventId>& events;
  const std::vector<std::uint32_t>& steps;
};

/// Returns what explain_pair() tells of the pairs of real faces that these events compare, or that another
/// engine got wrong, each pair of a step once, and what explain_walk() tells of the steps that found none. Of
/// too many pairs, contacts come first; others are evenly chosen. `command` explains other pairs, see
/// ReportText::why. Returns null for a run of one body, and for requests that the complete query does not
/// answer.
nlohmann::json explanations_json(const RecordedRun& recorded, const Explained& what, const SceneFrame& frame,
                                 const std::string& command, const ExplainLimits& limits = {});

}  // namespace lrb::run
