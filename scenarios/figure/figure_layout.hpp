#pragma once
/// Layout of a figure on paper: panels, key and caption; and the faces, regions and contacts that it points
/// out, by callouts with text and insets that enlarge them. Lengths are in points, x to the right, y down.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "render/canvas.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/render/image.hpp>
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

struct LayoutOptions {
  double width = 0;
  double font_size = 8;
  double margin = 1;        ///< around the content of each panel: space for the width of lines
  double grid = 0;          ///< panels begin and end on multiples of it: the size of a pixel of rasterised
                            ///< parts
  std::size_t columns = 0;  ///< 0: chosen to bring each block closest to 3:2
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

/// Paints legend and colour bar at their positions in the layout; both must be those that it was made for.
void paint_key(render::Canvas& canvas, const FigureLayout& layout,
               const std::vector<render::LegendItem>& legend, const std::optional<render::ScaleBar>& scale,
               const render::Style& style);

// Callouts and insets.

struct Target {
  enum class Kind : std::uint8_t { face, region, contact } kind = Kind::face;
  std::size_t body = 0;  ///< 0: A, 1: B
  std::uint32_t number = 0;
};

/// A target with a text beside it.
struct Callout {
  std::string option;  ///< as given, for messages
  std::string panel;   ///< letter; empty: all panels
  Target target;
  std::string text;  ///< empty: the target's name
};

/// A target that is shown enlarged below a panel.
struct Inset {
  std::string option;  ///< as given, for messages
  std::string panel;   ///< letter
  Target target;
  double magnification = 0;  ///< relative to the panel; 0: chosen by the target's size
};

/// Reads "[PANEL:]face:N[=TEXT]", or "region" instead of "face"; N is a number, or aN, bN. Throws InputError.
Callout parse_callout(const std::string& text);
/// Reads "PANEL:face:N[:MAGNIFICATION]", or "region", or "contact" without N. Throws InputError.
Inset parse_inset(const std::string& text);

/// Throws InputError with the prefix `option` if the bodies have no such face or region.
void check_target(const std::string& option, const Target& target, std::span<const LrbRep* const> reps);

/// Returns "face 12", "region 3 of B", "contact".
std::string name_of(const Target& target, std::size_t bodies);

/// Returns the outline of a face, or the border of a region's lids (2D: the whole region), as chains of
/// points that close if the last is the first.
std::vector<std::vector<Eigen::Vector3d>> outlines(const Target& target, const LrbRep& rep, const Pose& pose);

/// Returns the point of a face or region that a callout points to: the centroid of the face, or of the lid
/// closest to the lids' centre.
Eigen::Vector3d anchor(const Target& target, const LrbRep& rep, const Pose& pose);

/// A callout's text and leader in a panel, in points.
struct CalloutPlace {
  Eigen::Vector2d text{0, 0};    ///< centre
  Eigen::Vector2d leader{0, 0};  ///< end of the leader at the text; the other end is the anchor
  double covered = 0;            ///< share of the text that is over content
};

inline constexpr double kPlaceStep = 1.5;  ///< greatest step between places that are tried, points

/// Chooses places for texts in a box: beside the content, close to their anchors, without overlaps, and with
/// leaders that do not cross.
/// `content`: a picture of the part `panel` of the box, transparent where it is empty. `frames`: closed lines
/// that texts do not cover. `anchors`, `sizes`: one for each text. Each size must be smaller than the box.
std::vector<CalloutPlace> place_callouts(const Eigen::AlignedBox2d& box, const Eigen::AlignedBox2d& panel,
                                         const render::Image& content,
                                         const std::vector<std::vector<Eigen::Vector2d>>& frames,
                                         const std::vector<Eigen::Vector2d>& anchors,
                                         const std::vector<Eigen::Vector2d>& sizes);

}  // namespace lrb::figure
