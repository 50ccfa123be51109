#pragma once
/// A probe that records the events of a query as plain structs in a flat array.
///
///   Recorder recorder(a, b, settings);
///   for each time step:
///     recorder.begin_step(i, pose_a, pose_b);
///     recorder.end_step(collide(a, pose_a, b, pose_b, request, workspace, &recorder).value());
///   Trace trace = recorder.take();
///
/// An event costs some nanoseconds on the event clock. The wall clock adds one read of steady_clock.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

/// Provides the time stamps of a recording.
class WallClock {
 public:
  /// Returns nanoseconds since construction. Strictly ascending, so that no two events of a timeline
  /// coincide.
  std::uint64_t now_ns() {
    const auto elapsed = std::chrono::steady_clock::now() - began_;
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(elapsed).count();
    return last_ns_ = std::max(last_ns_ + 1, static_cast<std::uint64_t>(ns));
  }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::uint64_t last_ns_ = 0;
};

struct RecorderSettings : TraceSettings {
  std::array<std::string, 2> sources;  ///< origin of the bodies, as given by the user
};

/// What recorders have in common: events with time stamps, up to the cap.
class EventStore {
 protected:
  explicit EventStore(RecorderSettings settings);

  static std::uint16_t saturated(std::uint32_t value) {
    return static_cast<std::uint16_t>(std::min(value, std::uint32_t{0xffff}));
  }

  EventId push(const Event& event) {
    ++seen_;
    if (trace_.events.size() >= settings_.event_cap) return kNull;
    trace_.events.push_back(event);
    if (settings_.clock == Clock::wall) trace_.wall_ns.push_back(clock_.now_ns());
    return static_cast<EventId>(trace_.events.size() - 1);
  }

  /// Empties the store, so that it can record another run with the same settings.
  void start_over();

  RecorderSettings settings_;
  Trace trace_;
  std::uint64_t seen_ = 0;

 private:
  WallClock clock_;
};

class Recorder final : public CollideProbe, private EventStore {
 public:
  static constexpr bool kEnabled = true;

  /// Prepares to record queries of two bodies, which must outlive the recorder.
  Recorder(const LrbRep& a, const LrbRep& b, RecorderSettings settings);
  /// Prepares to record one body; only refine() and coarsen() of Side::a may be called.
  Recorder(const LrbRep& a, RecorderSettings settings);

