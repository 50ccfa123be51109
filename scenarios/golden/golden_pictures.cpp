#include "scenarios/golden/golden_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "render/pictures/marks.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/frames/proof_map.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/report/assets.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/replay.hpp>

namespace lrb::golden {
namespace {

constexpr int kWidth = 1000, kHeight = 560;

/// Returns the step in which the runs begin to differ: the named one or, if they differ as a whole (the
/// request, the number of steps), that of the first differing event; else the last one that both have.
/// nullopt: one has no steps.
std::optional<std::size_t> step_of(const trace::Trace& x, const trace::Trace& y, const trace::Divergence& d,
                                   std::optional<trace::EventId>& event) {
  const std::size_t steps = std::min(x.steps.size(), y.steps.size());
  if (steps == 0) return std::nullopt;
  if (d.step) return std::min(*d.step, steps - 1);
  const auto [p, q] = std::mismatch(x.events.begin(), x.events.end(), y.events.begin(), y.events.end());
  if (p == x.events.end() || q == y.events.end()) return steps - 1;
  event = static_cast<trace::EventId>(p - x.events.begin());
  return std::min({x.step_of(*event), y.step_of(*event), steps - 1});
}

/// Returns the event of a run to show: the step's end if its step ended before.
trace::EventId event_to_show(const trace::Trace& trace, std::size_t step,
                             std::optional<trace::EventId> event) {
  const trace::EventId last = record::last_event(trace, step);
  return event ? std::min(*event, last) : last;
}

/// Returns the place in the first view of the vertex that moved farthest; nullopt if no body's mesh has the
/// same elements at other places.
std::optional<Eigen::Vector2d> place_of_moved_vertex(const Golden& golden, const GoldenRun& run,
                                                     const frames::PaintedFrame& frame) {
  trace::Cursor cursor(run.recording.trace, recorded_run_of(run).reps);
  cursor.seek(frame.event);
  for (std::size_t i = 0; i < std::min(golden.meshes.size(), run.recording.bodies.size()); ++i) {
    const Mesh mesh = run.recording.bodies[i].rep.real_mesh();
    std::optional<std::size_t> vertex;
    if (golden.meshes[i]) mesh_difference(*golden.meshes[i], mesh, &vertex);
    if (!vertex) continue;
    const Eigen::Vector3d x = cursor.pose(static_cast<Side>(i)).apply(mesh.vertices[*vertex]);
    const render::PixelRect& view = frame.places[0];
    const auto at = render::Projection(frame.cameras[0], view.width, view.height, {x, x}).to_pixel(x);
    if (at && view.contains({view.x + static_cast<int>(at->x()), view.y + static_cast<int>(at->y()), 1, 1}))
      return *at + Eigen::Vector2d(view.x, view.y);
  }
  return std::nullopt;
}

/// One of the two runs, which differ in their traces.
struct SideShown {
  const trace::Trace& trace;
  trace::EventId event;
};

/// Returns the corners of the element of an event: the pair that it compares, or the region that it refines.
std::vector<Eigen::Vector3d> subject_of(const SideShown& side, const std::vector<const LrbRep*>& reps) {
  trace::Cursor cursor(side.trace, reps);
  cursor.seek(side.event);
  std::vector<Eigen::Vector3d> out;
  if (const auto pair = cursor.pair_under_test())
    for (const Side s : {Side::a, Side::b})
      for (const Eigen::Vector3d& x : pictures::corners_of(*reps[static_cast<std::size_t>(s)], cursor.pose(s),
                                                           s == Side::a ? pair->simplex_a : pair->simplex_b))
        out.push_back(x);
  const trace::Event& e = cursor.event();
  if (e.changes_wrapper())
    for (const Eigen::Vector3d& x :
         pictures::region_corners(*reps[static_cast<std::size_t>(e.side)], e.region()))
      out.push_back(cursor.pose(e.side).apply(x));
  return out;
}

pictures::FrameSpec spec_for(const GoldenRun& run, bool close_up) {
  pictures::FrameSpec spec;
  spec.at = pictures::FrameSpec::At::events;
  spec.width = kWidth;
  spec.height = kHeight;
  pictures::Look::View whole;
  whole.from = run.scenario.frames.first_view().from;
  whole.up = run.scenario.frames.first_view().up;
  whole.title = "Whole, with wrappers";
  spec.views = {whole};
  if (close_up) {
    pictures::Look::View close = whole;
    close.camera = pictures::Look::Camera::contact;
    close.title = "Close up, with wrappers";
    spec.views.push_back(close);
  }
  return spec;
}

frames::PaintedFrame paint(const GoldenRun& run, const SideShown& side, pictures::FrameSpec spec,
                           const pictures::Framing& framing) {
  frames::RecordedRun p = recorded_run_of(run);
  p.trace = &side.trace;
  spec.events = {side.event};
  return frames::paint_frames(p, spec, record::kSilent, &framing).at(0);
}

bool same_bodies(const trace::Trace& x, const trace::Trace& y) {
  return std::ranges::equal(x.header.bodies, y.header.bodies, {}, &trace::BodyInfo::hash,
                            &trace::BodyInfo::hash);
}

/// Draws both runs at the first differing event, or at the end of its step; as a whole and in a close-up,
/// through the same cameras. Returns why there is nothing to draw, or which step is shown.
std::string draw_divergence(const Golden& golden, const GoldenRun& run, const trace::Divergence& divergence,
                            std::array<frames::PaintedFrame, 2>& out) {
  const trace::Trace &expected = golden.trace, &actual = run.recording.trace;
  if (!same_bodies(expected, actual))
    return "A body itself has changed: the approved run cannot be replayed on it.";
  std::optional<trace::EventId> event = divergence.event;
  const std::optional<std::size_t> step = step_of(expected, actual, divergence, event);
  if (!step) return "One of the runs has no step, so there is nothing to draw.";
  std::string note;
  if (expected.steps.size() != actual.steps.size() && !divergence.step)
    note = "The pictures are of step " + std::to_string(actual.steps[*step].index) +
           ", the last that both runs have.";
  const SideShown sides[2] = {{expected, event_to_show(expected, *step, event)},
                              {actual, event_to_show(actual, *step, event)}};
  const std::vector<const LrbRep*> reps = recorded_run_of(run).reps;
  try {
    // The cameras are fitted to this step alone: both runs' bodies, and the elements of both events.
    pictures::Framing framing = frames::frame_sequence(recorded_run_of(run), run.scenario.frames);
    framing.contacts.clear();
    for (const SideShown& side : sides)
      for (const Eigen::Vector3d& p : subject_of(side, reps)) framing.contacts.push_back(p);
    if (framing.contacts.empty() && *step < run.recording.results.size())
      framing.contacts = render::contact_points(run.recording.results[*step].regions);
    const pictures::FrameSpec spec = spec_for(run, !framing.contacts.empty());
    out = {paint(run, sides[0], spec, framing), paint(run, sides[1], spec, framing)};
  } catch (const InputError& e) {
    note = std::string("Cannot be drawn: ") + e.what();
  }
  return note;
}

report::PngBytes png_of(const render::Image& image) {
  return image.empty() ? report::PngBytes() : render::encode_png(image);
}

/// Returns a part of a picture of differences around the suspect, unless that is black, or else the
/// brightest; nullopt: all is black.
std::optional<render::PixelRect> brightest_square(const render::Image& image,
                                                  const std::optional<Eigen::Vector2d>& suspect) {
  constexpr int kMaxCells = 24, kSide = 3;  // across the picture, and across the square
  render::Image mean = image;
  int cell = 1;
  for (; mean.width() > kMaxCells; cell *= 2) mean = report::halved(mean);
  const int side = std::min({kSide * cell, image.width(), image.height()});
  const auto brightness = [&](int x, int y) {
    const render::Rgba c = mean.at(std::min(x, mean.width() - 1), std::min(y, mean.height() - 1));
    return c.r + c.g + c.b;
  };
  std::optional<Eigen::Vector2d> centre = suspect;
  if (suspect &&
      brightness(static_cast<int>(suspect->x()) / cell, static_cast<int>(suspect->y()) / cell) == 0)
    centre.reset();
  int most = centre ? 3 * 255 : 0;
  for (int y = 0; y < mean.height(); ++y)
    for (int x = 0; x < mean.width(); ++x)
      if (brightness(x, y) > most) {
        most = brightness(x, y);
        centre = Eigen::Vector2d(x + 0.5, y + 0.5) * cell;
      }
  if (!centre) return std::nullopt;
  const auto start = [&](double at, int end) {
    return std::clamp(static_cast<int>(at) - side / 2, 0, end - side);
  };
  return render::PixelRect{start(centre->x(), image.width()), start(centre->y(), image.height()), side, side};
}

/// Draws a circle around a square.
void circle(render::Image& image, const render::PixelRect& square) {
  const double radius = 0.6 * square.width, cx = square.x + square.width / 2.0,
               cy = square.y + square.height / 2.0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double off = std::abs(std::hypot(x - cx, y - cy) - radius);
      if (off < 3) image.at(x, y) = off < 1.5 ? render::palette::kWrong : render::kWhite;
    }
}

/// Returns the picture with a circle around what differs most, and that close up, as approved and as found.
/// Small.
render::Image thumbnail(const render::Image& expected, const render::Image& actual,
                        const std::optional<render::PixelRect>& place) {
  constexpr int kThumbnail = 320, kGap = 6;  // pixels
  render::Image whole = actual;
  if (place) circle(whole, *place);
  while (whole.width() >= 2 * kThumbnail) whole = report::halved(whole);
  if (!place) return whole;
  const int height = whole.height(), wide = height + kGap;
  render::Image out(whole.width() + 2 * wide, height, render::palette::kFaint);
  out.paste(whole, 0, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < height; ++x) {
      const int u = place->x + x * place->width / height, v = place->y + y * place->height / height;
      out.at(whole.width() + kGap + x, y) = expected.at(u, v);
      out.at(whole.width() + kGap + wide + x, y) = actual.at(u, v);
    }
  return out;
}

void add_comparison(GoldenResult& result, report::Comparison comparison, const render::Image& expected,
                    const render::Image& actual, bool is_best = false,
                    const std::optional<Eigen::Vector2d>& suspect = {}) {
  render::Image difference =
      expected.empty() || actual.empty() ? render::Image() : render::difference_image(expected, actual);
  std::optional<render::PixelRect> place;
  if (!comparison.passed && !actual.empty() && expected.rect() == actual.rect())
    place = brightest_square(difference, suspect);
  if (place) circle(difference, *place);
  comparison.pngs = {png_of(expected), png_of(actual), png_of(difference)};
  // A picture of the run, or its proof map, rather than of the first difference, which may only be a number.
  if (!comparison.passed && !actual.empty() && (result.thumbnail.empty() || is_best))
    result.thumbnail = png_of(thumbnail(expected, actual, place));
  result.comparisons.push_back(std::move(comparison));
}

}  // namespace

