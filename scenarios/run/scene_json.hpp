#pragma once
/// Converts a run to data for its page: for the 3D view, the table of events and the panel of faces and
/// regions (report/web/scene_*.js).

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "scenarios/frames/frames.hpp"
#include "scenarios/run/explanations.hpp"
#include <lrbscope/trace/work.hpp>

namespace lrb::run {

/// Returns the results of distances and clashes of a run, for the page's view: for each step that has one,
/// the segment between the closest points, or the separation vector of B from A. Returns null if there is
/// none.
nlohmann::json measured_json(const frames::RecordedRun& p, const SceneFrame& frame);

/// Returns the chart of the work, from events and, where node pairs were not recorded, from counters.
trace::WorkChart work_of(const trace::Trace& trace);
/// Returns the parts of the work, in all and by step; null if it is not known.
nlohmann::json work_json(const trace::Trace& trace, const trace::WorkChart& chart);

/// Returns the pseudo faces, ascending, that a body's wrapper shows at some event, and the lids and floors of
/// the regions behind them.
std::vector<std::uint32_t> shown_pseudo_faces(const LrbRep& rep, Side side, const trace::Trace& trace);

/// Returns the colours of a page's 3D view.
nlohmann::json scene_colours();

/// Returns the viewpoint at which a page's view starts.
nlohmann::json view_json(const render::ViewDirection& view, bool orthographic);

/// Size limits of a page, which opens in a second or two at these limits.
struct SceneLimits {
  std::size_t events = 200'000;
  std::size_t faces = 1'500'000;  ///< of both bodies; with more, there is no 3D view
  std::size_t with_all_lids =
      300'000;                ///< with more faces, the page has only those pseudo faces that it shows
  std::size_t boxes = 4'096;  ///< of tree nodes, for each body
  ExplainLimits explained = {};
};

/// Returns the trees of a run's traversals and the cells of the page's steps, for its proof map
/// (proof_map.js); null without pairs of nodes.
nlohmann::json map_json(const frames::RecordedRun& p, const std::vector<std::uint32_t>& steps,
                        const SceneLimits& limits);

/// Sources of further data for the page's reader.
struct SceneSource {
  std::string trace_file;
  std::string why;  ///< see ReportText::why
};

/// Returns the run as JSON. Coordinates are rounded to float, relative to the centre of their body and in
/// units of the scene's size. The JSON names the parts omitted because of the limits, and the trace that
/// contains them.
std::string scene_json(const frames::RecordedRun& recorded, const SceneSource& source,
                       const SceneLimits& limits = {});

}  // namespace lrb::run
