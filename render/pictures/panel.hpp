#pragma once
/// What all pictures have in common: style, sizes, places of the views.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "render/pictures/frame_spec.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::run {

/// Return how frames look, and what is behind them; nothing where they are transparent.
render::StyleName style_name(const render::FrameSpec& spec);
const render::Style& style_of(const render::FrameSpec& spec);
std::optional<render::Rgba> paper_of(const render::FrameSpec& spec);

/// Leaves out of a frame's texts what is not asked for.
void leave_out_texts(render::Overlay& overlay, const render::FrameSpec& spec);

/// Returns the same frames with their size in pixels of the file.
render::FrameSpec in_pixels(render::FrameSpec spec);

/// Returns the views' places in a picture, side by side along its longer side.
std::vector<render::PixelRect> view_places(const render::PixelRect& picture, std::size_t views, double scale);

/// Draws each view, with its title, in its place of `picture`.
void paint_views(render::Rasterizer& rasterizer, const render::FrameSpec& spec,
                 const std::vector<render::FrameSpec::View>& views,
                 const std::vector<render::PixelRect>& places,
                 const std::function<render::DrawList(const render::FrameSpec::View&)>& list_of,
                 const std::function<render::Camera(std::size_t)>& camera_of, render::Image& picture);

/// Adds the items that `all` does not have yet.
void merge_key(std::vector<render::LegendItem>& all, const std::vector<render::LegendItem>& some);

/// Returns `wanted` indices below `count`, as evenly spaced as can be, first and last among them.
std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted);

// Where pictures are looked at from.

/// What the cameras of a whole sequence have to show, so that the picture stands still while the bodies move.
struct Framing {
  std::vector<Eigen::Vector3d> points;  ///< of both bodies, in all steps shown
  /// Corners of all contact regions, or of the faces of coarse answers. Empty: contact views show the whole.
  std::vector<Eigen::Vector3d> contacts;
  int dim = 3;
};

/// Returns a view's camera. `progress` in [0, 1] is the share of the sequence that has passed, for orbits.
render::Camera camera_for(const render::FrameSpec::View& view, const Framing& framing, double width,
                          double height, double progress);

/// Returns the box around a body's real faces.
Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose = {});
/// Returns the box around all of its vertices, those of lids among them.
Eigen::AlignedBox3d box_with_lids(const LrbRep& rep, const Pose& pose = {});

/// Returns a direction from which a box is seen from its longer level side, aslant and slightly from above.
/// `up` is an axis.
Eigen::Vector3d broadside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& up);

}  // namespace lrb::run
