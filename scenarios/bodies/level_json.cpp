#include "scenarios/bodies/level_json.hpp"

namespace lrb::bodies {

nlohmann::ordered_json level_json(std::span<const LevelFigures> levels) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const LevelFigures& l : levels)
    out.push_back({{"share", l.share}, {"tolerance", l.tolerance}, {"faces", l.faces}, {"bound", l.bound}});
  return out;
}

}  // namespace lrb::bodies
