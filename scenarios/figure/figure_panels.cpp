#include "scenarios/figure/figure_panels.hpp"

#include <algorithm>
#include <cmath>

#include "render/pictures/panel.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/replay.hpp>

namespace lrb::figure {
namespace {

using trace::EventId;

/// Candidate states, and the number of faces of their wrappers.
struct States {
  std::vector<EventId> events;
  std::vector<double> faces;
};

/// Returns the events after which a figure may show a state. One body: those that change its wrapper or end a
/// pass of its construction. Two bodies, or one that is refined several times: the ends of time steps.
std::vector<EventId> candidates(const frames::RecordedRun& recorded) {
  const trace::Trace& trace = *recorded.trace;
  if (trace.header.construction) {
    pictures::FrameSpec passes;
    passes.at = pictures::FrameSpec::At::pass;
    return record::moments(passes, trace);
  }
  std::vector<EventId> out;
  if (recorded.reps.size() == 1 && trace.steps.size() == 1) {
    for (EventId e = 0; e < trace.events.size(); ++e) {
      const EventKind kind = trace.events[e].kind;
      if (kind == EventKind::step || kind == EventKind::refine || kind == EventKind::coarsen)
        out.push_back(e);
    }
    return out;
  }
  for (std::size_t step = 0; step < trace.steps.size(); ++step)
    if (trace.steps[step].first_event < trace.events.size()) out.push_back(record::last_event(trace, step));
  return out;
}

States states(const frames::RecordedRun& recorded) {
  trace::Cursor cursor(*recorded.trace, recorded.reps);
  States out{candidates(recorded), {}};
  for (const EventId e : out.events) {
    cursor.seek(e);
    double faces = 0;
    for (std::size_t i = 0; i < recorded.reps.size(); ++i)
      faces += cursor.boundary_size(static_cast<Side>(i));
    out.faces.push_back(faces);
  }
  return out;
}

/// Returns evenly spaced time steps; the one nearest to the first contact is replaced by it.
std::vector<EventId> by_time(const frames::RecordedRun& recorded, const States& all, std::size_t panels) {
  const std::vector<trace::Step>& steps = recorded.trace->steps;
  std::vector<std::size_t> chosen = pictures::evenly(all.events.size(), panels);
  const auto contact = std::find_if(
      steps.begin(), steps.end(), [](const trace::Step& s) { return s.finished && s.result.pair_count > 0; });
  const auto first = static_cast<std::size_t>(contact - steps.begin());
  if (first < all.events.size() && chosen.size() > 2) {
    const auto deviation = [&](std::size_t i) { return i > first ? i - first : first - i; };
    *std::min_element(chosen.begin() + 1, chosen.end() - 1,
                      [&](std::size_t x, std::size_t y) { return deviation(x) < deviation(y); }) = first;
  }
  std::vector<EventId> out;
  for (const std::size_t i : chosen) out.push_back(all.events[i]);
  return out;
}

std::vector<EventId> by_layer(const frames::RecordedRun& recorded) {
  if (recorded.reps.size() != 1)
    throw InputError("--layers: is for a run of one body; of two, --steps and --events choose panels");
  const LrbRep& rep = *recorded.reps[0];
  std::vector<EventId> last(rep.layer_count(), 0);
  for (EventId e = 0; e < recorded.trace->events.size(); ++e) {
    const trace::Event& event = recorded.trace->events[e];
    if (event.kind == EventKind::refine) last[rep.layer(event.region())] = e;
  }
  last.push_back(0);  // the outermost wrapper
  return last;
}

/// Reduces the states to kMaxPanels evenly spaced ones, if there are more.
void thin_layers(Chosen& chosen) {
  const std::vector<EventId> all = chosen.events;
  if (all.size() <= kMaxPanels) return;
  chosen.events.clear();
  for (const std::size_t i : pictures::evenly(all.size(), kMaxPanels)) chosen.events.push_back(all[i]);
  chosen.left_out = std::to_string(kMaxPanels) + " of " + std::to_string(all.size()) +
                    " panels are shown, evenly chosen; --events shows others";
}

std::vector<EventId> by_steps(const trace::Trace& trace, const std::vector<std::uint32_t>& numbers) {
  std::vector<EventId> out;
  for (const std::uint32_t number : numbers) {
    const auto step = std::find_if(trace.steps.begin(), trace.steps.end(),
                                   [&](const trace::Step& s) { return s.index == number; });
    if (step == trace.steps.end() || step->first_event >= trace.events.size())
      throw InputError("--steps: the run has no time step " + std::to_string(number) + ": it has " +
                       std::to_string(trace.steps.front().index) + " to " +
                       std::to_string(trace.steps.back().index));
    out.push_back(record::last_event(trace, static_cast<std::size_t>(step - trace.steps.begin())));
  }
  return out;
}

std::vector<EventId> by_events(const trace::Trace& trace, const std::vector<std::uint32_t>& numbers) {
  for (const std::uint32_t e : numbers)
    if (e >= trace.events.size())
      throw InputError("--events: the run has no event " + std::to_string(e) + ": it ends with event " +
                       std::to_string(trace.events.size() - 1));
  return numbers;
}

}  // namespace

Chosen choose(const frames::RecordedRun& recorded, const Choice& choice) {
  const trace::Trace& trace = *recorded.trace;
  if (trace.events.empty()) throw InputError("figure: expected a run with events, found one without");
  const std::size_t panels = choice.panels > 0 ? choice.panels : recorded.reps.size() == 1 ? 6 : 4;
  Chosen chosen;
  std::vector<EventId>& out = chosen.events;
  switch (choice.by) {
    case Choice::By::changes: {
      const States all = states(recorded);
      if (recorded.reps.size() == 1 && trace.steps.size() == 1)
        for (const std::size_t i : record::by_ratio(all.faces, panels)) out.push_back(all.events[i]);
      else
        out = by_time(recorded, all, panels);
      break;
    }
    case Choice::By::layers:
      out = by_layer(recorded);
      break;
    case Choice::By::faces: {
      const States all = states(recorded);
      for (const std::uint32_t faces : choice.numbers)
        out.push_back(all.events[record::nearest_by_ratio(all.faces, std::max(faces, 1U))]);
      break;
    }
    case Choice::By::events:
      out = by_events(trace, choice.numbers);
      break;
    case Choice::By::steps:
      out = by_steps(trace, choice.numbers);
      break;
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (choice.by == Choice::By::layers) thin_layers(chosen);
  return chosen;
}

namespace {

/// Returns true if two panels of the same size cannot be distinguished when printed in grey: almost no pixel
/// of their content has a visibly different lightness.
bool alike_in_grey(const render::Image& a, const render::Image& b) {
  constexpr double kVisible = 24;  // difference of luma that the eye sees between areas of a few pixels
  // Of the content. Figures at 85 mm: 0.014 between the fourth and the fifth panel of figure2, where a few
  // teeth differ; 0.15 or more between panels of meshes.
  constexpr double kShare = 0.01;
  if (a.rect() != b.rect()) return false;
  std::size_t content = 0, different = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    const double x = render::luma(render::over(a.pixels()[i], render::kWhite)),
                 y = render::luma(render::over(b.pixels()[i], render::kWhite));
    if (x < 255 || y < 255) ++content;
    if (std::abs(x - y) > kVisible) ++different;
  }
  return static_cast<double>(different) < kShare * static_cast<double>(content);
}

}  // namespace

std::vector<std::size_t> distinct_states(const std::vector<std::vector<render::Image>>& seen) {
  std::vector<std::size_t> kept;
  std::size_t last_kept = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto &a = seen[last_kept], &b = seen[i];
    if (i > 0 && std::equal(a.begin(), a.end(), b.begin(), b.end(), alike_in_grey)) {
      if (i + 1 < seen.size() || kept.size() == 1) continue;
      kept.pop_back();
    }
    kept.push_back(i);
    last_kept = i;
  }
  return kept;
}