  /// Begins a time step and resets both wrappers to the outermost ones. Throws InputError unless `index`
  /// ascends and the poses are finite.
  void begin_step(std::uint32_t index, const Pose& pose_a, const Pose& pose_b = {});
  /// Adds a measurement to the current step, as in StepResult. Call before end_step().
  template <class Measured>
  void add(Measured measured) {
    StepResult& result = step_to_add_to().result;
    std::get<std::optional<Measured>&>(std::tie(result.distance, result.clash, result.near, result.manifold,
                                                result.points, result.engine)) = std::move(measured);
  }
  void end_step(const CollideResult& result);

  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a,
                 std::uint32_t depth_b) override {
    // The cause is the later of the two refinements. None is 0, and 0 - 1 is kNull.
    const std::uint32_t cause = std::max(brought_in(0, a), brought_in(1, b)) - 1u;
    const EventId id = push(Event::of(
        payload::FaceTest{
            .a = a, .b = b, .meet = meet, .depth_a = saturated(depth_a), .depth_b = saturated(depth_b)},
        cause));
    last_test_ = id;
    last_hit_ = meet == exact::Meet::disjoint ? kNull : id;
  }

  void refine(Side side, RegionId region, std::uint32_t faces_added) override {
    const EventId id =
        push(Event::of(payload::WrapperChange{.region = region, .faces = faces_added, .side = side},
                       EventKind::refine, cause_of_refinement()));
    // In unregularised mode a region's second lid adds no faces; the refinement of the first lid stays the
    // cause.
    if (faces_added != 0 && id != kNull) refined_by_[static_cast<std::size_t>(side)][region] = id + 1;
  }

  /// Records that a wrapper covered a region again, in a coarse query.
  void coarsen(Side side, RegionId region, std::uint32_t faces_removed) override {
    push(Event::of(payload::WrapperChange{.region = region, .faces = faces_removed, .side = side},
                   EventKind::coarsen, cause_of_refinement()));
  }

  void contact(SimplexId a, SimplexId b, exact::Meet meet) override {
    push(Event::of(payload::Contact{a, b, meet}, last_hit_));
  }

  EventLevel level() const override { return settings_.level; }

  std::uint32_t node_pair(const NodeVisit& visit) override {
    const std::uint32_t depth =
        visit.parent == kNull ? 0 : trace_.events[visit.parent].node_pair().pairs_above + 1u;
    last_pair_ =
        push(Event::of(payload::NodePair{.a = visit.a,
                                         .b = visit.b,
                                         .work = {visit.box_tests, visit.met, visit.rejected, visit.certain},
                                         .end = {.step = visit.step},
                                         .pairs_above = saturated(depth)},
                       visit.parent));
    return last_pair_;
  }

  /// Adds the axis that another engine reported to the last pair of nodes.
  void set_engine_axis(std::uint8_t axis) {
    if (last_pair_ != kNull) trace_.events[last_pair_].set_engine_axis(axis);
  }

  void plane_test(SimplexId a, SimplexId b, Side whose) override {
    push(Event::of(payload::PlaneTest{a, b, whose}, last_pair_));
  }

  void tested_by(TestedBy how) override {
    if (last_test_ != kNull) trace_.events[last_test_].set_tested_by(how);
  }

  void point(Side whose, VertexId v, Where where) override {
    push(Event::of(payload::Point{v, whose, where}));
  }

  void begin(Phase phase, std::uint32_t walked_a, std::uint32_t walked_b) override {
    phase_ = push(Event::of(payload::PhaseBegin{phase, saturated(walked_a), saturated(walked_b)}));
  }

  void end(Phase phase, std::uint64_t count) override {
    const auto stored = static_cast<std::uint32_t>(std::min(count, std::uint64_t{kMaxId}));
    push(Event::of(payload::PhaseEnd{phase, stored}, phase_));
    phase_ = kNull;
  }

  std::uint64_t events_seen() const { return seen_; }
  std::uint64_t events_of_step() const { return seen_ - seen_before_step_; }

  /// Replays the recording to fill in wrapper sizes and the ends of node pairs, and returns the trace. The
  /// recorder is then empty and can record another run with the same settings. Throws std::logic_error if
  /// events came before the first step.
  Trace take();

 private:
  /// In the paper's recursion, returns the face test that has just hit. Returns kNull for the complete query:
  /// it refines regions before it tests the faces behind them, because bounds overlap, so no event is the
  /// cause.
  EventId cause_of_refinement() const {
    return settings_.request.recursion == Recursion::complete ? kNull : last_hit_;
  }

  /// Returns 1 + the refine event of this step that put the simplex's face on the boundary, or 0 if it was on
  /// the boundary before.
  std::uint32_t brought_in(std::size_t side, SimplexId simplex) const {
    const LrbRep& rep = *reps_[side];
    const CellId cell = rep.outer_cell(rep.face_of_simplex(simplex));
    if (!is_region(cell)) return 0;
    const std::uint32_t by = refined_by_[side][cell];
    return by > step_event_ ? by : 0;
  }

  Step& step_to_add_to();
  void start_over();
  void close_step();

  std::array<const LrbRep*, 2> reps_{};
  std::array<std::vector<std::uint32_t>, 2>
      refined_by_;  ///< per region: 1 + refine event, of this step or an earlier one
  std::uint64_t seen_before_step_ = 0;
  EventId step_event_ = 0;    ///< first event of the current step
  EventId last_hit_ = kNull;  ///< the last face test, if it hit
  EventId last_test_ = kNull, last_pair_ = kNull, phase_ = kNull;
};

// Records the events of a builder as a trace.
//
// ```
// ConstructRecorder recorder(settings);
// options.probe = &recorder;
// LrbRep rep = build_lrb(mesh, options);
// Trace trace = recorder.take(rep, pose);
// ```

class ConstructRecorder final : public ConstructProbe, private EventStore {
 public:
  explicit ConstructRecorder(RecorderSettings settings);

  void pass(const PassStart& start) override;
  void patch(const GrownPatch& patch) override;
  void cap(const TriedCap& cap) override;
  void region(RegionId region) override;
  void merged(RegionId into, std::uint32_t pieces) override;
  void end_pass(const PassEnd& end) override;
  void closed(std::uint32_t faces) override;

  /// Returns true if no builder has reported an event.
  bool empty() const { return seen_ == 1; }

  /// Replays the recording on the built body, to count the faces of the front, and returns the trace: one
  /// time step, which starts with the body itself as wrapper. The recorder is then empty.
  Trace take(const LrbRep& rep, const Pose& pose);

 private:
  EventId pass_ = kNull, patch_ = kNull, cap_ = kNull;
};

/// Returns a construction trace for a body that was loaded with its regions: the events that the passes
/// making these regions would have reported.
Trace known_construction(const LrbRep& rep, const Pose& pose, const RecorderSettings& settings);

}  // namespace lrb::trace
