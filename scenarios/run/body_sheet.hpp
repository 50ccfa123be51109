#pragma once

#include <string>

#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/run/frame_spec.hpp"

namespace lrb::run {

/// Draws one picture of a body: itself, some wrappers between, and its outermost wrapper, as panels (a), (b),
/// ... of the size that `frames` have, seen as by their first view.
void draw_body_sheet(const LrbRep& rep, const std::string& path, const render::FrameSpec& frames);

/// The size of a panel unless one is asked for.
inline constexpr int kBodySheetWidth = 640, kBodySheetHeight = 520;

}  // namespace lrb::run