std::string shortened(std::string text) {
  const std::string none = ": 0 intersecting pairs of faces";
  if (text.ends_with(none)) text.resize(text.size() - none.size());
  if (const std::size_t at = text.find(">="); at != std::string::npos) text.replace(at, 2, "\u2265");
  return text;
}

std::string title_of(std::string caption) {
  constexpr std::string_view kLong = " intersecting", kFaces = " of faces", kUsual = "crossing, ";
  const std::size_t number_end = caption.find(kLong);
  if (number_end == std::string::npos) return caption;
  if (const std::size_t at = caption.find(kFaces, number_end); at != std::string::npos)
    caption.erase(at, kFaces.size());
  caption.erase(number_end, kLong.size());
  caption.replace(caption.rfind(": ", number_end), 2, ", ");
  if (const std::size_t at = caption.find(kUsual); at != std::string::npos) caption.erase(at, kUsual.size());
  return caption;
}

Eigen::AlignedBox2d seen_box(const render::DrawList& list, const render::Camera& camera) {
  const Eigen::AlignedBox2d square(Eigen::Vector2d(0, 0), Eigen::Vector2d(kViewSide, kViewSide));
  const render::Projection projection(camera, kViewSide, kViewSide, render::bounds(list));
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& x : render::extent_points(list)) {
    const auto at = projection.to_pixel(x);
    if (!at) return square;
    box.extend(*at);
  }
  box = box.intersection(square);
  const bool empty = box.isEmpty() || !(box.sizes().minCoeff() > 0);
  return empty ? square : box;
}

render::Camera part_of(const render::Camera& camera, const Eigen::AlignedBox2d& part) {
  render::Camera out = camera;
  const double share = part.sizes().y() / kViewSide, tangent = std::tan(0.5 * camera.fov_y);
  const Eigen::Vector2d offset =
      (2 * part.center() - Eigen::Vector2d::Constant(kViewSide)) / kViewSide;  // in half sides, y down
  out.half_height *= share;
  out.fov_y = 2 * std::atan(tangent * share);
  out.shift +=
      (camera.orthographic ? camera.half_height : tangent) * Eigen::Vector2d(offset.x(), -offset.y());
  return out;
}

}  // namespace lrb::figure
