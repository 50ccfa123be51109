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
      Image view = rasterizer_.draw(scene.list, camera(i, progress), options);
      if (!views_[i].title.empty()) write_title(view, views_[i].title);
      for (int y = 0; y < place.height; ++y)
        std::copy_n(&view.at(0, y), place.width, &picture_.at(place.x, place.y + y));
    }
    return picture_;
  }

  std::vector<Camera> cameras(double progress) const {
    std::vector<Camera> out;
    for (std::size_t i = 0; i < views_.size(); ++i) out.push_back(camera(i, progress));
    return out;
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
      const std::string number = views_.size() > 1 ? "_" + std::to_string(i + 1) : "";
      write_text(name + number + ".svg",
                 svg(stage.scene(views_[i].wrapper).list, camera(i, progress), options));
    }
  }

 private:
  Camera camera(std::size_t view, double progress) const {
    const PixelRect& place = places_[view];
    return camera_for(views_[view], framing_, place.width, place.height, progress);
  }

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

const std::vector<CollideResult>& results_of(const Performance& performance) {
  static const std::vector<CollideResult> kNoResults;
  return performance.results != nullptr ? *performance.results : kNoResults;
}

/// What all frames of a performance have in common. At least one event.
struct Production {
  const FrameSpec& spec;
  std::vector<trace::EventId> events;
  Stage stage;
  Script script;
  Painter painter;

  Production(const Performance& p, const FrameSpec& s, std::vector<trace::EventId> at, Framing framing)
      : spec(s),
        events(std::move(at)),
        stage(*p.trace, p.reps, results_of(p), s, p.milestones.empty() && s.at != FrameSpec::At::step),
        script(write_script(stage, events, p.title, s)),
        painter(s, script.picture, std::move(framing)) {}

  /// How much of the sequence has passed at frame i, for orbits.
  double passed(std::size_t i) const {
    return events.size() > 1 ? static_cast<double>(i) / static_cast<double>(events.size() - 1) : 0;
  }
  /// Frame i, at which the stage stands.
  Image frame(std::size_t i) {
    const Rgba back = spec.transparent ? kTransparent : kWhite;
    return compose_frame(painter.paint(stage, passed(i)), script.picture, script.overlays[i], spec.width,
                         spec.height, back);
  }
};

Framing framing_of(const Performance& p, const FrameSpec& spec) {
  return frame_sequence(p.reps, *p.trace, results_of(p), spec);
}

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

std::vector<PaintedFrame> paint_frames(const Performance& performance, const FrameSpec& spec,
                                       const ProgressReport& progress, const Framing* framing) {
  std::vector<PaintedFrame> out;
  const std::vector<trace::EventId> events = moments(spec, *performance.trace, performance.milestones);
  if (events.empty()) return out;
  Production production(performance, spec, events,
                        framing != nullptr ? *framing : framing_of(performance, spec));
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    production.stage.seek(events[i]);
    out.push_back({production.frame(i), production.stage.caption(), events[i],
                   production.painter.cameras(production.passed(i))});
  }
  return out;
}

DrawnFrames draw_frames(const Performance& performance, const FrameSpec& spec, const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const ProgressReport& progress) {
  DrawnFrames out;
  make_folder(folder + "/frames");
  remove_old_frames(folder);
  const std::vector<trace::EventId> events = moments(spec, *performance.trace, performance.milestones);
  if (events.empty()) return out;

  Production production(performance, spec, events, framing_of(performance, spec));
  Stage& stage = production.stage;
  Painter& painter = production.painter;
  const std::vector<std::size_t> in_montage =
      spec.montage > 0 ? evenly(events.size(), spec.montage) : std::vector<std::size_t>();
  std::vector<Panel> panels;
  FrameWriter writer;
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    stage.seek(events[i]);
    const double passed = production.passed(i);
    if (spec.svg) painter.write_svg(stage, passed, folder + "/" + numbered(i), stage.caption());
    PngOptions png;
    png.text = text;
    png.text.emplace_back("lrbscope:event", std::to_string(events[i]));
    writer.push(folder + "/" + file_name(i), production.frame(i), png);
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
