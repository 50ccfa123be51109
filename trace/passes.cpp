#include "trace/passes.hpp"

#include <algorithm>
#include <cmath>

namespace lrb::trace {

namespace {

using Caps = std::array<std::uint32_t, kWords<CapVerdict>.size()>;

PassSummary begin_pass(EventId id, const Event& e, std::uint32_t faces) {
  PassSummary p;
  p.first = p.last = id;
  p.stage = e.stage();
  p.layer = e.a;
  p.barred = e.b;
  p.most_off = e.off();
  p.faces_before = p.faces_after = faces;
  return p;
}

void take_cap(PassSummary& p, const Event& e, const Event* tried_before) {
  // A second cap over the same patch replaces the verdict of the first.
  if (tried_before) {
    --p.caps[tried_before->detail];
    ++p.retried;
  }
  ++p.caps[e.detail];
  if (e.verdict() != CapVerdict::stands) return;
  p.lids += e.a;
  p.covered += e.b;
  if (std::isfinite(e.off())) p.off = std::max(p.off, e.off());
}

void take(PassSummary& p, EventId id, const Trace& trace) {
  const Event& e = trace.events[id];
  p.last = id;
  switch (e.kind) {
    case EventKind::patch:
      ++p.patches;
      break;
    case EventKind::cap: {
      const Event& before = trace.events[id - 1];
      take_cap(p, e, before.kind == EventKind::cap ? &before : nullptr);
      break;
    }
    case EventKind::region:
      ++p.regions;
      p.faces_after = e.boundary;
      break;
    case EventKind::merged:
      p.merged += e.b;
      break;
    case EventKind::pass_end:
      p.no_patch = e.a;
      p.waiting = e.b;
      p.given_up = e.depth_a != 0;
      p.faces_after = e.boundary;
      break;
    default:
      break;
  }
}

/// Returns the verdicts that refuse caps, most frequent first.
std::vector<std::size_t> by_frequency(const Caps& caps) {
  std::vector<std::size_t> order;
  for (std::size_t v = 1; v < caps.size(); ++v)
    if (caps[v] > 0) order.push_back(v);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return caps[x] > caps[y]; });
  return order;
}

}  // namespace

std::vector<PassSummary> passes_of(const Trace& trace) {
  std::vector<PassSummary> out;
  if (!trace.header.construction) return out;
  // The size of the front is carried from pass to pass.
  std::uint32_t faces = trace.header.bodies[0].real_faces;
  bool open = false;
  for (EventId id = 0; id < trace.events.size(); ++id) {
    const Event& e = trace.events[id];
    if (e.kind == EventKind::pass) {
      out.push_back(begin_pass(id, e, faces));
      open = true;
    } else if (open) {
      take(out.back(), id, trace);
      faces = out.back().faces_after;
      open = e.kind != EventKind::pass_end;
    }
  }
  return out;
}

Chart chart_over_construction(const Trace& trace) {
  Chart chart{
      "event", {}, {{"faces of the hull", "faces", "from the body's to the outermost wrapper's", {}}}};
  double faces = trace.header.bodies[0].real_faces;
  for (EventId id = 0; id < trace.events.size(); ++id) {
    const Event& e = trace.events[id];
    if (e.kind == EventKind::region) faces = e.boundary;
    // Only regions change the front; the last event extends the curve to the end.
    if (e.kind != EventKind::region && e.kind != EventKind::step && id + 1 != trace.events.size()) continue;
    chart.x.push_back(id);
    chart.series[0].values.push_back(faces);
  }
  return chart;
}

Chart chart_over_passes(const Trace& trace) {
  constexpr std::size_t kMostReasons = 4;
  const std::vector<PassSummary> passes = passes_of(trace);
  // Accepted caps first, then the most frequent reasons for rejection.
  std::vector<std::size_t> shown = by_frequency(caps_of(passes));
  shown.resize(std::min(shown.size(), kMostReasons));
  shown.insert(shown.begin(), std::size_t{0});
  Chart chart{"pass, those in vain counted", {}, {}};
  for (const std::size_t v : shown)
    chart.series.push_back(
        {name_of(static_cast<CapVerdict>(v)), "", "patches by the verdict on their cap", {}});
  for (std::size_t i = 0; i < passes.size(); ++i) {
    chart.x.push_back(static_cast<double>(i + 1));
    for (std::size_t s = 0; s < shown.size(); ++s) chart.series[s].values.push_back(passes[i].caps[shown[s]]);
  }
  return chart;
}

std::string refusal_words(const Caps& caps) {
  std::string out;
  for (const std::size_t v : by_frequency(caps))
    out += (out.empty() ? "" : ", ") + std::to_string(caps[v]) + " " +
           std::string(name_of(static_cast<CapVerdict>(v)));
  return out;
}

Caps caps_of(const std::vector<PassSummary>& passes) {
  Caps out{};
  for (const PassSummary& p : passes)
    for (std::size_t v = 0; v < out.size(); ++v) out[v] += p.caps[v];
  return out;
}

}  // namespace lrb::trace
