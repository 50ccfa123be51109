#pragma once
/// Layout of a figure on paper: panels, key and caption. Lengths are in points, x to the right, y down.

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "render/canvas.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::figure {

/// Empty space above and below a panel.
struct Space {
  double above = 0, below = 0;
};

/// Panels of one view, at one scale, in rows and columns that are aligned so that unmoved parts keep their
/// position.
struct Block {
  std::vector<Eigen::AlignedBox2d> seen;  ///< (panels) the bounding box of the content, in the view's own
                                          ///< units
  std::vector<std::string> texts;         ///< below each: letter and title; empty: no space is reserved
  std::vector<std::size_t> insets;        ///< number below each panel and its text; empty: none
  std::vector<Space> spaces;              ///< around each panel; empty: none
};

/// The side of the square, in units of the view, to which the camera of panels is fitted once, for
/// everything. Panels show parts of it.
inline constexpr double kViewSide = 1000;

/// Returns true if a panel's content extends beyond the view, as in a close-up.
bool runs_over(const Block& block);

struct LayoutOptions {
  double width = 0;
  double font_size = 8;
  double margin = 1;        ///< around the content of each panel: space for the width of lines
  double grid = 0;          ///< panels begin and end on multiples of it: the size of a pixel of rasterised
                            ///< parts
  std::size_t columns = 0;  ///< 0: chosen to bring each block closest to 3:2, from 150 mm to 5:2
};

struct PanelPlace {
  Eigen::AlignedBox2d box;  ///< of the panel on the paper
  Space space;              ///< around it
  Eigen::Vector2d
      seen_from;  ///< the point of the view, in its own units, at the box's corner plus the margin
  std::vector<std::string> lines;
  std::vector<Eigen::AlignedBox2d> insets;  ///< squares on the paper
};

struct BlockLayout {
  double scale = 1;  ///< points per unit of the view
  std::vector<PanelPlace> panels;
};

struct FigureLayout {
  double height = 0;
  double text_height = 0;  ///< ascent to descent
  std::vector<BlockLayout> blocks;
  struct Mark {
    Eigen::AlignedBox2d mark;
    Eigen::Vector2d text;  ///< left end of its centre line
  };
  std::vector<Mark> legend;                             ///< one for each entry
  std::optional<Eigen::AlignedBox2d> bar;               ///< the colour bar
  Eigen::Vector2d bar_text{0, 0};                       ///< centre of the bar's title, above it
  std::vector<std::pair<double, std::string>> caption;  ///< centre of each line, from the top, and the line
};

/// Lays a figure out. Empty parts take no space. Throws InputError if the width is too small for the columns
/// or for an entry of the legend.
FigureLayout lay_out(const std::vector<Block>& blocks, const std::vector<render::LegendItem>& legend,
                     const std::optional<render::ScaleBar>& scale, const std::string& caption,
                     const LayoutOptions& options);

inline constexpr double kPointsPerMm = 72 / 25.4;

/// Reads a length on paper, such as "85mm", "17.4cm", "3.3in" or "240pt", and returns it in points (1/72
/// inch). Throws InputError that names `option`, also for a length outside `least` to `most` points.
double parse_length(const std::string& text, const std::string& option, double least, double most);

/// Returns a length in points as text: "85 mm".
std::string length_text(double points);

/// Without pseudo faces in the figure, the legend need not say that faces are real.
void name_bodies_only(std::vector<render::LegendItem>& legend);

/// Paints legend and colour bar at their positions in the layout; both must be those that it was made for.
void paint_key(render::Canvas& canvas, const FigureLayout& layout,
               const std::vector<render::LegendItem>& legend, const std::optional<render::ScaleBar>& scale,
               const render::Style& style);

}  // namespace lrb::figure
