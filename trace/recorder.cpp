#include <limits>
#include <stdexcept>
#include <unordered_map>

#include <lrbscope/error.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::trace {

namespace {

/// Returns a deviation as stored in events; negative means not measured.
float deviation_of(double deviation) {
  return deviation < 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(deviation);
}

}  // namespace

EventStore::EventStore(RecorderSettings settings) : settings_(std::move(settings)) {
  // Event ids must fit: kNull is reserved.
  settings_.event_cap = std::min(settings_.event_cap, kMaxId);
}

void EventStore::start_over() {
  trace_ = {};
  static_cast<TraceSettings&>(trace_.header) = settings_;
  seen_ = 0;
  clock_ = {};
}

ConstructRecorder::ConstructRecorder(RecorderSettings settings) : EventStore(std::move(settings)) {
  settings_.level = EventLevel::faces;
  settings_.coherent = false;
  start_over();
  push(Event::of(payload::Step{}));
}

void ConstructRecorder::pass(const PassStart& start) {
  cap_ = kNull;
  pass_ = push(Event::of(payload::Pass{
      .stage = start.stage, .layer = start.layer, .max_deviation = static_cast<float>(start.max_deviation)}));
}

void ConstructRecorder::patch(const GrownPatch& patch) {
  payload::Patch event{patch.vertex, patch.faces, saturated(patch.interior)};
  const bool known = !patch.vertices.empty() && patch.vertices.size() == event.interior;
  if (known) event.first = static_cast<std::uint32_t>(trace_.patch_vertices.size());
  patch_ = push(Event::of(event, pass_));
  if (!known || patch_ == kNull) return;
  trace_.patch_vertices.insert(trace_.patch_vertices.end(), patch.vertices.begin(), patch.vertices.end());
}

void ConstructRecorder::cap(const TriedCap& cap) {
  cap_ = push(Event::of(payload::Cap{.faces = cap.faces,
                                     .covered = cap.covered,
                                     .verdict = cap.verdict,
                                     .careful = cap.careful,
                                     .deviation = deviation_of(cap.deviation)},
                        patch_));
}

void ConstructRecorder::region(RegionId region) {
  push(Event::of(payload::WrapperChange{.region = region}, EventKind::region, cap_ != kNull ? cap_ : pass_));
}

void ConstructRecorder::merged(RegionId into, std::uint32_t pieces) {
  push(Event::of(payload::Merged{into, pieces}, cap_));
}

void ConstructRecorder::end_pass(const PassEnd& end) {
  const EventId id = push(Event::of(
      payload::PassEnd{.no_patch = end.no_patch, .waiting = end.waiting, .given_up = end.given_up}, pass_));
  if (id == kNull) return;
  // The number of excluded faces is known only at the end of a pass.
  payload::Pass pass = trace_.events[pass_].pass();
  pass.excluded = end.excluded;
  trace_.events[pass_] = Event::of(pass);
}

void ConstructRecorder::closed(std::uint32_t) {
  push(Event::of(payload::Closed{}));
}

