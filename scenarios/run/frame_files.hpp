#pragma once
/// What all sequences of frames have in common: sizes, names, places of the views.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/image.hpp"
#include "render/overlay.hpp"
#include "render/rasterize.hpp"
#include "render/style.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

/// Returns "frames/frame_0012", and the same with ".png".
std::string numbered_frame(std::size_t frame);
std::string frame_file(std::size_t frame);

/// Return how frames look, and what is behind them; nothing where they are transparent.
render::StyleName style_name(const spec::FrameSpec& spec);
const render::Style& style_of(const spec::FrameSpec& spec);
std::optional<render::Rgba> paper_of(const spec::FrameSpec& spec);

/// Leaves out of a frame's texts what is not asked for.
void leave_out_texts(render::Overlay& overlay, const spec::FrameSpec& spec);

/// Removes what an earlier run left: frames, montage and its caption, certificate of separation.
void remove_old_frames(const std::string& folder);

/// Returns the same frames with their size in pixels of the file.
spec::FrameSpec in_pixels(spec::FrameSpec spec);

/// Returns the views' places in a picture, side by side along its longer side.
std::vector<render::PixelRect> view_places(const render::PixelRect& picture, std::size_t views, double scale);

/// Draws each view, with its title, in its place of `picture`.
void paint_views(render::Rasterizer& rasterizer, const spec::FrameSpec& spec,
                 const std::vector<spec::FrameSpec::View>& views,
                 const std::vector<render::PixelRect>& places,
                 const std::function<render::DrawList(const spec::FrameSpec::View&)>& list_of,
                 const std::function<render::Camera(std::size_t)>& camera_of, render::Image& picture);

/// Adds the items that `all` does not have yet.
void merge_key(std::vector<render::LegendItem>& all, const std::vector<render::LegendItem>& some);

}  // namespace lrb::run
