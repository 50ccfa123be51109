#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <lrbscope/trace/counters.hpp>

namespace lrb::trace {

namespace {

bool is_hit(const Event& e) {
  return e.kind == EventKind::face_test && e.meet != exact::Meet::disjoint;
}

double ratio(std::uint64_t part, double whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / whole;
}
double ratio(std::uint64_t part, std::uint64_t whole) {
  return ratio(part, static_cast<double>(whole));
}

/// Tracks the sizes of the two wrappers, event by event.
class WrapperSizes {
 public:
  explicit WrapperSizes(const Trace& trace) : trace_(&trace) { reset(); }

  void take(const Event& e) {
    if (e.kind == EventKind::step) reset();
    if (!e.changes_wrapper()) return;
    const payload::WrapperChange change = e.wrapper_change();
    if (change.wrapper_faces != kNull) faces[static_cast<std::size_t>(change.side)] = change.wrapper_faces;
  }

  std::array<std::uint32_t, 2> faces{};

 private:
  void reset() {
    for (std::size_t i = 0; i < trace_->header.bodies.size(); ++i)
      faces[i] = trace_->header.construction ? trace_->header.bodies[i].real_faces
                                             : trace_->header.bodies[i].outer_faces;
  }

  const Trace* trace_;
};

std::array<std::uint32_t, 2> largest_wrappers(const Trace& trace, std::span<const Event> events) {
  // The sizes at the beginning of the range count as well.
  WrapperSizes sizes(trace);
  std::array<std::uint32_t, 2> most = sizes.faces;
  for (const Event& e : events) {
    sizes.take(e);
    for (std::size_t i = 0; i < 2; ++i) most[i] = std::max(most[i], sizes.faces[i]);
  }
  return most;
}

double seconds_of(const Trace& trace, EventId first, std::size_t count) {
  if (trace.wall_ns.empty() || count == 0) return std::numeric_limits<double>::quiet_NaN();
  constexpr double kNanosecond = 1e-9;
  return static_cast<double>(trace.wall_ns[first + count - 1] - trace.wall_ns[first]) * kNanosecond;
}

}  // namespace

double seconds_of_step(const Trace& trace, std::size_t step) {
  return seconds_of(trace, trace.steps[step].first_event, trace.events_of(step).size());
}

Totals count_events(std::span<const Event> events) {
  Totals t;
  t.events = events.size();
  for (const Event& e : events) {
    const auto side = static_cast<std::size_t>(e.side);
    // Every kind is listed, so that the compiler reports a new one.
    switch (e.kind) {
      case EventKind::face_test:
        ++t.face_tests;
        t.hits += is_hit(e);
        t.crossings += e.meet == exact::Meet::cross;
        break;
      case EventKind::refine:
        ++t.refinements[side];
        t.faces_added += e.b;
        break;
      case EventKind::coarsen:
        ++t.coarsenings[side];
        break;
      case EventKind::contact:
        ++t.contacts;
        break;
      case EventKind::node_pair:
        ++t.node_pairs;
        break;
      case EventKind::step:
      case EventKind::result:
      case EventKind::plane_test:
      case EventKind::point:
      case EventKind::begin:
      case EventKind::end:
      case EventKind::pass:  // construction: see passes_of()
      case EventKind::patch:
      case EventKind::cap:
      case EventKind::region:
      case EventKind::merged:
      case EventKind::pass_end:
      case EventKind::closed:
        break;
    }
  }
  return t;
}

std::vector<Statistic> statistics(const Trace& trace) {
  const Totals t = count_events(trace.events);
  const std::uint64_t refinements = t.refinements[0] + t.refinements[1];
  const std::uint64_t steps = trace.steps.size();
  std::vector<Statistic> out = {
      {"tests_per_contact", ratio(t.face_tests, t.contacts), "", "face tests / contacts; best 1"},
      {"hit_rate", ratio(t.hits, t.face_tests), "", "intersecting face tests / face tests; best 1"},
      {"contact_rate", ratio(t.contacts, t.hits), "", "contacts / intersecting face tests; best 1"},
      {"tests_per_refinement", ratio(t.face_tests, refinements), "",
       "face tests / refinements; work per refined region"},
      {"faces_per_refinement", ratio(t.faces_added, refinements), "faces",
       "faces added / refinements; size of the refined regions"},
      {"tests_per_step", ratio(t.face_tests, steps), "", "face tests / time steps"},
      {"refinements_per_step", ratio(refinements, steps), "", "refinements / time steps"},
      {"contacts_per_step", ratio(t.contacts, steps), "", "contacts / time steps"},
  };
  constexpr std::string_view kShares[] = {"largest_wrapper_share_a", "largest_wrapper_share_b"};
  // Shares relate the work to its worst case: all faces of a body, all pairs of faces.
  const auto most = largest_wrappers(trace, trace.events);
  double pairs = static_cast<double>(steps);
  for (std::size_t i = 0; i < trace.header.bodies.size(); ++i) {
    const BodyInfo& body = trace.header.bodies[i];
    pairs *= body.real_simplices;
    out.push_back({kShares[i], ratio(most[i], std::uint64_t{body.real_faces}), "",
                   "largest wrapper / real faces of the body; best near 0, 1: fully refined"});
  }
  if (trace.header.bodies.size() == 2)
    out.push_back({"pair_share", ratio(t.face_tests, pairs), "",
                   "face tests / (time steps x real simplices of A x real simplices of B); best near 0"});
  if (!trace.wall_ns.empty())
    out.push_back({"seconds", seconds_of(trace, 0, trace.events.size()), "s",
                   "from first to last event, including recording; best low"});
  return out;
}

Histogram tests_by_depth(const Trace& trace) {
  Histogram h{"tests_by_depth",
              "region depth",
              "face tests by the region depth of the deeper face; deeper is closer to the body",
              {},
              {}};
  for (const Event& e : trace.events) {
    if (e.kind != EventKind::face_test) continue;
    const payload::FaceTest test = e.face_test();
    const std::size_t depth = std::max(test.depth_a, test.depth_b);
    if (depth >= h.counts.size()) h.counts.resize(depth + 1);
    ++h.counts[depth];
  }
  for (std::size_t i = 0; i <= h.counts.size(); ++i) h.edges.push_back(static_cast<double>(i));
  return h;
}

Histogram refinements_by_size(const Trace& trace) {
  Histogram h{"refinements_by_size",
              "faces added",
              "refinements by the number of faces they added to the wrapper; bins double in width",
              {},
              {}};
  for (const Event& e : trace.events) {
    if (e.kind != EventKind::refine) continue;
    // Logarithmic bins: bit_width(n) is 0 for 0, else floor(log2 n) + 1.
    const auto bin = static_cast<std::size_t>(std::bit_width(e.b));
    if (bin >= h.counts.size()) h.counts.resize(bin + 1);
    ++h.counts[bin];
  }
  h.edges.push_back(0);
  for (std::size_t i = 0; i < h.counts.size(); ++i)
    h.edges.push_back(static_cast<double>(std::uint64_t{1} << i));
  return h;
}

Histogram steps_by_tests(const Trace& trace, std::size_t bins) {
  Histogram h{"steps_by_tests",
              "face tests",
              "time steps by their number of face tests; best near 0",
              {},
              std::vector<std::uint64_t>(bins)};
  std::vector<std::uint64_t> tests;
  for (std::size_t i = 0; i < trace.steps.size(); ++i)
    tests.push_back(count_events(trace.events_of(i)).face_tests);
  const std::uint64_t most = tests.empty() ? 0 : *std::max_element(tests.begin(), tests.end());
  // Rounded up, so that the maximum falls into the last bin at most.
  const std::uint64_t width = most / bins + 1;
  for (const std::uint64_t n : tests) ++h.counts[n / width];
  for (std::size_t i = 0; i <= bins; ++i) h.edges.push_back(static_cast<double>(i * width));
  return h;
}

FaceCounts count_faces(const LrbRep& rep, Side side, std::span<const Event> events) {
  const std::size_t n = rep.face_count();
  const std::vector<std::uint32_t> none(n);
  FaceCounts counts{none, none, none, none, none, none, none};
  const auto face_of = [&](const Event& e) { return rep.face_of_simplex(e.simplex(side)); };
  for (const Event& e : events) {
    // Each event is attributed to one face of this side; a refinement to all real faces and lids of its
    // region.
    if (e.kind == EventKind::face_test) {
      const FaceId face = face_of(e);
      ++counts.tests[face];
      counts.hits[face] += is_hit(e);
      counts.misses[face] += !is_hit(e);
      counts.expansions[face] += e.tested_by() == TestedBy::expansions;
    } else if (e.kind == EventKind::plane_test) {
      ++counts.plane_tests[face_of(e)];
    } else if (e.kind == EventKind::contact) {
      ++counts.contacts[face_of(e)];
    } else if (e.kind == EventKind::refine && e.side == side) {
      for (const FaceId lid : rep.lids(e.region())) ++counts.refinements[lid];
      for (const FaceId face : rep.floor(e.region()))
        if (rep.is_real(face)) ++counts.refinements[face];
    }
  }
  return counts;
}

Chart chart_over_events(const Trace& trace, std::size_t max_points) {
  Chart chart{"event", {}, {}};
  chart.series = {{"faces of wrapper A", "faces", "faces on the boundary of A's wrapper", {}},
                  {"faces of wrapper B", "faces", "faces on the boundary of B's wrapper", {}},
                  {"face tests", "", "exact comparisons in the time step so far", {}},
                  {"hits", "", "intersecting face tests in the time step so far", {}},
                  {"refinements", "", "regions refined in the time step so far", {}},
                  {"contacts", "", "real pairs found in the time step so far", {}}};
  const std::size_t n = trace.events.size();
  // Sample every stride-th event, and the last. Work restarts at each step.
  const std::size_t stride = std::max<std::size_t>(1, n / std::max<std::size_t>(max_points, 1));
  WrapperSizes sizes(trace);
  std::array<std::uint64_t, 4> work{};
  for (std::size_t i = 0; i < n; ++i) {
    const Event& e = trace.events[i];
    sizes.take(e);
    if (e.kind == EventKind::step) work = {};
    work[0] += e.kind == EventKind::face_test;
    work[1] += is_hit(e);
    work[2] += e.kind == EventKind::refine;
    work[3] += e.kind == EventKind::contact;
    if (i % stride != 0 && i + 1 != n) continue;
    chart.x.push_back(static_cast<double>(i));
    for (std::size_t s = 0; s < 2; ++s) chart.series[s].values.push_back(sizes.faces[s]);
    for (std::size_t s = 0; s < work.size(); ++s)
      chart.series[2 + s].values.push_back(static_cast<double>(work[s]));
  }
  // The rows are computed for two bodies: drop the curve of the missing one.
  if (trace.header.bodies.size() < 2) chart.series.erase(chart.series.begin() + 1);
  return chart;
}

Chart chart_over_steps(const Trace& trace) {
  Chart chart{"time step", {}, {}};
  chart.series = {
      {"face tests", "", "exact comparisons; best low", {}},
      {"hits", "", "intersecting face tests; best equal to contacts", {}},
      {"refinements", "", "regions refined; best low", {}},
      {"contacts", "", "intersecting real pairs: the result", {}},
      {"largest wrapper A", "faces", "maximum number of faces of A's wrapper in the step; best low", {}},
      {"largest wrapper B", "faces", "maximum number of faces of B's wrapper in the step; best low", {}},
      {"time", "ms", "from first to last event of the step, including recording; best low", {}}};
  constexpr double kMilliseconds = 1e3;
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const std::span<const Event> events = trace.events_of(i);
    const Totals t = count_events(events);
    const auto most = largest_wrappers(trace, events);
    // One row per step, in the order of the series.
    const double row[] = {static_cast<double>(t.face_tests),
                          static_cast<double>(t.hits),
                          static_cast<double>(t.refinements[0] + t.refinements[1]),
                          static_cast<double>(t.contacts),
                          static_cast<double>(most[0]),
                          static_cast<double>(most[1]),
                          kMilliseconds * seconds_of_step(trace, i)};
    chart.x.push_back(trace.steps[i].index);
    for (std::size_t s = 0; s < chart.series.size(); ++s) chart.series[s].values.push_back(row[s]);
  }
  if (trace.wall_ns.empty()) chart.series.pop_back();
  if (trace.header.bodies.size() < 2) chart.series.erase(chart.series.begin() + 5);
  return chart;
}

