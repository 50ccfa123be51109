#include "scenarios/play/frames.hpp"

#include <algorithm>
#include <cmath>

#include "engine/error.hpp"
#include "render/frame_writer.hpp"
#include "render/montage.hpp"
#include "render/rasterize.hpp"
#include "render/svg.hpp"
#include "render/svg_montage.hpp"
#include "scenarios/files.hpp"
#include "scenarios/play/frame_files.hpp"
#include "scenarios/play/framing.hpp"
#include "scenarios/play/moments.hpp"
#include "scenarios/play/separation_picture.hpp"
#include "scenarios/play/stage.hpp"

namespace lrb {
namespace {

/// Texts first, for all frames: they decide how much room the pictures get, which is the same in every frame.
struct Script {
  std::vector<Overlay> overlays;
  PixelRect picture;
};

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
    layouts.push_back(lay_out(overlay, spec.width, spec.height, static_cast<float>(spec.scale())));
  }
  script.picture = common_picture(layouts);
  return script;
}

class Painter {
 public:
  Painter(const FrameSpec& spec, const PixelRect& picture, Framing framing)
      : spec_(spec), views_(spec.views), framing_(std::move(framing)) {
    if (views_.empty()) views_.emplace_back();
    places_ = view_places(picture, views_.size(), spec.scale());
    picture_ = Image(picture.width, picture.height);
  }

  /// `plain`: see Stage::scene().
  const Image& paint(const Stage& stage, double progress, bool plain = false) {
    paint_views(
        rasterizer_, spec_, views_, places_,
        [&](const FrameSpec::View& view) { return stage.scene(view.wrapper, plain).list; },
        [&](std::size_t view) { return camera(view, progress); }, picture_);
    return picture_;
  }

  std::vector<Camera> cameras(double progress) const {
    std::vector<Camera> out;
    for (std::size_t i = 0; i < views_.size(); ++i) out.push_back(camera(i, progress));
    return out;
  }

  /// Each view as SVG. `plain`: see Stage::scene().
  std::vector<std::string> svgs(const Stage& stage, double progress, const std::string& title,
                                bool plain = false) const {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      SvgOptions options;
      options.width = places_[i].width;
      options.height = places_[i].height;
      options.title = title;
      options.units_per_pixel = spec_.scale();
      if (spec_.transparent) options.background.reset();
      out.push_back(svg(stage.scene(views_[i].wrapper, plain).list, camera(i, progress), options));
    }
    return out;
  }

  /// In files called `name`.svg, or `name`_1.svg and so on.
  void write_svg(const Stage& stage, double progress, const std::string& name,
                 const std::string& title) const {
    const std::vector<std::string> all = svgs(stage, progress, title);
    for (std::size_t i = 0; i < all.size(); ++i)
      write_text(name + (all.size() > 1 ? "_" + std::to_string(i + 1) : "") + ".svg", all[i]);
  }

 private:
  Camera camera(std::size_t view, double progress) const {
    const PixelRect& place = places_[view];
    return camera_for(views_[view], framing_, place.width, place.height, progress);
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
                         spec.height, back, static_cast<float>(spec.scale()));
  }
};

Framing framing_of(const Performance& p, const FrameSpec& spec) {
  return frame_sequence(p.reps, *p.trace, results_of(p), spec);
}

/// The panels of a montage, gathered while the frames are drawn.
struct Montage {
  std::vector<Panel> panels;
  std::vector<std::string> svgs;  ///< of panels with one view; else none

  std::vector<std::string> write(const Performance& p, const FrameSpec& spec, const std::string& folder,
                                 const PngOptions& png, FrameWriter& writer) const {
    MontageOptions options;
    options.columns = static_cast<int>(spec.montage_columns);
    options.letters = panels.size() > 1;
    if (spec.transparent) options.background = kTransparent;
    std::vector<std::string> files = {"montage.png", "caption.txt"};
    writer.push(folder + "/montage.png", montage(panels, options), png);
    const std::string words = caption(p.purpose.empty() ? p.title + "." : p.purpose);
    write_text(folder + "/caption.txt", words + "\n");
    if (svgs.empty()) return files;
    SvgMontageOptions svg_options;
    svg_options.title = words;
    svg_options.transparent = spec.transparent;
    svg_options.units_per_pixel = spec.scale();
    write_text(folder + "/montage.svg", svg_montage(svgs, lay_out(panels, options), svg_options));
    files.insert(files.begin() + 1, "montage.svg");
    return files;
  }

 private:
  /// What a paper prints under the figure.
  std::string caption(std::string text) const {
    for (std::size_t i = 0; i < panels.size(); ++i)
      text += (i == 0 ? " " : "; ") + (panels.size() > 1 ? panel_letter(i) + " " : "") + panels[i].caption;
    return text + ".";
  }
};

}  // namespace

void check_frames(const Performance& performance, const FrameSpec& spec) {
  static_cast<void>(moments(spec, *performance.trace, performance.milestones));
  if (spec.svg && performance.reps[0]->dim() != 2)
    throw InputError(
        "frames as SVG are for 2D bodies, and these are 3D: leave svg out, and ask for a higher --dpi");
  check_frame_size(spec);
}

void check_frame_size(const FrameSpec& spec) {
  constexpr int kMost = 8192;
  const FrameSpec in_file = in_pixels(spec);
  if (in_file.width > kMost || in_file.height > kMost)
    throw InputError("frames of " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                     " would have " + std::to_string(in_file.width) + "x" + std::to_string(in_file.height) +
                     " pixels at this dpi, and 8192 a side is the most: lower --dpi or --size");
}

std::vector<PaintedFrame> paint_frames(const Performance& performance, const FrameSpec& given,
                                       const ProgressReport& progress, const Framing* framing) {
  const FrameSpec spec = in_pixels(given);
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

DrawnFrames draw_frames(const Performance& performance, const FrameSpec& given, const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const ProgressReport& progress) {
  const FrameSpec spec = in_pixels(given);
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
  Montage together;
  FrameWriter writer;
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    stage.seek(events[i]);
    const double passed = production.passed(i);
    if (spec.svg) painter.write_svg(stage, passed, folder + "/" + numbered_frame(i), stage.caption());
    PngOptions png{text, spec.dpi};
    png.text.emplace_back("lrbscope:event", std::to_string(events[i]));
    writer.push(folder + "/" + frame_file(i), production.frame(i), png);
    if (std::find(in_montage.begin(), in_montage.end(), i) != in_montage.end()) {
      together.panels.push_back({painter.paint(stage, passed, true), stage.short_caption()});
      if (spec.svg && spec.views.size() <= 1)
        together.svgs.push_back(painter.svgs(stage, passed, stage.caption(), true).front());
    }
    out.frames.push_back({frame_file(i), stage.caption(), events[i], stage.step()});
  }
  if (!together.panels.empty())
    out.montage = together.write(performance, spec, folder, {text, spec.dpi}, writer);
  writer.finish();
  for (const trace::Step& step : performance.trace->steps)
    if (step.result.separation) out.proved = &step;
  if (out.proved != nullptr)
    draw_separation(*performance.reps[0], out.proved->pose_a, *performance.reps[1], out.proved->pose_b,
                    *out.proved->result.separation, folder + "/" + kSeparationFile);
  return out;
}

}  // namespace lrb
