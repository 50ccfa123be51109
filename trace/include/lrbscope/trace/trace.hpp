#pragma once
/// A recorded run: header, time steps and events as flat arrays. Input of replays (replay.hpp), statistics
/// (counters.hpp), pictures (render/) and files (trace_json.hpp).

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
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::trace {

// Recorded results of further queries: distance, clash and the convergence of their bounds, near pairs,
// contact manifolds and distances of points per step, and the first contact of a whole motion.

/// A DistanceResult without its features.
struct MeasuredDistance {
  double lower = 0, upper = 0;  ///< bounds of the distance of the surfaces; 0 if they intersect
  bool solids_meet = false;     ///< the surfaces intersect, or one body contains the other
  std::array<std::array<double, 3>, 2> points{};  ///< on the surfaces of A and B, at distance `upper`
  std::vector<Bounds> history;

  friend bool operator==(const MeasuredDistance&, const MeasuredDistance&) = default;
};

/// A ClashResult without its contact regions.
struct MeasuredClash {
  ClashKind kind = ClashKind::undecided;
  ClashReason reason = ClashReason::none;
  bool shares_faces = false;
  std::array<double, 2> distance{};                    ///< of the solids
  std::optional<std::array<double, 2>> depth, volume;  ///< intervals; nullopt: not known
  std::array<double, 3> translation{};                 ///< of B, that separates the solids
  std::vector<Bounds> history;                         ///< of the depth

  friend bool operator==(const MeasuredClash&, const MeasuredClash&) = default;
};

/// A NearPairsResult: the number of pairs, and the nearest of them.
struct MeasuredNearPairs {
  struct Pair {
    SimplexId a = kNull, b = kNull;
    double lower = 0, upper = 0;                    ///< bounds of the distance
    std::array<std::array<double, 3>, 2> points{};  ///< on A and B

    friend bool operator==(const Pair&, const Pair&) = default;
  };

  double within = 0;          ///< the requested distance
  std::uint64_t pairs = 0;    ///< number of pairs found
  std::vector<Pair> nearest;  ///< at most kMaxListed, by ascending lower bounds

  static constexpr std::size_t kMaxListed = 1000;
  friend bool operator==(const MeasuredNearPairs&, const MeasuredNearPairs&) = default;
};

/// A ManifoldResult without its pairs.
struct MeasuredManifolds {
  struct Point {
    std::uint64_t id = 0;                           ///< the same from step to step
    std::uint32_t manifold = 0;                     ///< number of its manifold
    double depth = 0;                               ///< negative: a gap
    std::array<double, 3> normal{};                 ///< from A to B
    std::array<std::array<double, 3>, 2> points{};  ///< on A and B

    friend bool operator==(const Point&, const Point&) = default;
  };

  double margin = 0;            ///< the requested distance of speculative contacts
  std::uint64_t manifolds = 0;  ///< number of manifolds found
  std::uint64_t found = 0;      ///< number of points found
  std::vector<Point> contacts;  ///< the first points, at most kMaxListed

  static constexpr std::size_t kMaxListed = 1000;
  friend bool operator==(const MeasuredManifolds&, const MeasuredManifolds&) = default;
};

/// Signed distances of points that move with B to A.
struct MeasuredPoints {
  struct Point {
    std::uint32_t number = 0;                       ///< of the point, from 0
    FaceId face = kNull;                            ///< of A, the closest one
    double lower = 0, upper = 0;                    ///< bounds of the distance, negative inside
    std::array<std::array<double, 3>, 2> points{};  ///< the point, and the closest one on A

    friend bool operator==(const Point&, const Point&) = default;
  };

  std::uint64_t count = 0, inside = 0, on_surface = 0;
  bool has_sides = false;       ///< A is closed; otherwise distances have no sign
  std::vector<Point> smallest;  ///< at most kMaxListed, by ascending lower bounds

  static constexpr std::size_t kMaxListed = 1000;
  friend bool operator==(const MeasuredPoints&, const MeasuredPoints&) = default;
};

/// First contact of the motion that the steps sample. Times are shares of the motion.
struct MeasuredApproach {
  MotionOutcome outcome = MotionOutcome::undecided;
  double t0 = 0, t1 = 0;  ///< as in FirstContactResult
  /// The same two times in steps of the trace: 11.36 is between steps 11 and 12. Below 0 if the contact comes
  /// before step 0. nullopt: no contact.
  std::optional<std::array<double, 2>> step;
  std::optional<std::array<double, 2>> length;  ///< path length of B's origin from step 0 until then
  std::vector<ContactBounds> history;           ///< empty unless the search was probed

  friend bool operator==(const MeasuredApproach&, const MeasuredApproach&) = default;
};

MeasuredDistance measured(const DistanceResult& result, std::vector<Bounds> history);
MeasuredClash measured(const ClashResult& result, std::vector<Bounds> history);
MeasuredNearPairs measured(const NearPairsResult& result, double within);
MeasuredManifolds measured(const ManifoldResult& result, double margin);
/// `points`: in the world; `has_sides`: A is closed.
MeasuredPoints measured(std::span<const PointDistance> distances, std::span<const Eigen::Vector3d> points,
                        bool has_sides);
/// Converts a result. `step` and `length` stay empty, because they depend on the steps of the trace.
MeasuredApproach measured(const FirstContactResult& result, std::vector<ContactBounds> history);

/// Return a one-line summary: "[0.25, 0.25] in 31 looks".
std::string to_text(const MeasuredDistance& m);
std::string to_text(const MeasuredClash& m);
std::string to_text(const MeasuredNearPairs& m);
std::string to_text(const MeasuredManifolds& m);
std::string to_text(const MeasuredPoints& m);
std::string to_text(const MeasuredApproach& m);

// The answer of another engine, as it reported it.

/// The kind of query. shape: of a tree with a shape whose mesh is for pictures only; not checked.
enum class EngineQuery : std::uint8_t { all_pairs, any, distance, first_contact, self, shape };
constexpr auto enum_names(EngineQuery) {
  return std::to_array<EnumName<EngineQuery>>({{EngineQuery::all_pairs, "all_pairs"},
                                               {EngineQuery::any, "any"},
                                               {EngineQuery::distance, "distance"},
                                               {EngineQuery::first_contact, "first_contact"},
                                               {EngineQuery::self, "self"},
                                               {EngineQuery::shape, "shape"}});
}
enum class EngineVerdict : std::uint8_t { separate, intersecting, unreported };
constexpr auto enum_names(EngineVerdict) {
  return std::to_array<EnumName<EngineVerdict>>({{EngineVerdict::separate, "separate"},
                                                 {EngineVerdict::intersecting, "intersecting"},
                                                 {EngineVerdict::unreported, "unreported"}});
}

struct EngineReport {
  /// A counter's value, or the beginning of a phase.
  struct Mark {
    std::uint32_t name = 0;   ///< index in TraceHeader::names
    std::uint32_t at = 0;     ///< number of events of the step before it, the step event included
    std::uint32_t value = 0;  ///< of a counter

    friend bool operator==(const Mark&, const Mark&) = default;
  };

  EngineQuery query = EngineQuery::all_pairs;
  EngineVerdict verdict = EngineVerdict::unreported;
  std::uint64_t pairs = 0;  ///< number of pairs by the engine's own count
  bool complete = true;     ///< all its events were recorded
  std::uint32_t thread = 0;
  std::uint64_t begin_ns = 0;  ///< since the recording began
  std::uint64_t duration_ns = 0;
  std::vector<Mark> counts, phases;  ///< in the engine's order

  friend bool operator==(const EngineReport&, const EngineReport&) = default;
};

/// Newest version of the trace format that is written and read. Readers accept older versions and reject
/// newer ones. Version 3 added step names that state the result, a flow to each face test, the events at
/// EventLevel::nodes and above, and construction events. Version 4 added reports of other engines, version 5
/// the vertices of patches; a trace without either is written as version 3.
inline constexpr std::uint32_t kTraceVersion = 5;

/// Name of the format in a trace's metadata.
inline constexpr std::string_view kTraceFormat = "lrbscope trace";

/// Returns the version of lrbscope that this library was built from, e.g. "2.0.0".
const char* lrbscope_version();

/// Index of an event in Trace::events; kNull: none.
using EventId = std::uint32_t;

/// Work at a node pair: see NodeVisit.
struct NodeWork {
  std::uint8_t box_tests = 0, met = 0, rejected = 0, certain = 0;

  friend bool operator==(const NodeWork&, const NodeWork&) = default;
};
/// Why a node pair without overlapping boxes was not descended. All three members fit a byte.
struct NodeEnd {
  NodeStep step = NodeStep::descend_both;
  BoxAxis axis = BoxAxis::a1;  ///< axis of the largest separation, or least overlap, of the nodes' own boxes
  bool apart = false;          ///< the nodes' own boxes are separate

  static NodeEnd from_bits(std::uint8_t bits) {
    return {static_cast<NodeStep>(bits & 7), static_cast<BoxAxis>(bits >> 3 & 7), (bits >> 6 & 1) != 0};
  }
  std::uint8_t bits() const {
    return static_cast<std::uint8_t>(static_cast<unsigned>(step) | static_cast<unsigned>(axis) << 3 |
                                     static_cast<unsigned>(apart) << 6);
  }
};

/// The data of an event, by kind. Event::of() packs them; the accessor named after the kind unpacks them.
namespace payload {

struct Step {
  std::uint32_t index = 0;
};
struct FaceTest {
  SimplexId a{}, b{};
  exact::Meet meet = exact::Meet::disjoint;
  /// Number of regions between a face and the outside; saturates at 65535.
  std::uint16_t depth_a = 0, depth_b = 0;
  TestedBy tested_by = TestedBy::unreported;
};
/// Refine, coarsen, region.
struct WrapperChange {
  RegionId region{};
  std::uint32_t faces = 0;              ///< added, removed, or covered
  std::uint32_t wrapper_faces = kNull;  ///< of the wrapper afterwards; kNull: not known
  Side side = Side::a;                  ///< the wrapper's body
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
  std::uint16_t pairs_above = 0;  ///< saturates at 65535
  /// 1 + the axis of the test as another engine reported it (capture::Event::axis); 0: not reported.
  std::uint16_t engine_axis = 0;
};
struct PlaneTest {
  SimplexId a{}, b{};
  Side whose = Side::a;  ///< body of the plane
};
struct Point {
  VertexId vertex{};
  Side whose = Side::a;  ///< body of the vertex
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
  std::uint32_t excluded = 0;  ///< as PassEnd::excluded
  float max_deviation = 0;     ///< as PassStart::max_deviation
};
struct Patch {
  VertexId vertex{};
  std::uint32_t faces = 0;
  std::uint16_t interior = 0;   ///< as GrownPatch::interior; saturates at 65535
  std::uint32_t first = kNull;  ///< of its interior vertices in Trace::patch_vertices; kNull: not recorded
};
struct Cap {
  std::uint32_t faces = 0, covered = 0;
  CapVerdict verdict{};
  bool careful = false;
  float off = std::numeric_limits<float>::quiet_NaN();  ///< mesh units; not finite: not measured
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

/// One event, 24 bytes. Apart from `cause`, the members from `a` to `detail` are storage, and their meaning
/// depends on the kind. Use of() and the accessors, each for events of its kind only.
struct Event {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  /// An earlier event. Contact: the face test that found it. Refine: the face test that hit just before
  /// (kNull in the complete query, which refines regions before it tests). Face test: the later of the
  /// refinements that exposed its faces. Node pair: the parent pair. Plane test: the pair of leaves. End: the
  /// beginning of the phase. Patch, pass end: the pass. Cap: the patch. Region, merged: the cap, or the pass
  /// for regions without a cap.
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
            .depth_b = p.engine_axis,
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
            .b = p.excluded,
            .boundary = std::bit_cast<std::uint32_t>(p.max_deviation),
            .kind = EventKind::pass,
            .detail = static_cast<std::uint8_t>(p.stage)};
  }
  static Event of(const payload::Patch& p, EventId cause) {
    return {.a = p.vertex,
            .b = p.faces,
            .cause = cause,
            .boundary = p.first,
            .depth_a = p.interior,
            .kind = EventKind::patch};
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

  // Values known only later.
  void set_tested_by(TestedBy how) { detail = static_cast<std::uint8_t>(how); }   ///< face test
  void set_node_end(NodeEnd end) { detail = end.bits(); }                         ///< node pair
  void set_engine_axis(std::uint8_t axis) { depth_b = std::uint16_t(axis + 1); }  ///< node pair
  /// Refine, coarsen, region, pass end: number of faces of the wrapper after the event.
  void set_wrapper_faces(std::uint32_t faces) { boundary = faces; }

  payload::Step step() const { return {a}; }
  payload::FaceTest face_test() const {
    return {SimplexId(a), SimplexId(b), meet, depth_a, depth_b, tested_by()};
  }
  payload::WrapperChange wrapper_change() const { return {region(), b, boundary, side}; }
  payload::Contact contact() const { return {SimplexId(a), SimplexId(b), meet}; }
  payload::Result result() const { return {static_cast<Relation>(a), b}; }
  payload::NodePair node_pair() const { return {a, b, work(), node_end(), depth_a, depth_b}; }
  payload::PlaneTest plane_test() const { return {SimplexId(a), SimplexId(b), side}; }
  payload::Point point() const { return {VertexId(a), side, where()}; }
  payload::PhaseBegin phase_begin() const { return {phase(), depth_a, depth_b}; }
  payload::PhaseEnd phase_end() const { return {phase(), b}; }
  payload::Pass pass() const { return {stage(), a, b, off()}; }
  payload::Patch patch() const { return {VertexId(a), b, depth_a, boundary}; }
  payload::Cap cap() const { return {a, b, verdict(), depth_a != 0, off()}; }
  payload::Merged merged() const { return {RegionId(a), b}; }
  payload::PassEnd pass_end() const { return {a, b, depth_a != 0, boundary}; }
  payload::Closed closed() const { return {a, b}; }

  // Single members of payloads.
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
  /// Mesh units.
  float off() const { return std::bit_cast<float>(boundary); }
  /// Returns true if the event changes a wrapper, that is, if it has a wrapper_change().
  bool changes_wrapper() const {
    return kind == EventKind::refine || kind == EventKind::coarsen || kind == EventKind::region;
  }

  friend bool operator==(const Event&, const Event&) = default;
};
static_assert(sizeof(Event) == 24);

/// Source of the time stamps (`ts`) of a written trace.
enum class Clock : std::uint8_t {
  event,  ///< event numbers, so that equal runs give equal bytes
  wall,   ///< steady_clock, read once per event
};
constexpr auto enum_names(Clock) {
  return std::to_array<EnumName<Clock>>({{Clock::event, "event"}, {Clock::wall, "wall"}});
}

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

struct TraceHeader {
  std::string lrbscope = lrbscope_version();
  std::string scenario;  ///< name
  std::uint64_t scenario_hash =
      0;  ///< hash of the scenario file's bytes, or of the other input that defines the run
  std::vector<BodyInfo> bodies;  ///< A and B, or A alone
  CollideRequest request;
  Clock clock = Clock::event;
  std::uint32_t event_cap = 0;  ///< maximum number of stored events
  EventLevel level = EventLevel::faces;
  std::string engine;              ///< name of the recorded engine; empty: lrbscope
  std::vector<std::string> names;  ///< of that engine's counters and phases
  bool coherent = false;           ///< each step continues from the previous one, by a CoherentQuery
  /// The construction of one body: its wrapper, the front, starts as the body itself and grows.
  bool construction = false;
  std::optional<MeasuredApproach> first_contact;  ///< of the motion; nullopt: not searched for
  std::string pictures;  ///< rendering options of the run, as a JSON object that is stored unread; empty: not
                         ///< recorded
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

// Names of enumerators and fields in files and messages.

using lrb::all_names;
using lrb::from_name;
using lrb::name_of;

/// Names of an event's numbers `a` and `b`; empty if the kind has no such number.
struct EventFields {
  std::string_view a, b;
};
constexpr EventFields fields_of(EventKind kind) {
#define LRB_EVENT(name, json, a, b) EventFields{a, b},
  constexpr EventFields fields[] = {LRB_EVENTS(LRB_EVENT)};
#undef LRB_EVENT
  return fields[static_cast<std::size_t>(kind)];
}
/// Returns the name of a contact's number if it is a pseudo simplex, which occurs in answers of coarse
/// queries.
constexpr std::string_view pseudo_simplex(Side side) {
  return side == Side::a ? "pseudo simplex of A" : "pseudo simplex of B";
}
inline constexpr std::size_t kEventKinds = kEnumNames<EventKind>.size();

}  // namespace lrb::trace
