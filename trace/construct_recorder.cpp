#include "trace/construct_recorder.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "trace/replay.hpp"

namespace lrb::trace {

namespace {

std::uint16_t saturated(std::uint32_t value) {
  return static_cast<std::uint16_t>(std::min(value, std::uint32_t{0xffff}));
}

/// Returns a distance as Event::boundary holds it; what is negative was not measured.
std::uint32_t bits_of(double off) {
  return off < 0 ? std::uint32_t{kNull} : std::bit_cast<std::uint32_t>(static_cast<float>(off));
}

}  // namespace

ConstructRecorder::ConstructRecorder(RecorderSettings settings) : settings_(std::move(settings)) {
  settings_.event_cap = std::min(settings_.event_cap, kMaxId);
  push({.kind = EventKind::step});
}

EventId ConstructRecorder::push(const Event& event) {
  ++seen_;
  if (trace_.events.size() >= settings_.event_cap) return kNull;
  trace_.events.push_back(event);
  if (settings_.clock == Clock::wall) trace_.wall_ns.push_back(clock_.now_ns());
  return static_cast<EventId>(trace_.events.size() - 1);
}

void ConstructRecorder::pass(const PassStart& start) {
  cap_ = kNull;
  pass_ = push({.a = start.layer,
                .boundary = bits_of(start.most_off),
                .kind = EventKind::pass,
                .detail = static_cast<std::uint8_t>(start.stage)});
}

void ConstructRecorder::patch(const GrownPatch& patch) {
  patch_ = push({.a = patch.vertex,
                 .b = patch.faces,
                 .cause = pass_,
                 .depth_a = saturated(patch.interior),
                 .kind = EventKind::patch});
}

void ConstructRecorder::cap(const TriedCap& cap) {
  cap_ = push({.a = cap.faces,
               .b = cap.covered,
               .cause = patch_,
               .boundary = bits_of(cap.off),
               .depth_a = cap.careful,
               .kind = EventKind::cap,
               .detail = static_cast<std::uint8_t>(cap.verdict)});
}

void ConstructRecorder::region(RegionId region) {
  push({.a = region, .cause = cap_ != kNull ? cap_ : pass_, .kind = EventKind::region});
}

void ConstructRecorder::merged(RegionId into, std::uint32_t pieces) {
  push({.a = into, .b = pieces, .cause = cap_, .kind = EventKind::merged});
}

void ConstructRecorder::end_pass(const PassEnd& end) {
  const EventId id = push({.a = end.no_patch,
                           .b = end.waiting,
                           .cause = pass_,
                           .depth_a = end.given_up,
                           .kind = EventKind::pass_end});
  if (id != kNull) trace_.events[pass_].b = end.barred;
}

void ConstructRecorder::closed(std::uint32_t) {
  push({.kind = EventKind::closed});
}

Trace ConstructRecorder::take(const LrbRep& rep, const Pose& pose) {
  TraceHeader& header = trace_.header;
  header.scenario = settings_.scenario;
  header.scenario_hash = settings_.scenario_hash;
  header.bodies = {describe_body(rep, settings_.sources[0])};
  header.request = settings_.request;
  header.clock = settings_.clock;
  header.event_cap = settings_.event_cap;
  header.construction = true;
  // A construction is one step whose result is the body itself.
  Step step;
  step.pose_a = pose;
  step.events_seen = trace_.events_seen = seen_;
  trace_.steps.push_back(std::move(step));

  // Regions are known only now: replay them outward from the mesh to add face counts.
  const LrbRep* reps[] = {&rep};
  Replay hull(reps, header.request.wrapper, true);
  for (Event& e : trace_.events) {
    if (e.kind == EventKind::region) e.b = static_cast<std::uint32_t>(rep.floor(e.region()).size());
    if (hull.apply(e, trace_.events) || e.kind == EventKind::pass_end)
      e.boundary = hull.boundary_size(Side::a);
    if (e.kind == EventKind::closed) e.a = rep.region_count(), e.b = hull.boundary_size(Side::a);
  }
  Trace out = std::move(trace_);
  *this = ConstructRecorder(settings_);
  return out;
}

Trace known_construction(const LrbRep& rep, const Pose& pose, const RecorderSettings& settings) {
  ConstructRecorder recorder(settings);
  // Without a builder, one pass per layer stands in for the construction.
  for (std::uint32_t layer = 0; layer < rep.layer_count(); ++layer) {
    recorder.pass({BuildStage::known, layer, 0, 0});
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (rep.layer(r) == layer) recorder.region(r);
    recorder.end_pass({});
  }
  recorder.closed(0);
  return recorder.take(rep, pose);
}

}  // namespace lrb::trace
