#pragma once
/// A figure for print: panels of one run, cropped to what is drawn and of one scale, for a width on paper.

#include <optional>
#include <string>

#include "scenarios/figure/figure_layout.hpp"
#include "scenarios/figure/figure_panels.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::figure {

struct FigureSpec {
  enum class Format : std::uint8_t { pdf, svg, png } format = Format::pdf;
  double width = 85 * kPointsPerMm;
  Choice choice;
  std::size_t columns = 0;   ///< 0: those that suit the panels
  double font_size = 8;      ///< points
  double line_width = 0.35;  ///< of a thin line, points; outlines and contacts are wider in proportion
  double dpi = 0;            ///< of what is drawn as pixels; 0: default_dpi()
  bool titles = false;       ///< below each panel what it shows; else its letter alone
  bool legend = true;        ///< one for all panels, or a colour bar
  bool caption = false;      ///< below the figure
};

/// The thinnest line that is drawn, in points: presses lose thinner ones.
inline constexpr double kHairline = 0.25;

/// Returns the format that a file's name asks for. Throws InputError for another.
FigureSpec::Format format_of(const std::string& path);
double default_dpi(FigureSpec::Format format);

struct Figure {
  std::string bytes;    ///< of the file
  std::string caption;  ///< the text to print below it
  std::size_t panels = 0;
  std::string left_out;  ///< what was asked for and is not shown, for people; empty: nothing
};

/// Draws the figure. `frames` says what colours mean, which regions are shown, and from where. Throws
/// InputError for what a figure cannot show.
Figure draw_figure(const run::RecordedRun& recorded, const render::FrameSpec& frames,
                   const FigureSpec& figure, const run::ProgressReport& progress);

}  // namespace lrb::figure