namespace {

using Caps = std::array<std::uint32_t, kEnumNames<CapVerdict>.size()>;

PassSummary begin_pass(EventId id, const Event& e, std::uint32_t faces) {
  PassSummary p;
  p.first = p.last = id;
  const payload::Pass pass = e.pass();
  p.stage = pass.stage;
  p.layer = pass.layer;
  p.excluded = pass.excluded;
  p.max_deviation = pass.max_deviation;
  p.faces_before = p.faces_after = faces;
  return p;
}

void take_cap(PassSummary& p, const Event& e, const Event* tried_before) {
  // A second cap over the same patch replaces the verdict of the first.
  if (tried_before) {
    --p.caps[static_cast<std::size_t>(tried_before->verdict())];
    ++p.retried;
  }
  const payload::Cap cap = e.cap();
  ++p.caps[static_cast<std::size_t>(cap.verdict)];
  if (cap.verdict != CapVerdict::accepted) return;
  p.lids += cap.faces;
  p.covered += cap.covered;
  if (std::isfinite(cap.deviation)) p.deviation = std::max(p.deviation, cap.deviation);
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
      p.faces_after = e.wrapper_change().wrapper_faces;
      break;
    case EventKind::merged:
      p.merged += e.merged().pieces;
      break;
    case EventKind::pass_end: {
      const payload::PassEnd end = e.pass_end();
      p.no_patch = end.no_patch;
      p.waiting = end.waiting;
      p.given_up = end.given_up;
      p.faces_after = end.wrapper_faces;
      break;
    }
    default:
      break;
  }
}

