#pragma once
/// Draw lists: primitives as plain data, filled by the scene builder and read by the rasterizer, the summary
/// or the SVG writer. Positions are in the world frame, double; widths, radii and text heights are in pixels
/// of the final image.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <lrbscope/render/style.hpp>

namespace lrb::render {

/// Drawing order and occlusion of a primitive; drawn in this order.
enum class Layer : std::uint8_t {
  opaque,       ///< depth-tested; alpha is taken as 255
  translucent,  ///< hidden by opaque primitives; blended in order of depth, per pixel
  on_top,  ///< drawn over everything; ghosted behind opaque primitives: triangles fainter, lines thinner and
           ///< dashed, points as rings
};
inline constexpr int kLayers = 3;

inline constexpr std::uint32_t kNoId = std::numeric_limits<std::uint32_t>::max();

/// Style of triangle edges.
struct EdgeStyle {
  Rgba colour{30, 30, 30, 255};
  float width = 1;  ///< pixels, over both faces of the edge: each face shows half
  float back = 1;   ///< factor of alpha on back faces; width shrinks half as much
};

struct DrawTriangle {
  std::array<Eigen::Vector3d, 3> x{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Rgba colour;
  std::uint8_t edges = 0;  ///< bit i: the edge from corner i to corner i + 1 mod 3 is drawn
  /// Bit i: edge i is a border of a group of faces. With RasterOptions::even_edges it stays where faces are
  /// too small for their edges.
  std::uint8_t borders = 0;
  std::uint8_t edge_style = 0;  ///< index into DrawList::edge_styles
  Layer layer = Layer::opaque;
  bool lit = true;           ///< shaded by its normal, flat over the triangle; else the plain colour
  std::int8_t nudge = 0;     ///< offset towards the viewer in steps of kNudge, to order coplanar primitives
  std::uint32_t id = kNoId;  ///< for the id pass
};

/// The interior of closed loops of segments in one plane, by the even-odd rule: any polygon, with holes;
/// segments may be in any order. Painted in list order before everything else, without depth: for 2D bodies.
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
  float dash = 0;   ///< length of dashes and of gaps, pixels; 0: solid
  Rgba halo = kTransparent;
  float halo_width = 0;         ///< pixels on each side of the line, drawn under it
  Layer layer = Layer::opaque;  ///< translucent: drawn after translucent triangles and hidden by opaque ones
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
  float dx = 0, dy = 0;  ///< from the point to the centre of the text, pixels, y down
  Rgba halo = kWhite;
};

struct DrawList {
  std::vector<EdgeStyle> edge_styles = std::vector<EdgeStyle>(1);  ///< the first is the default
  std::vector<DrawFill> fills;
  std::vector<DrawTriangle> triangles;
  std::vector<DrawLine> lines;
  std::vector<DrawPoint> points;
  std::vector<DrawLabel> labels;

  /// Returns the index of a style, which is added if the list has no equal one. Throws InputError beyond 256
  /// styles.
  std::uint8_t edge_style(const EdgeStyle& style);
  /// Adds a polygon as its triangles (cut_polygon()), with its outline as edges. `borders`:
  /// DrawTriangle::borders of the polygon's edges; empty: none. `shape`: the corners in the frame of their
  /// body, where they are not rounded; empty: `corners`.
  void add_polygon(const std::vector<Eigen::Vector3d>& corners, const DrawTriangle& like,
                   const std::vector<bool>& borders = {}, const std::vector<Eigen::Vector3d>& shape = {});
  void append(const DrawList& other);
  bool empty() const;
};

/// Returns the bounding box of everything but labels; empty for an empty list.
Eigen::AlignedBox3d bounds(const DrawList& list);

/// Returns the points of the list that a camera should show (all but labels).
std::vector<Eigen::Vector3d> extent_points(const DrawList& list);

/// Returns one line per kind and layer, with number, ids and colours: for logs, and for tests without OpenGL.
std::string summary(const DrawList& list);

}  // namespace lrb::render
