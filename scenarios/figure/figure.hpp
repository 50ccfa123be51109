#pragma once
/// A figure for print: panels of one run, cropped to their content and at one scale, for a width on paper.

#include <functional>
#include <string>
#include <vector>

#include "scenarios/figure/figure_layout.hpp"
#include "scenarios/figure/figure_panels.hpp"
#include "scenarios/figure/figure_targets.hpp"
#include "scenarios/frames/frames.hpp"

namespace lrb::figure {

struct FigureSpec {
  enum class Format : std::uint8_t { pdf, svg, png } format = Format::pdf;
  double width = 85 * kPointsPerMm;
  Choice choice;
  std::size_t columns = 0;   ///< 0: chosen for the panels
  double font_size = 8;      ///< points
  double line_width = 0.35;  ///< of a thin line, points; outlines and contacts are wider in proportion
  double dpi = 0;            ///< of rasterised parts; 0: default_dpi()
  /// Faces of 3D bodies are vector graphics if no panel has more visible ones than this, else an image.
  std::size_t vector_faces = 5000;
  bool titles = false;         ///< below each panel its description; else only its letter
  bool legend = true;          ///< one for all panels, or a colour bar
  bool caption = false;        ///< below the figure
  bool occlusion = false;      ///< 3D: darkens creases and gaps (ambient occlusion)
  bool contact_sheet = false;  ///< all views in one block of panels, for comparison; each has its own scale
  bool proof_map = false;      ///< a proof map instead of panels: draw_proof_map()
  std::vector<Callout> callouts;
  std::vector<Inset> insets;
};

/// The minimum line width, in points: printing presses lose thinner lines.
inline constexpr double kHairline = 0.25;

/// Returns the format for a file name's extension. Throws InputError for an unknown one.
FigureSpec::Format format_of(const std::string& path);
double default_dpi(FigureSpec::Format format);

struct Figure {
  std::string bytes;    ///< of the file
  std::string caption;  ///< text for print below the figure
  std::size_t panels = 0;
  std::vector<std::string> notes;  ///< on omitted states, faces that are an image, unseen callouts
};

/// Draws the figure. `frames` defines the meaning of colours, the visible regions and the viewpoint. Throws
/// InputError for requests that a figure cannot show.
Figure draw_figure(const frames::RecordedRun& recorded, const pictures::FrameSpec& frames,
                   const FigureSpec& figure, const record::ProgressReport& progress);

/// Draws the proof map of a step (proof_map.hpp): of the one in `figure.choice`, or of the last with a
/// traversal. Throws InputError if its traversal was not recorded.
Figure draw_proof_map(const frames::RecordedRun& recorded, const pictures::Look& look,
                      const FigureSpec& figure);

/// Returns the file of a page that `paint` paints, in points.
std::string figure_file(FigureSpec::Format format, double dpi, const render::PaperPage& page,
                        const std::function<void(render::Canvas&)>& paint);

}  // namespace lrb::figure
