#include <set>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "scenarios/frames/proof_map.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/scene_json.hpp"

namespace lrb::run {

nlohmann::json map_json(const frames::RecordedRun& p) {
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
  json trees = json::array(), open = json::array(), arguments = json::array();
  for (const auto& [side, number] : walked) {
    const trace::TreeShape tree = frames::walked_shape(p, side, number);
    const frames::MapAxis axis(tree);
    if (axis.repeats) return nullptr;
    std::vector<std::uint32_t> parent(tree.size(), kNull);
    for (const std::uint32_t n : tree.from_root())
      for (const std::uint32_t child : tree.children(n)) parent[child] = n;
    trees.push_back({{"side", side},
                     {"walked", number},
                     {"parent", report::packed(parent)},
                     {"low", report::packed(axis.low)},
                     {"high", report::packed(axis.high)},
                     {"leaf", report::packed(axis.leaf)},
                     {"rank", report::packed(axis.rank)}});
  }
  // Events do not tell which pairs waited when a query ended early.
  const bool complete =
      ours && header.request.mode == Mode::all_pairs && !header.request.is_coarse() && !p.trace->truncated();
  for (std::size_t step = 0; step < p.trace->steps.size() && !complete; ++step)
    if (const std::optional<frames::ProofMap> map = frames::proof_map(p, step))
      for (const frames::MapCell& cell : map->cells)
        if (cell.argument == frames::Argument::open)
          open.push_back(std::to_string(cell.event) + " " + std::to_string(cell.node[0]) + " " +
                         std::to_string(cell.node[1]));
  for (std::size_t i = 0; i < frames::kArguments; ++i) {
    const frames::ArgumentLook& look = frames::look_of(static_cast<frames::Argument>(i));
    const std::string name =
        frames::argument_name(static_cast<frames::Argument>(i), p, p.trace->steps.back());
    arguments.push_back({{"name", name}, {"colour", render::css(look.colour)}, {"pale", look.pale}});
  }
  return {{"trees", std::move(trees)}, {"open", std::move(open)}, {"arguments", std::move(arguments)}};
}

}  // namespace lrb::run