void add_divergence(GoldenResult& result, const Golden& golden, const GoldenRun& run) {
  std::array<frames::PaintedFrame, 2> pictures;
  const std::string note = draw_divergence(golden, run, *result.verdict.divergence, pictures);
  std::string text = result.verdict.divergence->message();
  for (const std::string& more : {result.verdict.diagnosis, note})
    if (!more.empty()) text += ". " + more;
  add_comparison(result,
                 {result.name + "-divergence",
                  result.name + ": first difference",
                  text,
                  false,
                  {},
                  {pictures[0].caption, pictures[1].caption}},
                 pictures[0].image, pictures[1].image);
}

void add_maps(GoldenResult& result, const Golden& golden, const GoldenRun& run) {
  constexpr int kSize = 480, kDot = 2;  // pixels
  std::optional<trace::EventId> event;
  frames::RecordedRun p = recorded_run_of(run);
  const trace::Trace* traces[] = {&golden.trace, p.trace};
  const auto step = step_of(*traces[0], *traces[1], *result.verdict.divergence, event);
  if (!step || !same_bodies(*traces[0], *traces[1])) return;
  render::Image squares[2];
  std::string text = "All pairs of a face of A (down) and one of B (across), in the order of their trees";
  for (std::size_t i = 0; i < 2; ++i) {
    p.trace = traces[i];
    const auto map = frames::proof_map(p, *step);
    if (!map || map->strays > 0 || map->size[0] == 0 || map->size[1] == 0) return;
    const Eigen::AlignedBox2d whole(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
    squares[i] = pixels_of(*map, render::style_of(render::StyleName::screen), whole, kSize, kDot);
    text += (i == 0 ? "; " : " in the approved run, ") + render::counted(map->cells.size(), "cell", "cells") +
            (i == 0 ? "" : " in this one");
  }
  add_comparison(
      result,
      {result.name + "-maps",
       result.name + ": proof maps of step " + std::to_string(traces[0]->steps[*step].index), text},
      squares[0], squares[1], true);
}

void add_image(GoldenResult& result, const Golden& golden, const GoldenRun& run, const ImageVerdict& v) {
  const std::string frame = std::filesystem::path(golden_image_file(v.frame)).stem().string();
  add_comparison(
      result, {result.name + "-" + frame, result.name + ": " + v.file, v.text, v.passed},
      v.has_expected ? golden.frames[v.frame][v.variant].png.image : render::Image(),
      v.has_actual ? run.frames[v.frame].image : render::Image(),
      std::ranges::none_of(
          result.comparisons,
          [](const report::Comparison& c) { return c.id.find("-frame_") != std::string::npos && !c.passed; }),
      !v.passed && v.has_actual ? place_of_moved_vertex(golden, run, run.frames[v.frame]) : std::nullopt);
}

}  // namespace lrb::golden