/// Returns the verdicts that reject caps, most frequent first.
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
  Chart chart{"event", {}, {{"faces of the front", "faces", "from the body to the outermost wrapper", {}}}};
  double faces = trace.header.bodies[0].real_faces;
  for (EventId id = 0; id < trace.events.size(); ++id) {
    const Event& e = trace.events[id];
    if (e.kind == EventKind::region) faces = e.wrapper_change().wrapper_faces;
    // Only regions change the front; the last event extends the curve to the end.
    if (e.kind != EventKind::region && e.kind != EventKind::step && id + 1 != trace.events.size()) continue;
    chart.x.push_back(id);
    chart.series[0].values.push_back(faces);
  }
  return chart;
}

Chart chart_over_passes(const Trace& trace) {
  constexpr std::size_t kMaxReasons = 4;
  const std::vector<PassSummary> passes = passes_of(trace);
  // Accepted caps first, then the most frequent reasons for rejection.
  std::vector<std::size_t> shown = by_frequency(caps_of(passes));
  shown.resize(std::min(shown.size(), kMaxReasons));
  shown.insert(shown.begin(), std::size_t{0});
  Chart chart{"pass, including those without effect", {}, {}};
  for (const std::size_t v : shown)
    chart.series.push_back(
        {text_of(static_cast<CapVerdict>(v)), "", "patches by the verdict on their caps", {}});
  for (std::size_t i = 0; i < passes.size(); ++i) {
    chart.x.push_back(static_cast<double>(i + 1));
    for (std::size_t s = 0; s < shown.size(); ++s) chart.series[s].values.push_back(passes[i].caps[shown[s]]);
  }
  return chart;
}

std::string_view text_of(CapVerdict verdict) {
  switch (verdict) {
    case CapVerdict::accepted:
      return "accepted";
    case CapVerdict::meets_front:
      return "met the front";
    case CapVerdict::leaves_out:
      return "left some of the front out";
    default:
      return name_of(verdict);
  }
}

std::string rejection_text(const Caps& caps) {
  std::string out;
  for (const std::size_t v : by_frequency(caps))
    out += (out.empty() ? "" : ", ") + std::to_string(caps[v]) + " " +
           std::string(text_of(static_cast<CapVerdict>(v)));
  return out;
}

Caps caps_of(const std::vector<PassSummary>& passes) {
  Caps out{};
  for (const PassSummary& p : passes)
    for (std::size_t v = 0; v < out.size(); ++v) out[v] += p.caps[v];
  return out;
}

}  // namespace lrb::trace
