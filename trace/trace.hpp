#pragma once
/// A recorded run: header, time steps and events as flat arrays. It is the source of truth for replay
/// (cursor.hpp), numbers (counters.hpp), pictures (render/) and files (trace_json.hpp).

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/enum_words.hpp"
#include "engine/core/ids.hpp"
#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/walk/probe.hpp"

namespace lrb::trace {

/// Version of the trace format. A reader takes its own version and older ones, and refuses newer ones. 2: of
/// queries to a tolerance, within a limit or with certificates of separation; all others are still written as
/// version 1.
inline constexpr std::uint32_t kTraceVersion = 2;

/// What a trace's metadata call its format.
inline constexpr std::string_view kTraceFormat = "lrbscope trace";

/// Version of lrbscope that this library was built from, e.g. "0.1.0".
const char* lrbscope_version();

/// Index of an event in Trace::events; kNull: none.
using EventId = std::uint32_t;

/// One event, 24 bytes. What `a` and `b` mean depends on the kind: see LRB_EVENTS in engine/query/walk/probe.hpp.
struct Event {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  EventId cause = kNull;  ///< an earlier event. Contact: the face test that found it. Refine: the face test
                          ///< that hit before it (none in the complete query, which opens regions ahead of
                          ///< tests). Face test: the refinement that brought in the later of its faces
  std::uint32_t boundary = kNull;  ///< refine, coarsen: faces of that wrapper afterwards; kNull: not known
  std::uint16_t depth_a = 0;  ///< face test: regions between A's face and the outside (65535: that or more)
  std::uint16_t depth_b = 0;  ///< the same for B
  EventKind kind = EventKind::step;
  Side side = Side::a;                       ///< refine, coarsen: whose wrapper
  exact::Meet meet = exact::Meet::disjoint;  ///< face test, contact
  std::uint8_t unused = 0;

  /// Return what `a` and `b` number: of a face test or a contact, the simplex of a body; of a refinement or a
  /// coarsening, the region.
  SimplexId simplex(Side of) const { return SimplexId(of == Side::a ? a : b); }
  RegionId region() const { return RegionId(a); }

  friend bool operator==(const Event&, const Event&) = default;
};
static_assert(sizeof(Event) == 24);

/// Where `ts` in a written trace comes from.
enum class Clock : std::uint8_t {
  event,  ///< the event's number: the same run gives the same bytes
  wall,   ///< steady_clock, read once an event
};
constexpr auto words_of(Clock) {
  return std::to_array<EnumWord<Clock>>({{Clock::event, "event"}, {Clock::wall, "wall"}});
}

/// What a trace says about a body, enough to refuse another one.
struct BodyInfo {
  std::string name;
  std::string source;      ///< the file or generator, as given
  std::uint64_t hash = 0;  ///< LrbRep::hash()
  std::uint32_t dim = 3;
  bool closed = false;
  std::uint32_t real_faces = 0;
  std::uint32_t total_faces = 0;
  std::uint32_t outer_faces = 0;  ///< faces of the outermost wrapper
  std::uint32_t regions = 0;
  std::uint32_t layers = 0;
  std::uint32_t real_simplices = 0;
  std::uint32_t simplices = 0;  ///< of all faces

  friend bool operator==(const BodyInfo&, const BodyInfo&) = default;
};

BodyInfo describe_body(const LrbRep& rep, std::string source);

/// CollideResult without its lists: what a trace keeps of a time step's answer.
struct StepResult {
  Relation relation = Relation::separate;
  Answer interiors_overlap = Answer::unknown;
  std::uint64_t pair_count = 0;
  std::uint64_t fingerprint = 0;  ///< lrb::fingerprint() of the pairs
  Counters counters;
  double error_bound = 0;  ///< as in CollideResult; it and `finished` are kept of coarse queries alone
  bool finished = true;
  std::optional<Separation> separation = {};

  friend bool operator==(const StepResult&, const StepResult&) = default;
};

/// One time step: one query of the two bodies, both wrappers starting as the outermost ones.
struct Step {
  std::uint32_t index = 0;        ///< the runner's number of the step, ascending
  Pose pose_a, pose_b;            ///< body to world
  EventId first_event = 0;        ///< its step event; events.size() if the cap had been reached before it
  std::uint64_t events_seen = 0;  ///< stored or not
  bool finished = false;          ///< end_step() was called: `result` is valid
  StepResult result;
};

struct TraceHeader {
  std::string lrbscope = lrbscope_version();
  std::string scenario;             ///< name
  std::uint64_t scenario_hash = 0;  ///< of the scenario file's bytes, or whatever names the run's input
  std::vector<BodyInfo> bodies;     ///< A and B, or A alone
  CollideRequest request;
  Clock clock = Clock::event;
  std::uint32_t event_cap = 0;  ///< events stored at most
};

struct Trace {
  TraceHeader header;
  std::vector<Step> steps;
  std::vector<Event> events;
  std::vector<std::uint64_t>
      wall_ns;  ///< (|events|), strictly ascending, since the recorder began; event clock: empty
  std::uint64_t events_seen = 0;  ///< more than events.size() if the cap cut the recording

  bool truncated() const { return events_seen > events.size(); }
  /// Stored events of a step.
  std::span<const Event> events_of(std::size_t step) const;
  /// The step (index into `steps`) that an event belongs to.
  std::size_t step_of(EventId event) const;
};

/// Equal in every bit that a file must keep (poses: the doubles' bits).
bool operator==(const Trace& x, const Trace& y);
bool equal(const Pose& x, const Pose& y);

/// Checks that all indices are in range and steps and events fit together. Throws InputError: "`where`: event
/// 12:
/// ...". A trace that passes cannot lead a reader of it out of bounds.
void check_trace(const Trace& trace, const std::string& where);

}  // namespace lrb::trace
