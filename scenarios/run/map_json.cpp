#include <algorithm>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "scenarios/frames/proof_map.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/scene_json.hpp"

namespace lrb::run {
namespace {

/// The cells of the page's steps: a, b are the simplices of a pair that was tested, else nodes.
class Cells {
 public:
  /// Adds those of a step; none if there would be more than `most`.
  void add(const frames::RecordedRun& p, std::size_t step, std::size_t most) {
    const frames::ProofMap map = frames::proof_map(p, step).value_or(frames::ProofMap());
    std::vector<std::array<std::uint32_t, 4>> sorted;  // event, argument, a, b
    std::map<std::array<std::uint32_t, 2>, trace::EventId> visit;
    for (const frames::MapCell& cell : map.cells) {
      const auto argument = static_cast<std::uint32_t>(cell.argument);
      if (!cell.is_upon()) {
        visit[cell.node] = cell.event;
        sorted.push_back({cell.event, argument, cell.node[0], cell.node[1]});
        continue;
      }
      // Until it is tested, a pair that planes do not separate waits.
      const trace::Event& test = p.trace->events[cell.event];
      if (cell.argument != frames::Argument::planes && p.trace->header.engine.empty())
        sorted.push_back({visit.at(cell.node), frames::kArguments, test.a, test.b});
      sorted.push_back({cell.event, argument, test.a, test.b});
    }
    if (event_.size() + sorted.size() > most) sorted.clear();
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& x, const auto& y) { return x.front() < y.front(); });
    for (const auto& [event, argument, a, b] : sorted) {
      event_.push_back(event), argument_.push_back(argument);
      a_.push_back(a), b_.push_back(b);
    }
    first_.push_back(static_cast<std::uint32_t>(event_.size()));
    walked_.insert(walked_.end(), map.walked.begin(), map.walked.end());
  }

  nlohmann::json json() const {
    using report::packed;
    return {{"first", packed(first_)}, {"event", packed(event_)}, {"argument", packed(argument_)},
            {"a", packed(a_)},         {"b", packed(b_)},         {"walked", packed(walked_)}};
  }

 private:
  std::vector<std::uint32_t> first_{0}, event_, argument_, a_, b_, walked_;
};

}  // namespace

nlohmann::json map_json(const frames::RecordedRun& p, const std::vector<std::uint32_t>& steps,
                        const SceneLimits& limits) {
  using nlohmann::json;
  const trace::TraceHeader& header = p.trace->header;
  const bool ours = header.engine.empty();
  if (p.reps.size() != 2 || p.trace->steps.empty() ||
      (ours ? header.level == EventLevel::faces : p.trees == nullptr || p.trees->empty()))
    return nullptr;
  // Each tree that was traversed: the body's own, or those of levels of detail.
  std::set<std::array<std::uint32_t, 2>> walked;
  for (const trace::Event& e : p.trace->events)
    if (e.kind == EventKind::begin && walks_trees(e.phase()))
      walked.insert({{0, e.phase_begin().walked_a}, {1, e.phase_begin().walked_b}});
  json trees = json::array(), arguments = json::array();
  for (const auto& [side, number] : walked) {
    const frames::MapAxis axis(frames::walked_shape(p, side, number));
    if (axis.repeats) return nullptr;
    trees.push_back({{"side", side},
                     {"walked", number},
                     {"low", report::packed(axis.low)},
                     {"high", report::packed(axis.high)},
                     {"leaf", report::packed(axis.leaf)},
                     {"rank", report::packed(axis.rank)}});
  }
  constexpr std::size_t kCellsPerEvent = 4;  // of the limits: some 20 bytes each on the page
  Cells cells;
  for (const std::uint32_t step : steps) cells.add(p, step, kCellsPerEvent * limits.events);
  for (std::size_t i = 0; i < frames::kArguments; ++i) {
    const frames::ArgumentLook& look = frames::look_of(static_cast<frames::Argument>(i));
    const std::string name =
        frames::argument_name(static_cast<frames::Argument>(i), p, p.trace->steps.back());
    arguments.push_back({{"name", name}, {"colour", render::css(look.colour)}, {"pale", look.pale}});
  }
  return {{"trees", std::move(trees)}, {"cells", cells.json()}, {"arguments", std::move(arguments)}};
}

}  // namespace lrb::run
