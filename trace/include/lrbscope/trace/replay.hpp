#pragma once
/// Applies events to wrappers. Used by both the recorder and the cursor, so that a replay cannot differ from
/// the recording.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/trace/trace.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::trace {

/// The wrappers of one or two bodies, and the number of faces on the boundary of each.
class Replay {
 public:
  /// `bare`: wrappers start as the body itself, as in constructions.
  Replay(std::span<const LrbRep* const> reps, WrapperMode mode, bool bare = false);

  /// Resets all wrappers to the outermost ones, or to the bodies themselves if `bare`.
  void reset();
  /// Applies an event. A step resets all wrappers; a refinement, a coarsening or a built region changes the
  /// wrapper of its side; other kinds have no effect. Returns true if a wrapper changed. `events` are those
  /// of the whole trace, used to look up causes; indices must be in range (check_trace).
  ///
  /// In unregularised mode a wrapper is refined face by face: a refinement removes the face that its cause, a
  /// face test, compared. Without such a cause the whole region is refined.
  bool apply(const Event& event, std::span<const Event> events);

  std::size_t body_count() const { return wrappers_.size(); }
  const Wrapper& wrapper(Side side) const { return wrappers_[static_cast<std::size_t>(side)]; }
  /// Returns the number of faces on the boundary, in constant time.
  std::uint32_t boundary_size(Side side) const { return sizes_[static_cast<std::size_t>(side)]; }

 private:
  std::vector<Wrapper> wrappers_;
  std::array<std::uint32_t, 2> sizes_{};
  bool bare_;
};

// Restores the state of a recorded run after any of its events, from the trace and the LRB-reps alone.

/// Throws InputError if an LRB-rep is not the recorded one. `who` names the body in the message.
void require_same_body(const BodyInfo& recorded, const LrbRep& rep, const std::string& who);

/// The two faces that a face test compared.
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

/// A position in a trace: after one of its events, or before the first. The trace and the LRB-reps must
/// outlive it.
class Cursor {
 public:
  /// Throws InputError if the trace is damaged (check_trace) or an LRB-rep is not the recorded one.
  Cursor(const Trace& trace, const LrbRep& a, const LrbRep& b);
  Cursor(const Trace& trace, const LrbRep& a);
  Cursor(const Trace& trace, std::vector<const LrbRep*> reps);

  const Trace& trace() const { return *trace_; }
  bool at_start() const { return position_ == kNull; }
  /// Returns the event just before the cursor, or kNull if the cursor is before the first event.
  EventId position() const { return position_; }

  /// Moves to just after `event`, forward or backward; kNull: before the first event. Takes time proportional
  /// to the number of wrapper events in between or, when going backward, since the beginning of the event's
  /// step. Throws std::out_of_range for an event that was not stored. Throws InputError if a wrapper differs
  /// from the recording (the cursor is then at_start()).
  void seek(EventId event);
  bool next();      ///< Moves forward one event. Returns false at the end.
  bool previous();  ///< Moves back one event. Returns false before the first.
  /// Moves to the next event of a kind. Returns false without moving if no such event follows.
  bool next(EventKind kind);

  /// Returns the event just before the cursor. Must not be called at_start().
  const Event& event() const { return trace_->events[position_]; }
  /// Returns the time step of the cursor, or nullptr at_start().
  const Step* step() const { return at_start() ? nullptr : &trace_->steps[step_]; }
  /// Returns the index of this step in Trace::steps. Must not be called at_start().
  std::size_t step_number() const { return step_; }
  /// Returns the pose of a body in this step (body to world). The identity at_start().
  Pose pose(Side side) const;

  std::size_t body_count() const { return replay_.body_count(); }
  const Wrapper& wrapper(Side side) const { return replay_.wrapper(side); }
  /// Returns the number of faces on the wrapper's boundary, in constant time.
  std::uint32_t boundary_size(Side side) const { return replay_.boundary_size(side); }
  /// Returns the pair under test: the event's own if it is a face test or a contact, its cause's if it is a
  /// refinement, else nullopt.
  std::optional<TestedPair> pair_under_test() const;
  /// Returns the regions refined together with the event: its own, and the regions of the events directly
  /// before it with the same cause. Empty unless the event is a refinement.
  std::vector<RefinedRegion> refined() const;

 private:
  void apply_to(EventId event);
  void rewind();

  const Trace* trace_;
  Replay replay_;
  std::vector<EventId> changes_;  ///< steps, and events that change a wrapper; ascending
  std::size_t applied_ = 0;       ///< number of these events that have been applied to the wrappers
  EventId position_ = kNull;
  std::size_t step_ = 0;
};

}  // namespace lrb::trace
