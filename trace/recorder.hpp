#pragma once
/// A probe that writes down what the query does, as plain structs in a flat array.
///
///   Recorder recorder(a, b, settings);
///   for each time step:
///     recorder.begin_step(i, pose_a, pose_b);
///     recorder.end_step(collide(a, pose_a, b, pose_b, request, context, recorder));
///   Trace trace = recorder.take();
///
/// Cost: some ns an event on the event clock (tests/bench/trace_bench.cpp measures it); the wall clock adds
/// one steady_clock read.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "trace/trace.hpp"

namespace lrb::trace {

struct RecorderSettings {
  std::string scenario;  ///< name
  std::uint64_t scenario_hash = 0;
  std::array<std::string, 2> sources;  ///< where the bodies came from, as the user gave it
  CollideRequest request;              ///< what collide() is given: it decides what can cause a refinement
  Clock clock = Clock::event;
  std::uint32_t event_cap = 1'000'000;  ///< events beyond are counted, not stored (at most kMaxId)
};

class Recorder {
 public:
  static constexpr bool kEnabled = true;

  /// The bodies must outlive the recorder.
  Recorder(const LrbRep& a, const LrbRep& b, RecorderSettings settings);
  /// One body: only refine() and coarsen() of Side::a make sense.
  Recorder(const LrbRep& a, RecorderSettings settings);

  /// A new time step: both wrappers are the outermost ones again. `index` must ascend, poses be finite (else
  /// InputError).
  void begin_step(std::uint32_t index, const Pose& pose_a, const Pose& pose_b = {});
  void end_step(const CollideResult& result);

  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a, std::uint32_t depth_b) {
    // The later of the two refinements made the test possible; "none" is 0, and 0 - 1 is kNull.
    const std::uint32_t cause = std::max(brought_in(0, a), brought_in(1, b)) - 1u;
    const EventId id = push({.a = a,
                             .b = b,
                             .cause = cause,
                             .depth_a = saturated(depth_a),
                             .depth_b = saturated(depth_b),
                             .kind = EventKind::face_test,
                             .meet = meet});
    last_hit_ = meet == exact::Meet::disjoint ? kNull : id;
  }

  void refine(Side side, RegionId region, std::uint32_t faces_added) {
    const EventId id = push({.a = region,
                             .b = faces_added,
                             .cause = cause_of_refinement(),
                             .kind = EventKind::refine,
                             .side = side});
    // In unregularised mode a region's second lid brings in no faces: the first one's refinement stays the
    // cause.
    if (faces_added != 0 && id != kNull) refined_by_[static_cast<std::size_t>(side)][region] = id + 1;
  }

  /// Of coarse queries, and of runs that show a wrapper growing back.
  void coarsen(Side side, RegionId region, std::uint32_t faces_removed) {
    push({.a = region,
          .b = faces_removed,
          .cause = cause_of_refinement(),
          .kind = EventKind::coarsen,
          .side = side});
  }

  void contact(SimplexId a, SimplexId b, exact::Meet meet) {
    push({.a = a, .b = b, .cause = last_hit_, .kind = EventKind::contact, .meet = meet});
  }

  std::uint64_t events_seen() const { return seen_; }
  std::uint64_t events_stored() const { return trace_.events.size(); }

  /// Replays what was recorded to fill in Event::boundary and hands it over. The recorder is then empty: it
  /// can begin another run with the same settings. Throws std::logic_error if events came before the first
  /// step.
  Trace take();

 private:
  static std::uint16_t saturated(std::uint32_t depth) {
    return static_cast<std::uint16_t>(std::min(depth, std::uint32_t{0xffff}));
  }

  /// In the paper's recursion, a face test that hit. The complete query opens regions before it tests what
  /// they hide, because bounds overlap: no event is the cause, least of all the test that happened to come
  /// before.
  EventId cause_of_refinement() const {
    return settings_.request.recursion == Recursion::complete ? kNull : last_hit_;
  }

  /// 1 + the refine event of this step that put the simplex's face on the boundary; 0: none.
  std::uint32_t brought_in(std::size_t side, SimplexId simplex) const {
    const LrbRep& rep = *reps_[side];
    const CellId cell = rep.outer_cell(rep.face_of_simplex(simplex));
    if (!is_region(cell)) return 0;
    const std::uint32_t by = refined_by_[side][cell];
    return by > step_event_ ? by : 0;
  }

  EventId push(const Event& event) {
    ++seen_;
    if (trace_.events.size() >= settings_.event_cap) return kNull;
    trace_.events.push_back(event);
    if (settings_.clock == Clock::wall) trace_.wall_ns.push_back(now_ns());
    return static_cast<EventId>(trace_.events.size() - 1);
  }

  /// Since the recorder began; never the same twice, so that no two events of a timeline fall together.
  std::uint64_t now_ns() {
    const auto elapsed = std::chrono::steady_clock::now() - began_;
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(elapsed).count();
    return last_ns_ = std::max(last_ns_ + 1, static_cast<std::uint64_t>(ns));
  }

  void start_over();
  void close_step();

  std::array<const LrbRep*, 2> reps_{};
  RecorderSettings settings_;
  Trace trace_;
  std::array<std::vector<std::uint32_t>, 2>
      refined_by_;  ///< (regions) 1 + refine event, of this step or an old one
  std::uint64_t seen_ = 0;
  std::uint64_t seen_before_step_ = 0;
  EventId step_event_ = 0;    ///< first event of the current step
  EventId last_hit_ = kNull;  ///< the last face test, if it hit
  std::chrono::steady_clock::time_point began_;
  std::uint64_t last_ns_ = 0;
};

}  // namespace lrb::trace
