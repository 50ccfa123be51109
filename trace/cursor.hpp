#pragma once
/// Replay: the state of a recorded run after any of its events, rebuilt from the trace and the LRB-reps
/// alone.

#include <optional>
#include <string>
#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "trace/replay.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// Throws InputError if an LRB-rep is not the one that was recorded. `who`: which body this is, for the
/// message.
void require_same_body(const BodyInfo& recorded, const LrbRep& rep, const std::string& who);

/// The faces of a face test.
struct TestedPair {
  SimplexId simplex_a = kNull, simplex_b = kNull;
  FaceId face_a = kNull, face_b = kNull;
  exact::Meet meet = exact::Meet::disjoint;
  EventId event = kNull;  ///< the face test (or contact) itself
};

/// A region that an event refined.
struct RefinedRegion {
  Side side = Side::a;
  RegionId region = kNull;
  EventId event = kNull;
};

/// Stands after one event of a trace, or before all of them. The trace and the LRB-reps must outlive it.
class Cursor {
 public:
  /// Throws InputError if the trace is damaged (check_trace) or an LRB-rep is not the one that was recorded.
  Cursor(const Trace& trace, const LrbRep& a, const LrbRep& b);
  Cursor(const Trace& trace, const LrbRep& a);

  const Trace& trace() const { return *trace_; }
  bool at_start() const { return position_ == kNull; }
  /// The event that the cursor stands after; kNull: before the first.
  EventId position() const { return position_; }

  /// Stands after `event`, forward or backward; kNull: before the first. Costs the wrapper events in between,
  /// or, backward over one, those of the step so far. Throws std::out_of_range for an event that was not
  /// stored, and InputError if a wrapper does not come out as recorded (the cursor is then at_start()).
  void seek(EventId event);
  bool next();      ///< false at the end
  bool previous();  ///< false before the first event
  /// To the next event of a kind; false (and stays) if there is none.
  bool next(EventKind kind);

  /// The event that the cursor stands after. Not at_start().
  const Event& event() const { return trace_->events[position_]; }
  /// The time step that the cursor is in; nullptr at_start().
  const Step* step() const { return at_start() ? nullptr : &trace_->steps[step_]; }
  /// Index into Trace::steps. Not at_start().
  std::size_t step_number() const { return step_; }
  /// Identity at_start().
  Pose pose(Side side) const;

  std::size_t body_count() const { return replay_.body_count(); }
  const Wrapper& wrapper(Side side) const { return replay_.wrapper(side); }
  /// Faces on the wrapper's boundary, in O(1).
  std::uint32_t boundary_size(Side side) const { return replay_.boundary_size(side); }
  /// The pair being compared: of the event if it is a face test or a contact, of its cause if it is a
  /// refinement.
  std::optional<TestedPair> pair_under_test() const;
  /// Regions that the event refined: itself and its neighbours with the same cause, up to the cursor. Empty
  /// unless the event is a refinement.
  std::vector<RefinedRegion> refined() const;

 private:
  Cursor(const Trace& trace, std::vector<const LrbRep*> reps);
  void apply_to(EventId event);
  void rewind();

  const Trace* trace_;
  Replay replay_;
  std::vector<EventId> changes_;  ///< events that change a wrapper (step, refine, coarsen), ascending
  std::size_t applied_ = 0;       ///< how many of them the wrappers have seen
  EventId position_ = kNull;
  std::size_t step_ = 0;
};

}  // namespace lrb::trace
