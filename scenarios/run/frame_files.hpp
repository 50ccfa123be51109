#pragma once
/// What all pictures have in common: style, sizes, places of the views.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/image.hpp"
#include "render/overlay.hpp"
#include "render/rasterize.hpp"
#include "render/style.hpp"
#include "scenarios/run/frame_spec.hpp"

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

}  // namespace lrb::run
