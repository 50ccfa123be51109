#include "scenarios/run/frame_files.hpp"

#include <algorithm>
#include <cmath>

#include "render/text.hpp"

namespace lrb::run {
namespace {

void write_title(render::Image& view, const std::string& title, const render::FrameSpec& spec) {
  render::TextStyle style;
  const auto scale = static_cast<float>(spec.scale());
  style.height = std::max(13.0F * scale, static_cast<float>(spec.height) / 42);
  style.colour = style_of(spec).faint;
  style.halo = style_of(spec).paper;
  style.halo_width = 2 * scale;
  render::default_font().draw(view, title, static_cast<int>(style.height / 2),
                              static_cast<int>(style.height / 3), style);
}

}  // namespace

render::StyleName style_name(const render::FrameSpec& spec) {
  switch (spec.style) {
    case render::FrameSpec::Style::print:
      return render::StyleName::print;
    case render::FrameSpec::Style::dark:
      return render::StyleName::dark;
    case render::FrameSpec::Style::screen:
      break;
  }
  return render::StyleName::screen;
}

const render::Style& style_of(const render::FrameSpec& spec) {
  return render::style_of(style_name(spec));
}

std::optional<render::Rgba> paper_of(const render::FrameSpec& spec) {
  return spec.transparent ? std::nullopt : std::optional(style_of(spec).paper);
}

void leave_out_texts(render::Overlay& overlay, const render::FrameSpec& spec) {
  if (!spec.titles) {
    overlay.title.clear();
    overlay.event.clear();
    overlay.event_colour = render::kTransparent;
    overlay.counters.clear();
  }
  if (!spec.legend) {
    overlay.key.clear();
    overlay.scale.reset();
  }
}

render::FrameSpec in_pixels(render::FrameSpec spec) {
  spec.width = static_cast<int>(std::lround(spec.width * spec.scale()));
  spec.height = static_cast<int>(std::lround(spec.height * spec.scale()));
  return spec;
}

std::vector<render::PixelRect> view_places(const render::PixelRect& picture, std::size_t views,
                                           double scale) {
  const int gap = static_cast<int>(std::lround(4 * scale)), n = static_cast<int>(views);
  const bool columns = picture.width >= picture.height;
  const int whole = columns ? picture.width : picture.height, each = (whole - gap * (n - 1)) / n;
  std::vector<render::PixelRect> out;
  for (int i = 0; i < n; ++i) {
    const int at = i * (each + gap), size = i + 1 == n ? whole - at : each;
    out.push_back(columns ? render::PixelRect{at, 0, size, picture.height}
                          : render::PixelRect{0, at, picture.width, size});
  }
  return out;
}

void paint_views(render::Rasterizer& rasterizer, const render::FrameSpec& spec,
                 const std::vector<render::FrameSpec::View>& views,
                 const std::vector<render::PixelRect>& places,
                 const std::function<render::DrawList(const render::FrameSpec::View&)>& list_of,
                 const std::function<render::Camera(std::size_t)>& camera_of, render::Image& picture) {
  picture.pixels().assign(picture.pixels().size(), views.size() > 1 && !spec.transparent
                                                       ? style_of(spec).rule
                                                       : paper_of(spec).value_or(render::kTransparent));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const render::PixelRect& place = places[i];
    render::RasterOptions options;
    options.width = place.width;
    options.height = place.height;
    options.supersample = spec.supersampling;
    options.background = paper_of(spec);
    options.even_edges = true;
    render::Image view = rasterizer.draw(list_of(views[i]), camera_of(i), options);
    if (spec.titles && !views[i].title.empty()) write_title(view, views[i].title, spec);
    for (int y = 0; y < place.height; ++y)
      std::copy_n(&view.at(0, y), place.width, &picture.at(place.x, place.y + y));
  }
}

void merge_key(std::vector<render::LegendItem>& all, const std::vector<render::LegendItem>& some) {
  for (const render::LegendItem& item : some)
    if (std::none_of(all.begin(), all.end(),
                     [&](const render::LegendItem& known) { return known.text == item.text; }))
      all.push_back(item);
}

std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> out;
  wanted = std::min(count, wanted);
  for (std::size_t i = 0; i < wanted; ++i)
    out.push_back(wanted == 1 ? count - 1 : i * (count - 1) / (wanted - 1));
  return out;
}

}  // namespace lrb::run
