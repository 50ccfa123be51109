#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/level_figures.hpp"

namespace lrb::bodies {

/// Levels as `lrbscope build --json` and `lrbscope levels --json` write them.
nlohmann::ordered_json level_json(std::span<const LevelFigures> levels);

}  // namespace lrb::bodies
