#pragma once

#include <nlohmann/json.hpp>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::bodies {

/// An LRB-rep in numbers: name, faces, regions, layers, volumes (in 2D: areas) and memory. Keys as in
/// `lrbscope build --json`.
nlohmann::ordered_json body_figures(const LrbRep& rep);

}  // namespace lrb::bodies
