#include "scenarios/frames/frames.hpp"

#include <algorithm>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/svg.hpp>

namespace lrb::frames {

namespace {

std::vector<render::Overlay> overlays_of(FrameState& state, const std::vector<trace::EventId>& events,
                                         const std::string& title) {
  std::vector<render::LegendItem> key;
  std::vector<render::Overlay> out;
  for (const trace::EventId event : events) {
    state.seek(event);
    const render::Scene scene = state.scene();
    pictures::merge_key(key, scene.key);
    out.push_back(state.overlay(title));
    out.back().scale = scene.scale;
  }
  for (render::Overlay& overlay : out) overlay.key = key;
  return out;
}

/// Draws the frames of a run: pictures of one size, with texts above and below them.
class FrameJob {
 public:
  /// Lays out the texts of all frames, which determine the size of the pictures; `events` is not empty.
  /// Throws InputError if they do not fit.
  FrameJob(const RecordedRun& p, const pictures::FrameSpec& spec, const std::vector<trace::EventId>& events,
           const pictures::Framing* framing = nullptr)
      : state(p, spec, spec.at != pictures::FrameSpec::At::step),
        look_(spec),
        framing_(framing != nullptr ? *framing : frame_sequence(p, spec)),
        overlays_(overlays_of(state, events, p.title)) {
    if (look_.views.empty()) look_.views.emplace_back();
    const auto scale = static_cast<float>(look_.scale());
    std::vector<render::OverlayLayout> layouts;
    try {
      for (render::Overlay& overlay : overlays_) {
        pictures::leave_out_texts(overlay, look_);
        layouts.push_back(render::lay_out(overlay, look_.width, look_.height, scale));
      }
    } catch (const InputError& e) {
      throw InputError(std::string(e.what()) +
                       " (--no-title, --no-legend); for print, use `lrbscope figure`");
    }
    place_ = render::common_picture(layouts);
  }

  /// Draws the views of the current state as frame i. `plain`: see FrameState::scene().
  render::Image picture(std::size_t i, bool plain = false) {
    std::vector<pictures::Panel> panels;
    for (const pictures::Look::View& view : look_.views) {
      // A panel of a montage is looked at alone: without a contact it shows where the bodies are nearest.
      std::vector<Eigen::Vector3d> nearest;
      if (plain && view.camera == pictures::FrameSpec::Camera::contact && !state.in_contact() &&
          state.reps().size() == 2)
        nearest =
            nearest_points({*state.reps()[0], state.pose(Side::a), *state.reps()[1], state.pose(Side::b)});
      const auto camera = [this, &view, nearest, i](double width, double height) {
        if (nearest.empty()) return pictures::camera_for(view, framing_, width, height, progress(i));
        pictures::Framing framing = framing_;
        framing.contacts = nearest;
        return pictures::camera_for(view, framing, width, height, progress(i));
      };
      panels.push_back({list(view, plain), camera, view.title});
    }
    return pictures::draw_row(rasterizer_, panels, look_, place_);
  }
  /// Draws frame i with its texts.
  render::Image frame(std::size_t i) {
    return render::compose_frame(picture(i), place_, overlays_[i], look_.width, look_.height,
                                 look_.background(), static_cast<float>(look_.scale()));
  }
  /// Returns the place of each view in the picture.
  std::vector<render::PixelRect> places() const {
    std::vector<render::PixelRect> out = pictures::panel_places(place_, look_.views.size(), look_.scale());
    for (render::PixelRect& r : out) r.x += place_.x, r.y += place_.y;
    return out;
  }
  /// Returns the camera of each view.
  std::vector<render::Camera> cameras(std::size_t i) const {
    std::vector<render::Camera> out;
    for (const render::PixelRect& r : places())
      out.push_back(pictures::camera_for(look_.views[out.size()], framing_, r.width, r.height, progress(i)));
    return out;
  }
  /// Returns each view as SVG (2D).
  std::vector<std::string> svgs(std::size_t i, bool plain = false) {
    const std::vector<render::Camera> all = cameras(i);
    const std::vector<render::PixelRect> where = places();
    std::vector<std::string> out;
    for (std::size_t view = 0; view < all.size(); ++view) {
      render::SvgOptions options;
      options.width = where[view].width;
      options.height = where[view].height;
      options.title = state.caption();
      options.units_per_pixel = look_.scale();
      options.background = look_.paper();
      render::DrawList drawn = list(look_.views[view], plain);
      const render::Projection projection(all[view], options.width, options.height, render::bounds(drawn));
      const Eigen::AlignedBox2d frame(Eigen::Vector2d(0, 0), Eigen::Vector2d(options.width, options.height));
      out.push_back(
          render::svg(pictures::with_leaders(std::move(drawn), projection, frame), all[view], options));
    }
    return out;
  }

  FrameState state;

