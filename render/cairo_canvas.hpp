#pragma once
/// Canvases that become PDF or pixels, by cairo. Text is written with the fonts of text.hpp, which a PDF
/// holds.

#include <functional>
#include <optional>
#include <string>

#include "render/canvas.hpp"

namespace lrb::render {

inline constexpr double kPointsPerInch = 72;

struct PaperPage {
  double width = 0, height = 0;             ///< points
  std::optional<Rgba> background = kWhite;  ///< nothing: transparent
  std::string title;                        ///< in a PDF's properties; empty: none
  std::string creator;                      ///< the same: the program
};

/// Returns what `paint` paints, in points, as the bytes of a PDF. They do not tell when they were made, so
/// that they are the same each time. Throws EnvironmentError.
std::string paint_pdf(const PaperPage& page, const std::function<void(Canvas&)>& paint);

/// Returns the same in pixels, `dpi` of them to an inch; sizes are rounded up to whole ones.
Image paint_pixels(const PaperPage& page, double dpi, const std::function<void(Canvas&)>& paint);

}  // namespace lrb::render
