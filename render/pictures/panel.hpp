#pragma once
/// Panels: draws draw lists side by side, or in rows with captions, and fits the cameras.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "render/pictures/frame_spec.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::pictures {

using Mark = render::LegendItem::Mark;

/// Returns the camera for a picture of this size in pixels.
using CameraFit = std::function<render::Camera(double width, double height)>;

/// A draw list with its camera and title.
struct Panel {
  render::DrawList list;
  CameraFit camera;
  std::string title;
  bool even_edges = true;  ///< as RasterOptions
  render::Lighting lighting = {};
};

/// Lighting that shows the shape but hardly changes the colours of a scale.
inline const render::Lighting kScaleLighting{.ambient = 0.78, .head = 0.1, .key = 0.16, .fill = 0.05};

/// Draws a panel without its title.
render::Image draw_panel(render::Rasterizer& rasterizer, const Panel& panel, const pictures::Look& look,
                         int width, int height);

/// Returns the rectangles of panels in a picture, side by side along its longer side.
std::vector<render::PixelRect> panel_places(const render::PixelRect& picture, std::size_t panels,
                                            double scale);

/// Draws panels side by side, each with its title inside.
render::Image draw_row(render::Rasterizer& rasterizer, std::span<const Panel> panels,
                       const pictures::Look& look, const render::PixelRect& picture);

/// Draws panels side by side, between the texts of an overlay.
render::Image draw_panels(std::span<const Panel> panels, const render::Overlay& overlay,
                          const pictures::Look& look);

/// Draws panels of the look's size in rows, with letters and titles below them.
render::Image draw_sheet(std::span<const Panel> panels, const pictures::Look& look,
                         render::MontageOptions options = {});

/// Adds an overlay above and below a picture. The picture keeps its size.
render::Image with_overlay(const render::Image& picture, const render::Overlay& overlay, double scale = 1);

/// Clears the texts of a frame that `look` omits.
void leave_out_texts(render::Overlay& overlay, const pictures::Look& look);

/// Converts the size to pixels of the file.
void to_pixels(pictures::Look& look);

/// Writes a picture, and creates its folder. Throws EnvironmentError if it cannot be written.
void write_picture(const render::Image& picture, const std::string& path, double dpi = 0);

/// Adds the items whose text is not yet in `all`.
void merge_key(std::vector<render::LegendItem>& all, const std::vector<render::LegendItem>& some);

/// Returns `wanted` indices below `count`, as evenly spaced as possible, including the first and the last.
std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted);

// Cameras.

/// Returns cameras that show all points, from above in 2D.
CameraFit fit_points(std::vector<Eigen::Vector3d> points, int dim, const render::FitOptions& options = {});

/// The points that the cameras of a sequence show. They are constant, so that the picture does not move with
/// the bodies.
struct Framing {
  std::vector<Eigen::Vector3d> points;  ///< of both bodies, at all shown steps
  /// Corners of all contact regions, or of the faces of coarse answers. Empty: contact views show the whole.
  std::vector<Eigen::Vector3d> contacts;
  int dim = 3;
};

/// Returns a view's camera. `progress` in [0, 1] is the share of the sequence that has passed, for orbits.
render::Camera camera_for(const pictures::Look::View& view, const Framing& framing, double width,
                          double height, double progress = 0);

// Bodies.

/// Two posed bodies.
struct PosedBodies {
  const LrbRep& a;
  Pose pose_a;
  const LrbRep& b;
  Pose pose_b;

  int dim() const { return a.dim(); }
  /// Returns both bodies for a scene, without wrappers.
  std::vector<render::SceneBody> in_scene() const;
  /// Returns all points of the bodies that can be visible.
  std::vector<Eigen::Vector3d> points() const;
  std::string title() const { return a.name() + "  ·  " + b.name(); }
};

using render::corners_of;  // of a face
/// Returns the corners of all real faces, once for each face.
std::vector<Eigen::Vector3d> real_corners(const LrbRep& rep, const Pose& pose = {});
/// Returns the corners of a region's faces, once for each face.
std::vector<Eigen::Vector3d> region_corners(const LrbRep& rep, RegionId region);
/// Returns the box around a body's real faces.
Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose = {});
/// Returns the diagonal of the box around both bodies.
inline double size_of(const PosedBodies& bodies) {
  return box_of(bodies.a, bodies.pose_a).merged(box_of(bodies.b, bodies.pose_b)).diagonal().norm();
}

/// Returns the axis (0, 1, 2) that is likely to point up: the body is most stable on its lower end. Its
/// points near that end span the largest share of its outline from above, with its centre of mass over them.
/// Returns nullopt if it would fall over whichever axis is up.
std::optional<int> likely_up(const LrbRep& rep);

/// Returns a direction that shows a box from its longer horizontal side, obliquely and slightly from above.
/// `up` is an axis.
Eigen::Vector3d broadside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& up);

}  // namespace lrb::pictures
