#pragma once

#include <nlohmann/json.hpp>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::bodies {

/// Returns an LRB-rep in numbers: name, faces, regions, layers, volumes (in 2D: areas) and memory. The keys
/// are those of `lrbscope build --json`.
nlohmann::ordered_json body_figures(const LrbRep& rep);

}  // namespace lrb::bodies
