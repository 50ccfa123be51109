#pragma once
/// What to draw, as plain data: the scene builder fills it in; the rasterizer, a printer or an SVG writer
/// reads it. Positions are in the world frame in double; widths, radii and text heights are in pixels of the
/// final image.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <lrbscope/render/style.hpp>

namespace lrb::render {

/// When a primitive is drawn, and what hides it; drawn in this order.
enum class Layer : std::uint8_t {
  opaque,       ///< hides and is hidden by depth; alpha is taken as 255
  translucent,  ///< hidden by what is opaque; several are blended in order of depth, pixel by pixel
  on_top,  ///< drawn over everything. Where something opaque lies in front it is ghosted: triangles fainter,
           ///< lines thinner and dashed, points as rings
};
inline constexpr int kLayers = 3;

inline constexpr std::uint32_t kNoId = std::numeric_limits<std::uint32_t>::max();

/// How the edges of triangles look.
struct EdgeStyle {
  Rgba colour{30, 30, 30, 255};
  float width = 1;  ///< pixels, over both faces of the edge: half is drawn on each
  float back = 1;   ///< factor of alpha on faces that show their back; width shrinks half as much
};

struct DrawTriangle {
  std::array<Eigen::Vector3d, 3> x{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Rgba colour;
  std::uint8_t edges = 0;       ///< bit i: the edge from corner i to corner i + 1 mod 3 is drawn
  std::uint8_t edge_style = 0;  ///< index into DrawList::edge_styles
  Layer layer = Layer::opaque;
  bool lit = true;           ///< shaded by its normal, flat over the whole triangle; else the colour as given
  std::int8_t nudge = 0;     ///< steps of kNudge towards the viewer, to tell apart what lies in one plane
  std::uint32_t id = kNoId;  ///< for the id pass
};

/// The interior of closed loops of segments in one plane, by the even-odd rule: any polygon, with holes; its
/// segments may come in any order. Painted in the order of the list before everything else, without depth:
/// for 2D bodies.
struct DrawFill {
  std::vector<std::array<Eigen::Vector3d, 2>> segments;
  Rgba colour;
  std::uint32_t id = kNoId;
};

/// A polyline of constant width with round joints and ends.
struct DrawLine {
  std::vector<Eigen::Vector3d> points;
  bool closed = false;
  Rgba colour;
  float width = 1;  ///< pixels
  float dash = 0;   ///< length of dashes and of the gaps between, in pixels; 0: solid
  Rgba halo = kTransparent;
  float halo_width = 0;  ///< pixels on each side of the line, under it
  Layer layer =
      Layer::opaque;  ///< translucent: drawn after the translucent triangles and hidden by opaque ones
  std::int8_t nudge = 4;
};

struct DrawPoint {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Rgba colour;
  float radius = 3;  ///< pixels
  Rgba halo = kTransparent;
  float halo_width = 0;
  Layer layer = Layer::opaque;
  std::int8_t nudge = 4;
};

/// Text beside a point; always on top.
struct DrawLabel {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  std::string text;  ///< UTF-8, one line
  Rgba colour = kBlack;
  float height = 14;     ///< of the font, pixels
  float dx = 0, dy = 0;  ///< from the point to the middle of the text, pixels, y down
  Rgba halo = kWhite;
};

struct DrawList {
  std::vector<EdgeStyle> edge_styles = std::vector<EdgeStyle>(1);  ///< the first is the default
  std::vector<DrawFill> fills;
  std::vector<DrawTriangle> triangles;
  std::vector<DrawLine> lines;
  std::vector<DrawPoint> points;
  std::vector<DrawLabel> labels;

  /// Returns the index of a style; adds it if there is no equal one. At most 256 styles (else InputError).
  std::uint8_t edge_style(const EdgeStyle& style);
  /// Adds a convex polygon as a fan, with its outline as edges.
  void add_polygon(const std::vector<Eigen::Vector3d>& corners, const DrawTriangle& like);
  void append(const DrawList& other);
  bool empty() const;
};

/// Returns the box around everything but labels; empty if there is nothing.
Eigen::AlignedBox3d bounds(const DrawList& list);

/// Returns every point of the list that a camera should show (labels left out).
std::vector<Eigen::Vector3d> extent_points(const DrawList& list);

/// Returns one line for each kind and layer, with number, ids and colours: for people, and for tests without
/// GL.
std::string summary(const DrawList& list);

}  // namespace lrb::render
