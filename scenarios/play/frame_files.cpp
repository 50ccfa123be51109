#include "scenarios/play/frame_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <system_error>

#include "render/palette.hpp"
#include "render/text.hpp"

namespace lrb {
namespace {

void write_title(Image& view, const std::string& title, const FrameSpec& spec) {
  TextStyle style;
  const auto scale = static_cast<float>(spec.scale());
  style.height = std::max(13.0F * scale, static_cast<float>(spec.height) / 42);
  style.colour = palette::kFaint;
  style.halo = kWhite;
  style.halo_width = 2 * scale;
  default_font().draw(view, title, static_cast<int>(style.height / 2), static_cast<int>(style.height / 3),
                      style);
}

}  // namespace

std::string numbered_frame(std::size_t frame) {
  std::ostringstream out;
  out << "frames/frame_" << std::setw(4) << std::setfill('0') << frame;
  return out.str();
}

std::string frame_file(std::size_t frame) {
  return numbered_frame(frame) + ".png";
}

void remove_old_frames(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/frames", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && (name.ends_with(".png") || name.ends_with(".svg")))
      std::filesystem::remove(entry.path(), error);
  }
  for (const char* file : {"/montage.png", "/montage.svg", "/caption.txt", "/separation.png"})
    std::filesystem::remove(folder + file, error);
}

FrameSpec in_pixels(FrameSpec spec) {
  spec.width = static_cast<int>(std::lround(spec.width * spec.scale()));
  spec.height = static_cast<int>(std::lround(spec.height * spec.scale()));
  return spec;
}

std::vector<PixelRect> view_places(const PixelRect& picture, std::size_t views, double scale) {
  const int gap = static_cast<int>(std::lround(4 * scale)), n = static_cast<int>(views);
  const bool columns = picture.width >= picture.height;
  const int whole = columns ? picture.width : picture.height, each = (whole - gap * (n - 1)) / n;
  std::vector<PixelRect> out;
  for (int i = 0; i < n; ++i) {
    const int at = i * (each + gap), size = i + 1 == n ? whole - at : each;
    out.push_back(columns ? PixelRect{at, 0, size, picture.height} : PixelRect{0, at, picture.width, size});
  }
  return out;
}

void paint_views(Rasterizer& rasterizer, const FrameSpec& spec, const std::vector<FrameSpec::View>& views,
                 const std::vector<PixelRect>& places,
                 const std::function<DrawList(const FrameSpec::View&)>& list_of,
                 const std::function<Camera(std::size_t)>& camera_of, Image& picture) {
  const Rgba back = spec.transparent ? kTransparent : kWhite;
  picture.pixels().assign(picture.pixels().size(),
                          views.size() > 1 && !spec.transparent ? palette::kRule : back);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PixelRect& place = places[i];
    RasterOptions options;
    options.width = place.width;
    options.height = place.height;
    options.supersample = spec.supersampling;
    if (spec.transparent) options.background.reset();
    Image view = rasterizer.draw(list_of(views[i]), camera_of(i), options);
    if (!views[i].title.empty()) write_title(view, views[i].title, spec);
    for (int y = 0; y < place.height; ++y)
      std::copy_n(&view.at(0, y), place.width, &picture.at(place.x, place.y + y));
  }
}

void merge_key(std::vector<LegendItem>& all, const std::vector<LegendItem>& some) {
  for (const LegendItem& item : some)
    if (std::none_of(all.begin(), all.end(),
                     [&](const LegendItem& known) { return known.text == item.text; }))
      all.push_back(item);
}

}  // namespace lrb
