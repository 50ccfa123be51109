#pragma once
/// Code shared by the scene builders of 3D and 2D bodies.

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/render/scene.hpp>

namespace lrb::render {

// Parts of a 2D outline that enclose nothing visible: the outline runs along a line and back, closer than
// pixels. Wrappers have them where lids of overlapping extent are almost collinear.

using Segment2d = std::array<Eigen::Vector3d, 2>;  ///< directed; z is not used

/// Returns the parts of the segments that remain without hairs: where segments within `width` of each other
/// cancel, because as many run one way as the other, they are left out. Segments without hairs are returned
/// unchanged, in order.
std::vector<Segment2d> without_hairs(const std::vector<Segment2d>& segments, double width);

}  // namespace lrb::render

namespace lrb::render::scene {

/// The data needed to draw one body into a scene.
struct Context {
  const SceneBody& body;
  Side side;
  const SceneHighlight& highlight;
  const SceneOptions& options;
  double value_low, value_high;  ///< range of ColourBy::value
  std::uint32_t layers;          ///< maximum number of layers over all bodies: one scale for all
  Scene& out;

  std::string name() const;
  const Style& style() const { return style_of(options.style); }
  Rgba colour() const;  ///< of the body
  bool in_contact(FaceId f) const { return f < body.in_contact.size() && body.in_contact[f] != 0; }
  std::vector<FaceId> pseudo_in_contact() const;
  bool included(CellId cell) const { return body.wrapper != nullptr && body.wrapper->included(cell); }
  bool on_boundary(FaceId f) const { return body.wrapper != nullptr && body.wrapper->on_boundary(f); }
  const std::vector<RegionId>& isolated() const { return options.isolate[static_cast<std::size_t>(side)]; }
  const std::vector<RegionId>& refining() const { return highlight.refining[static_cast<std::size_t>(side)]; }
  bool isolating() const;  ///< Returns true if regions of either body are isolated.
  bool isolated(RegionId r) const;
  bool refining(RegionId r) const;
  bool building() const { return highlight.built.has_value(); }
  bool built(RegionId r) const;  ///< in the current event
  std::vector<Eigen::Vector3d> corners(FaceId f,
                                       const Eigen::Vector3d& moved = Eigen::Vector3d::Zero()) const;
  /// Returns the colour of a face by SceneOptions::colour_by; `cell` is the region it represents. If values
  /// are shown, faces without a value or with the lowest are pale, so that the others are prominent.
  Rgba colour_of(FaceId f, CellId cell) const;
  bool has_value(FaceId f) const { return f < body.face_values.size() && body.face_values[f] > value_low; }
  Rgba region_colour(RegionId r) const;
  /// Returns the colour of a region that a construction has just made.
  Rgba built_colour(RegionId r) const;
  Rgba wrapper_edge() const { return style().wrapper_edge(colour(), side); }
  void add_key(LegendItem::Mark mark, Rgba colour, const std::string& text,
               const std::optional<LegendItem::Swatch>& swatch = {}) const;
};

/// Share by which the colour of regions being refined fades in 2D, as a fill under lines.
inline constexpr double kRefining2d = 0.4;

void add_body_3d(const Context& c);
void add_body_2d(const Context& c);

/// A polyline of joined segments, as long as possible; closed if its ends join.
struct Chain {
  std::vector<VertexId> vertices;
  bool closed = false;
};
std::vector<Chain> chains(const std::vector<std::array<VertexId, 2>>& segments);

}  // namespace lrb::render::scene
