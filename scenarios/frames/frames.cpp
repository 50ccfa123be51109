#include "scenarios/frames/frames.hpp"

#include <algorithm>
#include <cmath>

#include "render/pictures/explain_picture.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/svg.hpp>

namespace lrb::run {
namespace {

/// The texts of all frames. They are laid out first, because they determine the size of the pictures, which
/// is the same in every frame.
struct Script {
  std::vector<render::Overlay> overlays;
  render::PixelRect picture;
};

render::OverlayLayout lay_out_frame(const render::Overlay& overlay, const render::FrameSpec& spec) try {
  return render::lay_out(overlay, spec.width, spec.height, static_cast<float>(spec.scale()));
} catch (const InputError& e) {
  throw InputError(std::string(e.what()) + " (--no-title, --no-legend); for print, use `lrbscope figure`");
}

Script write_script(FrameState& state, const std::vector<trace::EventId>& events, const std::string& title,
                    const render::FrameSpec& spec) {
  Script script;
  std::vector<render::LegendItem> key;
  for (const trace::EventId event : events) {
    state.seek(event);
    const render::Scene scene = state.scene();
    merge_key(key, scene.key);
    script.overlays.push_back(state.overlay(title));
    script.overlays.back().scale = scene.scale;
  }
  std::vector<render::OverlayLayout> layouts;
  for (render::Overlay& overlay : script.overlays) {
    overlay.key = key;
    leave_out_texts(overlay, spec);
    layouts.push_back(lay_out_frame(overlay, spec));
  }
  script.picture = render::common_picture(layouts);
  return script;
}

class Painter {
 public:
  Painter(const render::FrameSpec& spec, const render::PixelRect& picture, Framing framing)
      : spec_(spec), views_(spec.views), framing_(std::move(framing)) {
    if (views_.empty()) views_.emplace_back();
    places_ = view_places(picture, views_.size(), spec.scale());
    picture_ = render::Image(picture.width, picture.height);
  }

  /// `plain`: see FrameState::scene().
  const render::Image& paint(const FrameState& state, double progress, bool plain = false) {
    paint_views(
        rasterizer_, spec_, views_, places_,
        [&](const render::FrameSpec::View& view) { return state.scene(view.wrapper, plain).list; },
        [&](std::size_t view) { return camera(view, progress); }, picture_);
    return picture_;
  }

  std::vector<render::Camera> cameras(double progress) const {
    std::vector<render::Camera> out;
    for (std::size_t i = 0; i < views_.size(); ++i) out.push_back(camera(i, progress));
    return out;
  }

  /// Returns each view as SVG. `plain`: see FrameState::scene().
  std::vector<std::string> svgs(const FrameState& state, double progress, const std::string& title,
                                bool plain = false) const {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      render::SvgOptions options;
      options.width = places_[i].width;
      options.height = places_[i].height;
      options.title = title;
      options.units_per_pixel = spec_.scale();
      options.background = paper_of(spec_);
      out.push_back(render::svg(state.scene(views_[i].wrapper, plain).list, camera(i, progress), options));
    }
    return out;
  }

  /// Writes files named `name`.svg, or `name`_1.svg and so on.
  void write_svg(const FrameState& state, double progress, const std::string& name,
                 const std::string& title) const {
    const std::vector<std::string> all = svgs(state, progress, title);
    for (std::size_t i = 0; i < all.size(); ++i)
      io::write_text(name + (all.size() > 1 ? "_" + std::to_string(i + 1) : "") + ".svg", all[i]);
  }

 private:
  render::Camera camera(std::size_t view, double progress) const {
    const render::PixelRect& place = places_[view];
    return camera_for(views_[view], framing_, place.width, place.height, progress);
  }

  const render::FrameSpec& spec_;
  std::vector<render::FrameSpec::View> views_;
  std::vector<render::PixelRect> places_;
  Framing framing_;
  render::Rasterizer rasterizer_;
  render::Image picture_;
};

/// Data common to all frames of a run. There must be at least one event.
struct FrameJob {
  const render::FrameSpec& spec;
  std::vector<trace::EventId> events;
  FrameState state;
  Script script;
  Painter painter;

