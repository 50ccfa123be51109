#pragma once

#include <string>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::run {

/// Draws one picture of a body: itself, some wrappers between, and its outermost wrapper, as panels (a), (b),
/// ...
void draw_body_sheet(const LrbRep& rep, const std::string& path);

}  // namespace lrb::run
