#pragma once
/// Regions and tried settings as `lrbscope inspect --regions` tells of them.

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/region_figures.hpp"

namespace lrb::cli {

/// Returns all regions, in the order given. The keys are those of `--json`.
nlohmann::ordered_json regions_json(std::span<const bodies::RegionFigures> regions);
/// Returns them as a table for people: the first of them.
std::string regions_text(const nlohmann::ordered_json& regions);

nlohmann::ordered_json trials_json(std::span<const bodies::Trial> trials);
std::string trials_text(const nlohmann::ordered_json& trials);

/// Returns what stands below a region's picture.
std::string region_caption(const bodies::RegionFigures& region);

}  // namespace lrb::cli