  FrameJob(const RecordedRun& p, const render::FrameSpec& s, std::vector<trace::EventId> at, Framing framing)
      : spec(s),
        events(std::move(at)),
        state(*p.trace, p.reps, results_of(p), s, s.at != render::FrameSpec::At::step,
              {p.trees, p.wrong, p.value_range, p.face_values, p.value_name}),
        script(write_script(state, events, p.title, s)),
        painter(s, script.picture, std::move(framing)) {}

  /// Returns the elapsed share of the sequence at frame i, for orbits.
  double passed(std::size_t i) const {
    return events.size() > 1 ? static_cast<double>(i) / static_cast<double>(events.size() - 1) : 0;
  }
  /// Draws frame i; `state` must be at its event.
  render::Image frame(std::size_t i) {
    const render::Rgba back = paper_of(spec).value_or(render::kTransparent);
    return render::compose_frame(painter.paint(state, passed(i)), script.picture, script.overlays[i],
                                 spec.width, spec.height, back, static_cast<float>(spec.scale()));
  }
};

Framing framing_of(const RecordedRun& p, const render::FrameSpec& spec) {
  return frame_sequence(p.reps, *p.trace, results_of(p), spec);
}

/// The panels of a montage, collected while the frames are drawn.
struct Montage {
  std::vector<render::Panel> panels;
  std::vector<std::string> svgs;  ///< for panels with one view; else empty

  std::vector<std::string> write(const RecordedRun& p, const render::FrameSpec& spec,
                                 const std::string& folder, const render::PngOptions& png,
                                 render::FrameWriter& writer) const {
    render::MontageOptions options;
    options.columns = static_cast<int>(spec.montage_columns);
    options.letters = panels.size() > 1;
    options.background = paper_of(spec).value_or(render::kTransparent);
    options.style = style_name(spec);
    std::vector<std::string> files = {"montage.png", "caption.txt"};
    writer.push(folder + "/montage.png", render::montage(panels, options), png);
    const std::string words = caption(p.purpose.empty() ? p.title + "." : p.purpose);
    io::write_text(folder + "/caption.txt", words + "\n");
    if (svgs.empty()) return files;
    render::SvgMontageOptions svg_options;
    svg_options.title = words;
    svg_options.transparent = spec.transparent;
    svg_options.style = style_name(spec);
    svg_options.units_per_pixel = spec.scale();
    io::write_text(folder + "/montage.svg",
                   render::svg_montage(svgs, render::lay_out(panels, options), svg_options));
    files.insert(files.begin() + 1, "montage.svg");
    return files;
  }

 private:
  /// Returns the caption to be printed under the figure.
  std::string caption(std::string text) const {
    for (std::size_t i = 0; i < panels.size(); ++i)
      text += (i == 0 ? " " : "; ") + (panels.size() > 1 ? render::panel_letter(i) + " " : "") +
              panels[i].caption;
    return text + ".";
  }
};

/// Throws InputError for colours or boxes that need a recorded tree traversal if there is none.
void check_colours(const RecordedRun& recorded, const render::FrameSpec& spec) {
  if (render::needed_level(spec) == EventLevel::faces) return;
  const std::string what = render::needed_level(spec.colour_by) == EventLevel::faces
                               ? std::string("boxes of tree nodes")
                               : "colours by " + std::string(name_of(spec.colour_by));
  if (recorded.reps.size() != 2)
    throw InputError(what + " need the trees of two bodies, but this run has one body");
  if (recorded.trace->header.request.recursion != Recursion::complete)
    throw InputError(what + " need the complete query; --recursion " +
                     std::string(name_of(recorded.trace->header.request.recursion)) + " does not use trees");
}

}  // namespace

const std::vector<CollideResult>& results_of(const RecordedRun& recorded) {
  static const std::vector<CollideResult> none;
  return recorded.results != nullptr ? *recorded.results : none;
}

