#pragma once
/// The live page of a run: body B can be dragged and rotated, and the engine, compiled to WebAssembly
/// (wasm/), answers each pose exactly in the page. The page contains the bodies and the engine and fetches
/// nothing.

#include <string>

#include "scenarios/frames/frames.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

inline constexpr const char* kLivePage = "live.html";

/// Throws EnvironmentError if the program was built without the engine for pages.
void check_live_page();
/// Also throws InputError unless the scenario queries two bodies with this engine.
void check_live_page(const spec::Scenario& scenario);

/// Returns the page. `folder`: contains a.lrb and b.lrb of the run.
std::string live_page(const RecordedRun& recorded, const std::string& folder, const std::string& command);

}  // namespace lrb::run