 private:
  render::DrawList list(const pictures::Look::View& view, bool plain) const {
    return state.scene(view.wrapper, plain).list;
  }
  /// Returns the share of the sequence that has passed at frame i, for orbits.
  double progress(std::size_t i) const {
    return overlays_.size() > 1 ? static_cast<double>(i) / static_cast<double>(overlays_.size() - 1) : 0;
  }

  pictures::Look look_;
  pictures::Framing framing_;
  std::vector<render::Overlay> overlays_;
  render::PixelRect place_;
  render::Rasterizer rasterizer_;
};

/// The panels of a montage, collected while the frames are drawn.
struct Montage {
  std::vector<render::Panel> panels;
  std::vector<std::string> svgs;  ///< for panels with one view; else empty

  std::vector<std::string> write(const RecordedRun& p, const pictures::FrameSpec& spec,
                                 const std::string& folder, const render::PngOptions& png,
                                 render::FrameWriter& writer) const {
    render::MontageOptions options;
    options.columns = static_cast<int>(spec.montage_columns);
    options.letters = panels.size() > 1;
    options.background = spec.background();
    options.style = spec.style;
    std::vector<std::string> files = {"montage.png", "caption.txt"};
    writer.push(folder + "/montage.png", render::montage(panels, options), png);
    std::vector<std::string> texts;
    for (const render::Panel& panel : panels) texts.push_back(panel.caption);
    const std::string words = caption_of(p, texts);
    io::write_text(folder + "/caption.txt", words + "\n");
    if (svgs.empty()) return files;
    render::SvgMontageOptions svg_options;
    svg_options.title = words;
    svg_options.transparent = spec.transparent;
    svg_options.style = spec.style;
    svg_options.units_per_pixel = spec.scale();
    io::write_text(folder + "/montage.svg",
                   render::svg_montage(svgs, render::lay_out(panels, options), svg_options));
    files.insert(files.begin() + 1, "montage.svg");
    return files;
  }
};

/// Writes files called `name`.svg, or `name`_1.svg and so on.
void write_svgs(const std::vector<std::string>& views, const std::string& name) {
  for (std::size_t i = 0; i < views.size(); ++i)
    io::write_text(name + (views.size() > 1 ? "_" + std::to_string(i + 1) : "") + ".svg", views[i]);
}

/// Throws InputError for colours or boxes that need a recorded tree traversal if there is none.
void check_colours(const RecordedRun& recorded, const pictures::FrameSpec& spec) {
  if (pictures::needed_level(spec) == EventLevel::faces) return;
  const std::string what = pictures::needed_level(spec.colour_by) == EventLevel::faces
                               ? std::string("boxes of tree nodes")
                               : "colours by " + std::string(name_of(spec.colour_by));
  if (recorded.reps.size() != 2)
    throw InputError(what + " need the trees of two bodies, but this run has one body");
  if (recorded.trace->header.request.recursion != Recursion::complete)
    throw InputError(what + " need the complete query; --recursion " +
                     std::string(name_of(recorded.trace->header.request.recursion)) + " does not use trees");
}

}  // namespace

std::string caption_of(const RecordedRun& recorded, const std::vector<std::string>& panels) {
  std::string text = recorded.purpose.empty() ? recorded.title + "." : recorded.purpose;
  for (std::size_t i = 0; i < panels.size(); ++i)
    text += (i == 0 ? " " : "; ") + (panels.size() > 1 ? render::panel_letter(i) + " " : "") + panels[i];
  return text + ".";
}

const std::vector<CollideResult>& results_of(const RecordedRun& recorded) {
  static const std::vector<CollideResult> none;
  return recorded.results != nullptr ? *recorded.results : none;
}

void check_views(const std::vector<pictures::Look::View>& views, int dim) {
  if (dim == 2 && std::any_of(views.begin(), views.end(), [](const auto& view) { return view.directed; }))
    throw InputError(
        "--from, --up, --projection and --orbit: expected 3D bodies, found 2D bodies, which are always drawn "
        "from above; use --look-at and --zoom");
}

void check_frames(const RecordedRun& recorded, const pictures::FrameSpec& spec) {
  check_views(spec.views, recorded.reps[0]->dim());
  static_cast<void>(record::moments(spec, *recorded.trace));
  if (spec.svg && recorded.reps[0]->dim() != 2)
    throw InputError("SVG frames: expected 2D bodies, found 3D bodies; leave svg out, or set a higher --dpi");
  check_colours(recorded, spec);
  check_frame_size(spec);
}

void check_frame_size(const pictures::Look& spec) {
  // Pictures are drawn in twice the width and height, in buffers that Mesa limits to less than 2 GiB.
  constexpr int kMax = 8192, kMaxPixels = 48'000'000;
  pictures::Look in_file = spec;
  pictures::to_pixels(in_file);
  if (in_file.width <= kMax && in_file.height <= kMax && in_file.width * in_file.height <= kMaxPixels) return;
  const auto text = [](const pictures::Look& of) {
    return std::to_string(of.width) + "x" + std::to_string(of.height);
  };
  const bool scaled = in_file.width != spec.width;
  throw InputError("frames of " + text(spec) +
                   (scaled ? " with " + text(in_file) + " pixels at this dpi" : "") +
                   ": expected at most 8192 pixels per side and 48,000,000 in all; lower " +
                   (scaled ? "--dpi or --size" : "--size"));
}

namespace {

/// Returns the specification with sizes in pixels and, if it gives none, the view that a thin body needs.
pictures::FrameSpec completed(pictures::FrameSpec spec, const RecordedRun& recorded) {
  pictures::to_pixels(spec);
  if (const auto from = view_of_thin_body(recorded, spec)) spec.views.emplace_back().from = *from;
  return spec;
}

/// Returns the indices of the events in a montage: evenly spaced, but for a wrapper that is refined in equal
/// ratios of its faces, as in a figure, if there are enough events for that.
std::vector<std::size_t> panels_of(const RecordedRun& recorded, const std::vector<trace::EventId>& events,
                                   std::size_t count) {
  if (count == 0) return {};
  std::vector<double> faces;
  for (const trace::EventId e : events) {
    const trace::Event& event = recorded.trace->events[e];
    if (event.changes_wrapper())
      faces.push_back(event.boundary);
    else if (event.kind == EventKind::step)
      faces.push_back(static_cast<double>(recorded.reps[0]->outermost_faces().size()));
  }
  if (recorded.reps.size() == 1 && recorded.trace->steps.size() == 1 && faces.size() == events.size()) {
    std::vector<std::size_t> chosen = record::by_ratio(faces, count);
    if (std::adjacent_find(chosen.begin(), chosen.end(), std::greater_equal<>()) == chosen.end())
      return chosen;
  }
  return pictures::evenly(events.size(), count);
}

}  // namespace

std::vector<PaintedFrame> paint_frames(const RecordedRun& recorded, const pictures::FrameSpec& given,
                                       const record::ProgressReport& progress,
                                       const pictures::Framing* framing) {
  const pictures::FrameSpec spec = completed(given, recorded);
  std::vector<PaintedFrame> out;
  const std::vector<trace::EventId> events = record::moments(spec, *recorded.trace);
  if (events.empty()) return out;
  FrameJob job(recorded, spec, events, framing);
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    job.state.seek(events[i]);
    out.push_back({job.frame(i), job.state.caption(), events[i], job.cameras(i), job.places()});
  }
  return out;
}