Trace ConstructRecorder::take(const LrbRep& rep, const Pose& pose) {
  trace_.header.bodies = {describe_body(rep, settings_.sources[0])};
  trace_.header.construction = true;
  // A construction is one step whose result is the body itself.
  Step step;
  step.pose_a = pose;
  step.events_seen = trace_.events_seen = seen_;
  trace_.steps.push_back(std::move(step));

  // Regions are known only now: replay them outward from the mesh to add face counts.
  const LrbRep* reps[] = {&rep};
  Replay front(reps, settings_.request.wrapper, true);
  for (Event& e : trace_.events) {
    if (e.kind == EventKind::region) {
      payload::WrapperChange change = e.wrapper_change();
      change.faces = static_cast<std::uint32_t>(rep.floor(change.region).size());
      e = Event::of(change, EventKind::region, e.cause);
    }
    if (front.apply(e, trace_.events) || e.kind == EventKind::pass_end)
      e.set_wrapper_faces(front.boundary_size(Side::a));
    if (e.kind == EventKind::closed)
      e = Event::of(payload::Closed{rep.region_count(), front.boundary_size(Side::a)});
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

namespace {

/// Sets the cause of each contact of a coarse query. Such a query reports its contacts at its end: the test
/// that found one is the last test of its pair.
void find_causes(std::vector<Event>& events) {
  std::unordered_map<std::uint64_t, EventId> tests;
  for (EventId i = 0; i < events.size(); ++i) {
    Event& e = events[i];
    // Later tests of the same pair overwrite earlier ones. Pairs do not carry over between steps.
    const std::uint64_t pair = std::uint64_t{e.a} << 32 | e.b;
    if (e.kind == EventKind::step) tests.clear();
    if (e.kind == EventKind::face_test) tests[pair] = i;
    if (e.kind != EventKind::contact) continue;
    const auto test = tests.find(pair);
    e.cause = test == tests.end() ? kNull : test->second;
  }
}

/// Finds the separating axes of node pairs without overlapping boxes.
void find_axes(Trace& trace, const std::array<const LrbRep*, 2>& reps) {
  std::array<const ObbTree*, 2> tree{};
  std::size_t step = 0;
  for (EventId i = 0; i < trace.events.size(); ++i) {
    Event& e = trace.events[i];
    if (e.kind == EventKind::step) step = trace.step_of(i);
    // Node numbers refer to the tree that the current phase traverses: the body's or that of a level of
    // detail.
    if (e.kind == EventKind::begin && walks_trees(e.phase()))
      tree = {&walked_tree(*reps[0], e.phase_begin().walked_a),
              &walked_tree(*reps[1], e.phase_begin().walked_b)};
    if (e.kind != EventKind::node_pair || e.work().met != 0) continue;
    // Repeat the box test with axes: the query does not record them, to stay fast.
    BoxPair boxes;
    compare_boxes(box_of(*tree[0], e.a, kWhole, trace.steps[step].pose_a),
                  box_of(*tree[1], e.b, kWhole, trace.steps[step].pose_b), boxes);
    NodeEnd end = e.node_end();
    end.axis = boxes.axis;
    end.apart = boxes.gap > 0;
    e.set_node_end(end);
  }
}

}  // namespace

Recorder::Recorder(const LrbRep& a, const LrbRep& b, RecorderSettings settings)
    : EventStore(std::move(settings)), reps_{&a, &b} {
  start_over();
}

Recorder::Recorder(const LrbRep& a, RecorderSettings settings)
    : EventStore(std::move(settings)), reps_{&a, nullptr} {
  start_over();
}

void Recorder::start_over() {
  EventStore::start_over();
  for (std::size_t side = 0; side < 2; ++side) {
    if (!reps_[side]) continue;
    trace_.header.bodies.push_back(describe_body(*reps_[side], settings_.sources[side]));
    refined_by_[side].assign(reps_[side]->region_count(), 0);
  }
  seen_before_step_ = 0;
  step_event_ = 0;
  last_hit_ = last_test_ = last_pair_ = phase_ = kNull;
}

void Recorder::close_step() {
  if (!trace_.steps.empty()) trace_.steps.back().events_seen = seen_ - seen_before_step_;
}

void Recorder::begin_step(std::uint32_t index, const Pose& pose_a, const Pose& pose_b) {
  for (const Pose* pose : {&pose_a, &pose_b})
    if (!pose->r.allFinite() || !pose->t.allFinite())
      throw InputError("time step " + std::to_string(index) +
                       ": expected a pose of 12 finite numbers, found a NaN or an infinity");
  if (!trace_.steps.empty() && index <= trace_.steps.back().index)
    throw std::logic_error("Recorder::begin_step: indices must ascend");
  // The previous step ends here; its count includes events beyond the cap.
  close_step();
  seen_before_step_ = seen_;
  step_event_ = static_cast<EventId>(trace_.events.size());
  // Causes never cross the boundary of a step.
  last_hit_ = last_test_ = last_pair_ = phase_ = kNull;
  Step step;
  step.index = index;
  step.pose_a = pose_a;
  if (reps_[1]) step.pose_b = pose_b;
  step.first_event = step_event_;
  trace_.steps.push_back(std::move(step));
  push(Event::of(payload::Step{index}));
}

Step& Recorder::step_to_add_to() {
  if (trace_.steps.empty()) throw std::logic_error("Recorder::add: call begin_step() first");
  return trace_.steps.back();
}

void Recorder::end_step(const CollideResult& result) {
  if (trace_.steps.empty()) throw std::logic_error("Recorder::end_step: call begin_step() first");
  Step& step = trace_.steps.back();
  step.finished = true;
  step.result.relation = result.relation;
  step.result.interiors_overlap = result.interiors_overlap;
  step.result.pair_count = result.pairs.size();
  step.result.fingerprint = fingerprint(result.pairs);
  step.result.counters = result.counters;
  step.result.error_bound = result.error_bound;
  step.result.finished = result.finished;
  step.result.separation = result.separation;
  push(Event::of(payload::Result{result.relation, static_cast<std::uint32_t>(result.pairs.size())}));
  last_hit_ = kNull;
}

Trace Recorder::take() {
  if (seen_ > 0 &&
      (trace_.steps.empty() || (!trace_.events.empty() && trace_.steps.front().first_event != 0)))
    throw std::logic_error("Recorder: events came before begin_step()");
  close_step();
  trace_.events_seen = seen_;
  // Post-processing, outside the measured time: causes of coarse contacts, separating axes, wrapper sizes.
  if (settings_.request.is_coarse()) find_causes(trace_.events);
  if (settings_.level != EventLevel::faces && settings_.engine.empty()) find_axes(trace_, reps_);
  // Replay the wrappers to add their sizes to the events.
  Replay replay(reps_, settings_.request.wrapper);
  for (Event& event : trace_.events)
    if (replay.apply(event, trace_.events)) event.set_wrapper_faces(replay.boundary_size(event.side));
  Trace out = std::move(trace_);
  start_over();
  return out;
}

}  // namespace lrb::trace
