#pragma once
/// A recorded run: header, time steps and events as flat arrays. Everything else is made from it: replays
/// (replay.hpp), numbers (counters.hpp), pictures (render/) and files (trace_json.hpp).

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lrbscope/build.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::trace {

// What is kept of further questions about a step: how far apart the bodies are, what kind of contact they
// have, and how the bounds tightened while that was found out; and of the search for the first contact of a
// whole motion.

/// A DistanceResult without its features.
struct MeasuredDistance {
  double lower = 0, upper = 0;                    ///< hold the distance of the surfaces; 0 if they meet
  bool solids_meet = false;                       ///< the surfaces do, or a body holds the other
  std::array<std::array<double, 3>, 2> points{};  ///< of A's surface and of B's, `upper` apart
  std::vector<Bounds> course;

  friend bool operator==(const MeasuredDistance&, const MeasuredDistance&) = default;
};

/// A ClashResult without the pieces of the surfaces.
struct MeasuredClash {
  ClashKind kind = ClashKind::undecided;
  ClashReason reason = ClashReason::none;
  bool shares_faces = false;
  std::array<double, 2> distance{};                    ///< of the solids
  std::optional<std::array<double, 2>> depth, volume;  ///< intervals; none: not known
  std::array<double, 3> translation{};                 ///< of B, that parts the solids
  std::vector<Bounds> course;                          ///< of the depth

  friend bool operator==(const MeasuredClash&, const MeasuredClash&) = default;
};

/// When the bodies first meet on the way that the steps are taken from, as a share of it.
struct MeasuredApproach {
  MotionOutcome outcome = MotionOutcome::undecided;
  double t0 = 0, t1 = 0;  ///< as FirstContactResult has them
  /// The same two times as steps of the trace: 11.36 is after step 11 and before step 12. Below 0 if the
  /// contact comes before step 0. None: no contact.
  std::optional<std::array<double, 2>> step;
  std::optional<std::array<double, 2>> length;  ///< the way that B's origin has moved from step 0 by then
  std::vector<ContactBounds> course;            ///< empty unless the search was watched

  friend bool operator==(const MeasuredApproach&, const MeasuredApproach&) = default;
};

MeasuredDistance measured(const DistanceResult& result, std::vector<Bounds> course);
MeasuredClash measured(const ClashResult& result, std::vector<Bounds> course);
/// Leaves step and length out, which the steps of the trace decide.
MeasuredApproach measured(const FirstContactResult& result, std::vector<ContactBounds> course);

/// Return it in a few words: "[0.25, 0.25] in 31 looks".
std::string words(const MeasuredDistance& m);
std::string words(const MeasuredClash& m);
std::string words(const MeasuredApproach& m);

/// The version of the trace format that is written. A reader takes it and older ones, and refuses newer ones.
/// Version 3 has names of steps that say what was found, an arrow to each face test, the events from
/// EventLevel::nodes on, and those of constructions.
inline constexpr std::uint32_t kTraceVersion = 3;

/// The name of the format in a trace's metadata.
inline constexpr std::string_view kTraceFormat = "lrbscope trace";

/// Returns the version of lrbscope that this library was built from, e.g. "2.0.0".
const char* lrbscope_version();

/// Index of an event in Trace::events; kNull: none.
using EventId = std::uint32_t;

/// The numbers of a node pair: see NodeVisit.
struct NodeWork {
  std::uint8_t box_tests = 0, met = 0, parted = 0, certain = 0;

  friend bool operator==(const NodeWork&, const NodeWork&) = default;
};
/// Why a pair of nodes, of which no two boxes met, was not descended. All three fit a byte.
struct NodeEnd {
  NodeStep step = NodeStep::descend_both;
  BoxAxis axis = BoxAxis::a1;  ///< along which the nodes' own boxes are furthest apart, or overlap least
  bool apart = false;          ///< these are apart

  static NodeEnd from_bits(std::uint8_t bits) {
    return {static_cast<NodeStep>(bits & 7), static_cast<BoxAxis>(bits >> 3 & 7), (bits >> 6 & 1) != 0};
  }
  std::uint8_t bits() const {
    return static_cast<std::uint8_t>(static_cast<unsigned>(step) | static_cast<unsigned>(axis) << 3 |
                                     static_cast<unsigned>(apart) << 6);
  }
};

/// What an event says, by its kind: the numbers of an Event. Event::of() packs them, and the accessor of the
/// kind's name unpacks them.
namespace payload {

struct Step {
  std::uint32_t index = 0;
};
struct FaceTest {
  SimplexId a{}, b{};
  exact::Meet meet = exact::Meet::disjoint;
  std::uint16_t depth_a = 0, depth_b = 0;  ///< regions between a face and the outside; 65535: or more
  TestedBy tested_by = TestedBy::untold;
};
/// Refine, coarsen, region.
struct WrapperChange {
  RegionId region{};
  std::uint32_t faces = 0;              ///< added, removed, or covered
  std::uint32_t wrapper_faces = kNull;  ///< of the wrapper afterwards; kNull: not known
  Side side = Side::a;                  ///< whose wrapper
};
struct Contact {
  SimplexId a{}, b{};
  exact::Meet meet = exact::Meet::disjoint;
};
struct Result {
  Relation relation = Relation::separate;
  std::uint32_t pairs = 0;
};
struct NodePair {
  std::uint32_t a = 0, b = 0;  ///< the nodes
  NodeWork work;
  NodeEnd end;
  std::uint16_t pairs_above = 0;  ///< 65535: or more
};
struct PlaneTest {
  SimplexId a{}, b{};
  Side whose = Side::a;  ///< whose plane
};
struct Point {
  VertexId vertex{};
  Side whose = Side::a;  ///< whose vertex
  Where where{};
};
struct PhaseBegin {
  Phase phase{};
  std::uint16_t walked_a = 0, walked_b = 0;  ///< see NullProbe::begin()
};
struct PhaseEnd {
  Phase phase{};
  std::uint32_t count = 0;
};
struct Pass {
  BuildStage stage{};
  std::uint32_t layer = 0;
  std::uint32_t barred = 0;  ///< as PassEnd::barred
  float most_off = 0;        ///< as PassStart::most_off
};
struct Patch {
  VertexId vertex{};
  std::uint32_t faces = 0;
  std::uint16_t interior = 0;  ///< as GrownPatch::interior; 65535: or more
};
struct Cap {
  std::uint32_t faces = 0, covered = 0;
  CapVerdict verdict{};
  bool careful = false;
  float off = std::numeric_limits<float>::quiet_NaN();  ///< mesh's unit; not finite: not measured
};
struct Merged {
  RegionId into{};
  std::uint32_t pieces = 0;
};
struct PassEnd {
  std::uint32_t no_patch = 0, waiting = 0;
  bool given_up = false;
  std::uint32_t wrapper_faces = kNull;  ///< kNull: not known
};
struct Closed {
  std::uint32_t regions = 0, outer_faces = 0;
};

}  // namespace payload

/// One event, 24 bytes. The numbers from `a` to `detail`, but for `cause`, are storage: what they mean
/// depends on the kind. Use of() and the accessors, each for events of its kind only.
struct Event {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  /// An earlier event. Contact: the face test that found it. Refine: the face test that hit just before
  /// (kNull in the complete query, which opens regions before it tests). Face test: the later of the
  /// refinements that brought in its faces. Node pair: the pair above. Plane test: the pair of leaves. End:
  /// the beginning of the phase. Patch, pass end: the pass. Cap: the patch. Region, merged: the cap, or the
  /// pass if it has none.
  EventId cause = kNull;
  std::uint32_t boundary = kNull;
  std::uint16_t depth_a = 0;
  std::uint16_t depth_b = 0;
  EventKind kind = EventKind::step;
  Side side = Side::a;
  exact::Meet meet = exact::Meet::disjoint;
  std::uint8_t detail = 0;

  static Event of(const payload::Step& p) { return {.a = p.index, .kind = EventKind::step}; }
  static Event of(const payload::FaceTest& p, EventId cause) {
    return {.a = p.a,
            .b = p.b,
            .cause = cause,
            .depth_a = p.depth_a,
            .depth_b = p.depth_b,
            .kind = EventKind::face_test,
            .meet = p.meet,
            .detail = static_cast<std::uint8_t>(p.tested_by)};
  }
  /// `kind`: refine, coarsen or region.
  static Event of(const payload::WrapperChange& p, EventKind kind, EventId cause) {
    return {.a = p.region,
            .b = p.faces,
            .cause = cause,
            .boundary = p.wrapper_faces,
            .kind = kind,
            .side = p.side};
  }
  static Event of(const payload::Contact& p, EventId cause) {
    return {.a = p.a, .b = p.b, .cause = cause, .kind = EventKind::contact, .meet = p.meet};
  }
  static Event of(const payload::Result& p) {
    return {.a = static_cast<std::uint32_t>(p.relation), .b = p.pairs, .kind = EventKind::result};
  }
  static Event of(const payload::NodePair& p, EventId cause) {
    return {.a = p.a,
            .b = p.b,
            .cause = cause,
            .boundary = std::bit_cast<std::uint32_t>(p.work),
            .depth_a = p.pairs_above,
            .kind = EventKind::node_pair,
            .detail = p.end.bits()};
  }
  static Event of(const payload::PlaneTest& p, EventId cause) {
    return {.a = p.a, .b = p.b, .cause = cause, .kind = EventKind::plane_test, .side = p.whose};
  }
  static Event of(const payload::Point& p) {
    return {.a = p.vertex,
            .kind = EventKind::point,
            .side = p.whose,
            .detail = static_cast<std::uint8_t>(p.where)};
  }
  static Event of(const payload::PhaseBegin& p) {
    return {.a = static_cast<std::uint32_t>(p.phase),
            .depth_a = p.walked_a,
            .depth_b = p.walked_b,
            .kind = EventKind::begin};
  }
  static Event of(const payload::PhaseEnd& p, EventId cause) {
    return {.a = static_cast<std::uint32_t>(p.phase), .b = p.count, .cause = cause, .kind = EventKind::end};
  }
  static Event of(const payload::Pass& p) {
    return {.a = p.layer,
            .b = p.barred,
            .boundary = std::bit_cast<std::uint32_t>(p.most_off),
            .kind = EventKind::pass,
            .detail = static_cast<std::uint8_t>(p.stage)};
  }
  static Event of(const payload::Patch& p, EventId cause) {
    return {.a = p.vertex, .b = p.faces, .cause = cause, .depth_a = p.interior, .kind = EventKind::patch};
  }
  static Event of(const payload::Cap& p, EventId cause) {
    return {.a = p.faces,
            .b = p.covered,
            .cause = cause,
            .boundary = std::isnan(p.off) ? std::uint32_t{kNull} : std::bit_cast<std::uint32_t>(p.off),
            .depth_a = p.careful,
            .kind = EventKind::cap,
            .detail = static_cast<std::uint8_t>(p.verdict)};
  }
  static Event of(const payload::Merged& p, EventId cause) {
    return {.a = p.into, .b = p.pieces, .cause = cause, .kind = EventKind::merged};
  }
  static Event of(const payload::PassEnd& p, EventId cause) {
    return {.a = p.no_patch,
            .b = p.waiting,
            .cause = cause,
            .boundary = p.wrapper_faces,
            .depth_a = p.given_up,
            .kind = EventKind::pass_end};
  }
  static Event of(const payload::Closed& p) {
    return {.a = p.regions, .b = p.outer_faces, .kind = EventKind::closed};
  }

  // What is known only later.
  void set_tested_by(TestedBy how) { detail = static_cast<std::uint8_t>(how); }  ///< face test
  void set_node_end(NodeEnd end) { detail = end.bits(); }                        ///< node pair
  /// Refine, coarsen, region, pass end: the number of faces of the wrapper afterwards.
  void set_wrapper_faces(std::uint32_t faces) { boundary = faces; }

  payload::Step step() const { return {a}; }
  payload::FaceTest face_test() const {
    return {SimplexId(a), SimplexId(b), meet, depth_a, depth_b, tested_by()};
  }
  payload::WrapperChange wrapper_change() const { return {region(), b, boundary, side}; }
  payload::Contact contact() const { return {SimplexId(a), SimplexId(b), meet}; }
  payload::Result result() const { return {static_cast<Relation>(a), b}; }
  payload::NodePair node_pair() const { return {a, b, work(), node_end(), depth_a}; }
  payload::PlaneTest plane_test() const { return {SimplexId(a), SimplexId(b), side}; }
  payload::Point point() const { return {VertexId(a), side, where()}; }
  payload::PhaseBegin phase_begin() const { return {phase(), depth_a, depth_b}; }
  payload::PhaseEnd phase_end() const { return {phase(), b}; }
  payload::Pass pass() const { return {stage(), a, b, off()}; }
  payload::Patch patch() const { return {VertexId(a), b, depth_a}; }
  payload::Cap cap() const { return {a, b, verdict(), depth_a != 0, off()}; }
  payload::Merged merged() const { return {RegionId(a), b}; }
  payload::PassEnd pass_end() const { return {a, b, depth_a != 0, boundary}; }
  payload::Closed closed() const { return {a, b}; }

  // Single numbers of payloads, for readers that need no more.
  SimplexId simplex(Side of) const { return SimplexId(of == Side::a ? a : b); }  ///< face test, contact
  RegionId region() const { return RegionId(a); }                         ///< refine, coarsen, region, merged
  TestedBy tested_by() const { return static_cast<TestedBy>(detail); }    ///< face test
  NodeWork work() const { return std::bit_cast<NodeWork>(boundary); }     ///< node pair
  NodeEnd node_end() const { return NodeEnd::from_bits(detail); }         ///< node pair
  Where where() const { return static_cast<Where>(detail); }              ///< point
  Phase phase() const { return static_cast<Phase>(a); }                   ///< begin, end
  BuildStage stage() const { return static_cast<BuildStage>(detail); }    ///< pass
  CapVerdict verdict() const { return static_cast<CapVerdict>(detail); }  ///< cap
  /// Pass: maximum deviation allowed for caps (0: unlimited). Cap: its deviation (not finite: not measured).
  /// Mesh's unit.
  float off() const { return std::bit_cast<float>(boundary); }
  /// Returns true if it changes a wrapper: the event has a wrapper_change().
  bool changes_wrapper() const {
    return kind == EventKind::refine || kind == EventKind::coarsen || kind == EventKind::region;
  }

  friend bool operator==(const Event&, const Event&) = default;
};
static_assert(sizeof(Event) == 24);

/// Where the time stamps (`ts`) of a written trace come from.
enum class Clock : std::uint8_t {
  event,  ///< the event's number, so that the same run gives the same bytes
  wall,   ///< steady_clock, read once for each event
};
constexpr auto words_of(Clock) {
  return std::to_array<EnumWord<Clock>>({{Clock::event, "event"}, {Clock::wall, "wall"}});
}

/// What a trace says about a body: enough to refuse a different one.
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

/// What a trace keeps of a time step's answer: CollideResult without its lists.
struct StepResult {
  Relation relation = Relation::separate;
  Answer interiors_overlap = Answer::unknown;
  std::uint64_t pair_count = 0;
  std::uint64_t fingerprint = 0;  ///< lrb::fingerprint() of the pairs
  Counters counters;
  double error_bound = 0;  ///< as in CollideResult; kept, like `finished`, for coarse queries only
  bool finished = true;
  std::optional<Separation> separation = {};
  std::optional<MeasuredDistance> distance = {};  ///< if it was asked for
  std::optional<MeasuredClash> clash = {};        ///< if it was asked for

  friend bool operator==(const StepResult&, const StepResult&) = default;
};

/// One time step: one query of the two bodies, with both wrappers outermost at its beginning.
struct Step {
  std::uint32_t index = 0;        ///< number of the step, as the caller gave it; ascending
  Pose pose_a, pose_b;            ///< body to world
  EventId first_event = 0;        ///< its step event; events.size() if the cap had been reached before it
  std::uint64_t events_seen = 0;  ///< number of its events, stored or not
  bool finished = false;          ///< end_step() was called: `result` is valid
  StepResult result;
};

struct TraceHeader {
  std::string lrbscope = lrbscope_version();
  std::string scenario;  ///< name
  std::uint64_t scenario_hash =
      0;  ///< hash of the scenario file's bytes, or of whatever else defines the run's input
  std::vector<BodyInfo> bodies;  ///< A and B, or A alone
  CollideRequest request;
  Clock clock = Clock::event;
  std::uint32_t event_cap = 0;  ///< largest number of events that are stored
  EventLevel level = EventLevel::faces;
  std::string engine;     ///< the one that was recorded, in words; empty: ours
  bool coherent = false;  ///< each step went on from the one before, by a CoherentQuery
  /// The construction of one body: its wrapper, the hull, begins with the body itself, and grows.
  bool construction = false;
  std::optional<MeasuredApproach> first_contact;  ///< of the motion; none: nobody looked for it
  std::string pictures;  ///< how the run was drawn, as a JSON object that traces only carry; empty: not said
};

struct Trace {
  TraceHeader header;
  std::vector<Step> steps;
  std::vector<Event> events;
  std::vector<std::uint64_t>
      wall_ns;  ///< (|events|), strictly ascending, since the recorder began; empty on the event clock
  std::uint64_t events_seen = 0;  ///< more than events.size() if the cap cut the recording

  bool truncated() const { return events_seen > events.size(); }
  /// Returns the stored events of a step.
  std::span<const Event> events_of(std::size_t step) const;
  /// Returns the step (index into `steps`) that an event belongs to.
  std::size_t step_of(EventId event) const;
};

/// Returns true if the traces are equal in every bit that a file must keep (of poses: the doubles' bits).
bool operator==(const Trace& x, const Trace& y);
bool equal(const Pose& x, const Pose& y);

/// Checks that all indices are in range and that steps and events fit together. Throws InputError: "`where`:
/// event 12: ...". Whoever reads a trace that passes cannot be led out of bounds.
void check_trace(const Trace& trace, const std::string& where);

// The words that files and messages use for what a trace holds.

using lrb::all_names;
using lrb::from_name;
using lrb::name_of;

/// The names of an event's numbers `a` and `b`; empty: the kind has no such number.
struct EventFields {
  std::string_view a, b;
};
constexpr EventFields fields_of(EventKind kind) {
#define LRB_EVENT(name, json, a, b) EventFields{a, b},
  constexpr EventFields fields[] = {LRB_EVENTS(LRB_EVENT)};
#undef LRB_EVENT
  return fields[static_cast<std::size_t>(kind)];
}
/// Returns the name of a contact's number where it is a pseudo simplex, which happens in answers of coarse
/// queries.
constexpr std::string_view pseudo_simplex(Side side) {
  return side == Side::a ? "pseudo simplex of A" : "pseudo simplex of B";
}
inline constexpr std::size_t kEventKinds = kWords<EventKind>.size();

}  // namespace lrb::trace