DrawnFrames draw_frames(const RecordedRun& recorded, const pictures::FrameSpec& given,
                        const std::string& folder,
                        const std::vector<std::pair<std::string, std::string>>& text,
                        const record::ProgressReport& progress) {
  const pictures::FrameSpec spec = completed(given, recorded);
  DrawnFrames out;
  const std::vector<trace::EventId> events = record::moments(spec, *recorded.trace);
  std::optional<FrameJob> laid_out;  // before any file is written: frames may be too small
  if (!events.empty()) laid_out.emplace(recorded, spec, events);
  make_folder(folder + "/frames");
  record::remove_old_frames(folder);
  if (events.empty()) return out;

  FrameJob& job = *laid_out;
  FrameState& state = job.state;
  const std::vector<std::size_t> in_montage = panels_of(recorded, events, spec.montage);
  Montage together;
  render::FrameWriter writer;
  for (std::size_t i = 0; i < events.size(); ++i) {
    progress("draw", i, events.size());
    state.seek(events[i]);
    if (spec.svg) write_svgs(job.svgs(i), folder + "/" + record::numbered_frame(i));
    render::PngOptions png{text, spec.dpi};
    png.text.emplace_back("lrbscope:event", std::to_string(events[i]));
    writer.push(folder + "/" + record::frame_file(i), job.frame(i), png);
    if (std::find(in_montage.begin(), in_montage.end(), i) != in_montage.end()) {
      together.panels.push_back({job.picture(i, true), state.short_caption()});
      if (spec.svg && spec.views.size() <= 1) together.svgs.push_back(job.svgs(i, true).front());
    }
    out.frames.push_back({record::frame_file(i), state.caption(), events[i], state.step()});
  }
  if (!together.panels.empty())
    out.montage = together.write(recorded, spec, folder, {text, spec.dpi}, writer);
  writer.finish();
  for (const trace::Step& step : recorded.trace->steps)
    if (step.result.separation) out.proved = &step;
  if (out.proved != nullptr)
    pictures::write_picture(
        pictures::picture_of(*out.proved->result.separation,
                             {*recorded.reps[0], out.proved->pose_a, *recorded.reps[1], out.proved->pose_b}),
        folder + "/" + kSeparationFile);
  return out;
}

}  // namespace lrb::frames
