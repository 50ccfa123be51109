#pragma once

#include <optional>
#include <vector>

#include "render/canvas.hpp"
#include "render/style.hpp"
#include "scenarios/figure/figure_layout.hpp"

namespace lrb::figure {

/// Paints legend and colour bar where the layout has them; both must be those that it was made for.
void paint_key(render::Canvas& canvas, const FigureLayout& layout,
               const std::vector<render::LegendItem>& legend, const std::optional<render::ScaleBar>& scale,
               const render::Style& style);

}  // namespace lrb::figure