void check_views(const std::vector<render::FrameSpec::View>& views, int dim) {
  if (dim == 2 && std::any_of(views.begin(), views.end(), [](const auto& view) { return view.directed; }))
    throw InputError(
        "--from, --up, --projection and --orbit: expected 3D bodies, found 2D bodies, which are always drawn "
        "from above; use --look-at and --zoom");
}

void check_frames(const RecordedRun& recorded, const render::FrameSpec& spec) {
  check_views(spec.views, recorded.reps[0]->dim());
  static_cast<void>(moments(spec, *recorded.trace));
  if (spec.svg && recorded.reps[0]->dim() != 2)
    throw InputError("SVG frames: expected 2D bodies, found 3D bodies; leave svg out, or set a higher --dpi");
  check_colours(recorded, spec);
  check_frame_size(spec);
}

void check_frame_size(const render::FrameSpec& spec) {
  constexpr int kMost = 8192;
  const render::FrameSpec in_file = in_pixels(spec);
  if (in_file.width > kMost || in_file.height > kMost)
    throw InputError("frames of " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                     " would have " + std::to_string(in_file.width) + "x" + std::to_string(in_file.height) +
                     " pixels at this dpi, more than 8192 per side; lower --dpi or --size");
}

std::vector<PaintedFrame> paint_frames(const RecordedRun& recorded, const render::FrameSpec& given,
                                       const ProgressReport& progress, const Framing* framing) {
  const render::FrameSpec spec = in_pixels(given);
  std::vector<PaintedFrame> out;
  const std::vector<trace::EventId> events = moments(spec, *recorded.trace);
  if (events.empty()) return out;
  FrameJob job(recorded, spec, events, framing != nullptr ? *framing : framing_of(recorded, spec));
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    job.state.seek(events[i]);
    out.push_back({job.frame(i), job.state.caption(), events[i], job.painter.cameras(job.passed(i))});
  }
  return out;
}

DrawnFrames draw_frames(const RecordedRun& recorded, const render::FrameSpec& given,
                        const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const ProgressReport& progress) {
  const render::FrameSpec spec = in_pixels(given);
  DrawnFrames out;
  make_folder(folder + "/frames");
  remove_old_frames(folder);
  const std::vector<trace::EventId> events = moments(spec, *recorded.trace);
  if (events.empty()) return out;

  FrameJob job(recorded, spec, events, framing_of(recorded, spec));
  FrameState& state = job.state;
  Painter& painter = job.painter;
  const std::vector<std::size_t> in_montage =
      spec.montage > 0 ? evenly(events.size(), spec.montage) : std::vector<std::size_t>();
  Montage together;
  render::FrameWriter writer;
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    state.seek(events[i]);
    const double passed = job.passed(i);
    if (spec.svg) painter.write_svg(state, passed, folder + "/" + numbered_frame(i), state.caption());
    render::PngOptions png{text, spec.dpi};
    png.text.emplace_back("lrbscope:event", std::to_string(events[i]));
    writer.push(folder + "/" + frame_file(i), job.frame(i), png);
    if (std::find(in_montage.begin(), in_montage.end(), i) != in_montage.end()) {
      together.panels.push_back({painter.paint(state, passed, true), state.short_caption()});
      if (spec.svg && spec.views.size() <= 1)
        together.svgs.push_back(painter.svgs(state, passed, state.caption(), true).front());
    }
    out.frames.push_back({frame_file(i), state.caption(), events[i], state.step()});
  }
  if (!together.panels.empty())
    out.montage = together.write(recorded, spec, folder, {text, spec.dpi}, writer);
  writer.finish();
  for (const trace::Step& step : recorded.trace->steps)
    if (step.result.separation) out.proved = &step;
  if (out.proved != nullptr)
    draw_separation(*recorded.reps[0], out.proved->pose_a, *recorded.reps[1], out.proved->pose_b,
                    *out.proved->result.separation, folder + "/" + kSeparationFile);
  return out;
}

}  // namespace lrb::run
