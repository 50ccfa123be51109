#include "scenarios/run/measured_json.hpp"

#include <nlohmann/json.hpp>

#include "scenarios/report/page/packed.hpp"
#include "scenarios/run/measured_marks.hpp"

namespace lrb::run {
namespace {

std::optional<MarkedWay> way_out_in(const RecordedRun& p, std::size_t step) {
  const trace::Step& s = p.trace->steps[step];
  if (!s.result.clash) return std::nullopt;
  std::span<const ContactRegion> contacts;
  if (p.results != nullptr && step < p.results->size()) contacts = (*p.results)[step].regions;
  return way_out_of(*s.result.clash, *p.reps[0], s.pose_a, *p.reps[1], s.pose_b, contacts);
}

}  // namespace

nlohmann::json measured_json(const RecordedRun& p, const SceneFrame& frame) {
  std::vector<std::uint32_t> steps, ways_out;
  std::vector<float> ends;
  nlohmann::json words = nlohmann::json::array();
  const auto add = [&](const trace::Step& s, const MarkedWay& way, bool is_way_out) {
    steps.push_back(s.index);
    ways_out.push_back(is_way_out ? 1 : 0);
    frame.add_point(ends, way.from);
    frame.add_point(ends, way.to);
    words.push_back(way.text + (is_way_out ? " deep" : " apart"));
  };
  for (std::size_t i = 0; i < p.trace->steps.size(); ++i) {
    const trace::Step& s = p.trace->steps[i];
    if (!s.finished) continue;
    const auto gap = s.result.distance ? gap_of(*s.result.distance) : std::nullopt;
    if (gap) add(s, *gap, false);
    if (const auto way = way_out_in(p, i)) add(s, *way, true);
  }
  if (steps.empty()) return nullptr;
  return {{"step", report::packed(steps)},
          {"wayOut", report::packed(ways_out)},
          {"ends", report::packed(ends)},
          {"words", std::move(words)}};
}

}  // namespace lrb::run
