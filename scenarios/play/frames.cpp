#include "scenarios/play/frames.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "engine/error.hpp"
#include "render/frame_writer.hpp"
#include "render/montage.hpp"
#include "render/palette.hpp"
#include "render/rasterize.hpp"
#include "render/svg.hpp"
#include "render/text.hpp"
#include "scenarios/files.hpp"
#include "scenarios/play/framing.hpp"
#include "scenarios/play/moments.hpp"
#include "scenarios/play/stage.hpp"

namespace lrb {
namespace {

std::string numbered(std::size_t frame) {
  std::ostringstream out;
  out << "frames/frame_" << std::setw(4) << std::setfill('0') << frame;
  return out.str();
}

std::string file_name(std::size_t frame) {
  return numbered(frame) + ".png";
}

/// Texts first, for all frames: they decide how much room the pictures get, which is the same in every frame.
struct Script {
  std::vector<Overlay> overlays;
  PixelRect picture;
};

void merge_key(std::vector<LegendItem>& all, const std::vector<LegendItem>& some) {
  for (const LegendItem& item : some)
    if (std::none_of(all.begin(), all.end(),
                     [&](const LegendItem& known) { return known.text == item.text; }))
      all.push_back(item);
}

Script write_script(Stage& stage, const std::vector<trace::EventId>& events, const std::string& title,
                    const FrameSpec& spec) {
  Script script;
  std::vector<LegendItem> key;
  for (const trace::EventId event : events) {
    stage.seek(event);
    const Scene scene = stage.scene();
    merge_key(key, scene.key);
    script.overlays.push_back(stage.overlay(title));
    script.overlays.back().scale = scene.scale;
  }
  std::vector<OverlayLayout> layouts;
  for (Overlay& overlay : script.overlays) {
    overlay.key = key;
    layouts.push_back(lay_out(overlay, spec.width, spec.height));
  }
  script.picture = common_picture(layouts);
  return script;
}

/// The views' places in the picture, side by side along its longer side.
std::vector<PixelRect> places(const PixelRect& picture, std::size_t views) {
  constexpr int kGap = 4;
  const int n = static_cast<int>(views);
  const bool columns = picture.width >= picture.height;
  const int whole = columns ? picture.width : picture.height, each = (whole - kGap * (n - 1)) / n;
  std::vector<PixelRect> out;
  for (int i = 0; i < n; ++i) {
    const int at = i * (each + kGap), size = i + 1 == n ? whole - at : each;
    out.push_back(columns ? PixelRect{at, 0, size, picture.height} : PixelRect{0, at, picture.width, size});
  }
  return out;
}

class Painter {
 public:
  Painter(const FrameSpec& spec, const PixelRect& picture, Framing framing)
      : spec_(spec), views_(spec.views), framing_(std::move(framing)) {
    if (views_.empty()) views_.emplace_back();
    places_ = places(picture, views_.size());
    picture_ = Image(picture.width, picture.height);
  }

  /// `plain`: see Stage::scene().
  const Image& paint(const Stage& stage, double progress, bool plain = false) {
    const Rgba back = spec_.transparent ? kTransparent : kWhite;
    picture_.pixels().assign(picture_.pixels().size(),
                             views_.size() > 1 && !spec_.transparent ? palette::kRule : back);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const PixelRect& place = places_[i];
      RasterOptions options;
      options.width = place.width;
      options.height = place.height;
      options.supersample = spec_.supersampling;
      if (spec_.transparent) options.background.reset();
      const Scene scene = stage.scene(views_[i].wrapper, plain);
      Image view = rasterizer_.draw(
          scene.list, camera_for(views_[i], framing_, place.width, place.height, progress), options);
      if (!views_[i].title.empty()) write_title(view, views_[i].title);
      for (int y = 0; y < place.height; ++y)
        std::copy_n(&view.at(0, y), place.width, &picture_.at(place.x, place.y + y));
    }
    return picture_;
  }

