#pragma once
/// A recorded run: header, time steps and events as flat arrays. Input of replays (replay.hpp), statistics
/// (counters.hpp), pictures (render/) and files (trace_json.hpp).

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/event.hpp>
#include <lrbscope/trace/measured.hpp>

namespace lrb::trace {

/// Newest version of the trace format that is written and read. Readers accept older versions and reject
/// newer ones. Version 3 added step names that state the result, a flow to each face test, the events at
/// EventLevel::nodes and above, and construction events. Version 4 added reports of other engines, version 5
/// the vertices of patches; a trace without either is written as version 3.
inline constexpr std::uint32_t kTraceVersion = 5;

/// Name of the format in a trace's metadata.
inline constexpr std::string_view kTraceFormat = "lrbscope trace";

/// Returns the version of lrbscope that this library was built from, e.g. "2.0.0".
const char* lrbscope_version();

/// Identity of a recorded body, used to reject a different one.
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

/// A time step's answer: CollideResult without its lists.
struct StepResult {
  Relation relation = Relation::separate;
  Answer interiors_overlap = Answer::unknown;
  std::uint64_t pair_count = 0;
  std::uint64_t fingerprint = 0;  ///< lrb::fingerprint() of the pairs
  Counters counters;
  double error_bound = 0;  ///< as in CollideResult; kept, like `finished`, for coarse queries only
  bool finished = true;
  std::optional<Separation> separation = {};
  std::optional<MeasuredDistance> distance = {};   ///< if requested
  std::optional<MeasuredClash> clash = {};         ///< if requested
  std::optional<MeasuredNearPairs> near = {};      ///< if requested
  std::optional<MeasuredManifolds> manifold = {};  ///< if requested
  std::optional<MeasuredPoints> points = {};       ///< if requested
  std::optional<EngineReport> engine = {};         ///< if another engine reported its answer

  friend bool operator==(const StepResult&, const StepResult&) = default;
};

/// One time step: one query of the two bodies, which starts with both outermost wrappers.
struct Step {
  std::uint32_t index = 0;        ///< number of the step as given by the caller; ascending
  Pose pose_a, pose_b;            ///< body to world
  EventId first_event = 0;        ///< its step event; events.size() if the cap was reached before it
  std::uint64_t events_seen = 0;  ///< number of its events, stored or not
  bool finished = false;          ///< end_step() was called; `result` is valid
  StepResult result;
};

/// Settings of a recording that its trace repeats.
struct TraceSettings {
  std::string scenario;  ///< name
  std::uint64_t scenario_hash =
      0;                   ///< hash of the scenario file's bytes, or of the other input that defines the run
  CollideRequest request;  ///< as passed to collide(): determines what can cause a refinement
  Clock clock = Clock::event;
  std::uint32_t event_cap =
      1'000'000;  ///< events beyond this number are counted but not stored (at most kMaxId)
  EventLevel level = EventLevel::faces;
  /// Name of another engine whose traversal is recorded over its own trees; empty: lrbscope.
  std::string engine;
  std::vector<std::string> names;  ///< of that engine's counters and phases
  bool coherent = false;           ///< each step continues from the previous one, by a CoherentQuery

  friend bool operator==(const TraceSettings&, const TraceSettings&) = default;
};

struct TraceHeader : TraceSettings {
  std::string lrbscope = lrbscope_version();
  std::vector<BodyInfo> bodies;  ///< A and B, or A alone
  /// The construction of one body: its wrapper, the front, starts as the body itself and grows.
  bool construction = false;
  std::optional<MeasuredApproach> first_contact;  ///< of the motion; nullopt: not searched for
  std::string pictures;  ///< rendering options of the run, as a JSON object that is stored unread; empty: not
                         ///< recorded

  friend bool operator==(const TraceHeader&, const TraceHeader&) = default;
};

struct Trace {
  TraceHeader header;
  std::vector<Step> steps;
  std::vector<Event> events;
  std::vector<std::uint64_t>
      wall_ns;  ///< (|events|), strictly ascending, since the recorder was made; empty on the event clock
  std::uint64_t events_seen = 0;         ///< more than events.size() if the cap truncated the recording
  std::vector<VertexId> patch_vertices;  ///< of a construction: the interior vertices of its patches

  bool truncated() const { return events_seen > events.size(); }
  /// Returns true if another engine reported its answers.
  bool has_engine_reports() const;
  /// Returns the stored events of a step.
  std::span<const Event> events_of(std::size_t step) const;
  /// Returns the step (index into `steps`) that contains an event.
  std::size_t step_of(EventId event) const;
  /// Returns the interior vertices of a patch event, the start vertex first in 3D; empty if they were not
  /// recorded.
  std::span<const VertexId> vertices_of(const Event& patch) const;
};

/// Returns true if the traces are equal in every bit that a file stores (poses: the bits of the doubles).
bool operator==(const Trace& x, const Trace& y);
bool equal(const Pose& x, const Pose& y);

/// Checks that all indices are in range and that steps and events agree. Throws InputError: "`where`: event
/// 12: ...". A trace that passes can be read without further bounds checks.
void check_trace(const Trace& trace, const std::string& where);

}  // namespace lrb::trace
