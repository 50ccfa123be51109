#include "scenarios/golden/divergence_picture.hpp"

#include <algorithm>
#include <optional>

#include "render/pictures/panel.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/trace/replay.hpp>

namespace lrb::golden {
namespace {

constexpr int kWidth = 1000, kHeight = 560;

const CollideResult* find_result(const GoldenRun& run, std::size_t step) {
  return step < run.recording.results.size() ? &run.recording.results[step] : nullptr;
}

/// Returns the step in which the runs begin to differ: the one that is named or, if they differ as a whole
/// (the request, the number of steps), that of the first event that differs.
std::optional<std::size_t> step_of(const trace::Trace& x, const trace::Trace& y, const trace::Divergence& d,
                                   std::optional<trace::EventId>& event) {
  if (d.step) return d.step;
  const auto [p, q] = std::mismatch(x.events.begin(), x.events.end(), y.events.begin(), y.events.end());
  if (p == x.events.end() || q == y.events.end()) return std::nullopt;
  event = static_cast<trace::EventId>(p - x.events.begin());
  return std::min(x.step_of(*event), y.step_of(*event));
}

/// Returns the event of a run to show: if its step ended before, that is the step's end.
trace::EventId event_to_show(const trace::Trace& trace, std::size_t step,
                             std::optional<trace::EventId> event) {
  const trace::EventId last = run::last_event(trace, step);
  return event ? std::min(*event, last) : last;
}

/// One of the two runs; they differ in their traces.
struct SideShown {
  const trace::Trace& trace;
  trace::EventId event;
};

/// Returns the corners of what an event is about: the pair that it compares, or the regions that it opens.
std::vector<Eigen::Vector3d> subject_of(const SideShown& side, const std::vector<const LrbRep*>& reps) {
  trace::Cursor cursor =
      reps.size() == 1 ? trace::Cursor(side.trace, *reps[0]) : trace::Cursor(side.trace, *reps[0], *reps[1]);
  cursor.seek(side.event);
  std::vector<Eigen::Vector3d> out;
  const auto add = [&](Side s, VertexId v) {
    out.push_back(cursor.pose(s).apply(reps[static_cast<std::size_t>(s)]->vertices()[v]));
  };
  if (const auto pair = cursor.pair_under_test()) {
    for (const Side s : {Side::a, Side::b}) {
      const LrbRep& rep = *reps[static_cast<std::size_t>(s)];
      VertexId corners[3];
      rep.simplex(s == Side::a ? pair->simplex_a : pair->simplex_b, corners);
      for (int i = 0; i < rep.simplex_size(); ++i) add(s, corners[i]);
    }
  }
  const trace::Event& e = cursor.event();
  if (e.changes_wrapper())
    for (const FaceId f : reps[static_cast<std::size_t>(e.side)]->collector(e.region()))
      for (const VertexId v : reps[static_cast<std::size_t>(e.side)]->face(f)) add(e.side, v);
  return out;
}

render::FrameSpec spec_for(const GoldenRun& run, bool close_up) {
  render::FrameSpec spec;
  spec.at = render::FrameSpec::At::events;
  spec.width = kWidth;
  spec.height = kHeight;
  render::FrameSpec::View whole;
  if (!run.scenario.frames.views.empty()) {  // look from where the scenario looks
    whole.from = run.scenario.frames.views[0].from;
    whole.up = run.scenario.frames.views[0].up;
  }
  whole.title = "Whole, with wrappers";
  spec.views = {whole};
  if (close_up) {
    render::FrameSpec::View close = whole;
    close.camera = render::FrameSpec::Camera::contact;
    close.title = "Close up, with wrappers";
    spec.views.push_back(close);
  }
  return spec;
}

run::PaintedFrame paint(const GoldenRun& run, const SideShown& side, render::FrameSpec spec,
                        const run::Framing& framing, const std::string& title) {
  run::RecordedRun p = recorded_run_of(run);
  p.title = run.scenario.name + ", " + title;
  p.trace = &side.trace;
  spec.events = {side.event};
  return run::paint_frames(p, spec, run::kSilent, &framing).at(0);
}

bool same_bodies(const trace::Trace& x, const trace::Trace& y) {
  const auto same = [](const trace::BodyInfo& p, const trace::BodyInfo& q) { return p.hash == q.hash; };
  return std::equal(x.header.bodies.begin(), x.header.bodies.end(), y.header.bodies.begin(),
                    y.header.bodies.end(), same);
}

}  // namespace

DivergencePictures draw_divergence(const Golden& golden, const GoldenRun& run,
                                   const trace::Divergence& divergence) {
  DivergencePictures out;
  const trace::Trace &expected = golden.trace, &actual = run.recording.trace;
  if (!same_bodies(expected, actual)) {
    out.note = "A body itself has changed: the approved run cannot be replayed on it.";
    return out;
  }
  std::optional<trace::EventId> event = divergence.event;
  const std::optional<std::size_t> step = step_of(expected, actual, divergence, event);
  if (!step || *step >= expected.steps.size() || *step >= actual.steps.size()) {
    out.note = "One run goes on where the other one ends: there is no event to draw on both sides.";
    return out;
  }
  const SideShown sides[2] = {{expected, event_to_show(expected, *step, event)},
                              {actual, event_to_show(actual, *step, event)}};
  const std::vector<const LrbRep*> reps = recorded_run_of(run).reps;
  try {
    // The cameras are fitted to this step alone: both runs' bodies, and what both events are about.
    run::Framing framing = run::frame_sequence(reps, actual, run.recording.results, run.scenario.frames);
    framing.contacts.clear();
    for (const SideShown& side : sides)
      for (const Eigen::Vector3d& p : subject_of(side, reps)) framing.contacts.push_back(p);
    if (const CollideResult* result = find_result(run, *step); framing.contacts.empty() && result != nullptr)
      framing.contacts = render::contact_points(result->regions);
    const render::FrameSpec spec = spec_for(run, !framing.contacts.empty());
    run::PaintedFrame pictures[2] = {paint(run, sides[0], spec, framing, "approved"),
                                     paint(run, sides[1], spec, framing, "found")};
    out.expected = std::move(pictures[0].image);
    out.actual = std::move(pictures[1].image);
    out.expected_caption = pictures[0].caption;
    out.actual_caption = pictures[1].caption;
  } catch (const InputError& e) {
    out.note = std::string("Cannot be drawn: ") + e.what();
  }
  return out;
}

}  // namespace lrb::golden