  /// Each view as SVG, in files called `name`.svg, or `name`_1.svg and so on.
  void write_svg(const Stage& stage, double progress, const std::string& name,
                 const std::string& title) const {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      SvgOptions options;
      options.width = places_[i].width;
      options.height = places_[i].height;
      options.title = title;
      if (spec_.transparent) options.background.reset();
      const Camera camera = camera_for(views_[i], framing_, options.width, options.height, progress);
      const std::string number = views_.size() > 1 ? "_" + std::to_string(i + 1) : "";
      write_text(name + number + ".svg", svg(stage.scene(views_[i].wrapper).list, camera, options));
    }
  }

 private:
  void write_title(Image& view, const std::string& title) const {
    TextStyle style;
    style.height = std::max(13.0F, static_cast<float>(spec_.height) / 42);
    style.colour = palette::kFaint;
    style.halo = kWhite;
    style.halo_width = 2;
    default_font().draw(view, title, static_cast<int>(style.height / 2), static_cast<int>(style.height / 3),
                        style);
  }

  const FrameSpec& spec_;
  std::vector<FrameSpec::View> views_;
  std::vector<PixelRect> places_;
  Framing framing_;
  Rasterizer rasterizer_;
  Image picture_;
};

void remove_old_frames(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/frames", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && (name.ends_with(".png") || name.ends_with(".svg")))
      std::filesystem::remove(entry.path(), error);
  }
  std::filesystem::remove(folder + "/montage.png", error);
}

}  // namespace

DrawnFrames draw_frames(const Performance& performance, const FrameSpec& spec, const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const ProgressReport& progress) {
  DrawnFrames out;
  make_folder(folder + "/frames");
  remove_old_frames(folder);
  const std::vector<trace::EventId> events = moments(spec, *performance.trace, performance.milestones);
  if (events.empty()) return out;

  static const std::vector<CollideResult> kNoResults;
  const std::vector<CollideResult>& results =
      performance.results != nullptr ? *performance.results : kNoResults;
  const bool each_refinement = performance.milestones.empty() && spec.at != FrameSpec::At::step;
  Stage stage(*performance.trace, performance.reps, results, spec, each_refinement);
  const Script script = write_script(stage, events, performance.title, spec);
  Painter painter(spec, script.picture, frame_sequence(performance.reps, *performance.trace, results, spec));
  const std::vector<std::size_t> in_montage =
      spec.montage > 0 ? evenly(events.size(), spec.montage) : std::vector<std::size_t>();
  std::vector<Panel> panels;
  FrameWriter writer;
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    stage.seek(events[i]);
    const double passed =
        events.size() > 1 ? static_cast<double>(i) / static_cast<double>(events.size() - 1) : 0;
    if (spec.svg) painter.write_svg(stage, passed, folder + "/" + numbered(i), stage.caption());
    const Image& picture = painter.paint(stage, passed);
    PngOptions png;
    png.text = text;
    png.text.emplace_back("lrbscope:event", std::to_string(events[i]));
    const Rgba back = spec.transparent ? kTransparent : kWhite;
    writer.push(folder + "/" + file_name(i),
                compose_frame(picture, script.picture, script.overlays[i], spec.width, spec.height, back),
                png);
    if (std::find(in_montage.begin(), in_montage.end(), i) != in_montage.end()) {
      panels.push_back({painter.paint(stage, passed, true), stage.short_caption()});
    }
    out.frames.push_back({file_name(i), stage.caption(), events[i], stage.step()});
  }
  if (!panels.empty()) {
    MontageOptions options;
    options.columns = static_cast<int>(spec.montage_columns);
    PngOptions png;
    png.text = text;
    out.montage = "montage.png";
    writer.push(folder + "/" + out.montage, montage(panels, options), png);
  }
  writer.finish();
  return out;
}

}  // namespace lrb
