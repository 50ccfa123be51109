#pragma once
/// The events of a recorded run (trace.hpp).

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/observe.hpp>

namespace lrb::trace {

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
  float deviation = std::numeric_limits<float>::quiet_NaN();  ///< mesh units; not finite: not measured
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
            .boundary =
                std::isnan(p.deviation) ? std::uint32_t{kNull} : std::bit_cast<std::uint32_t>(p.deviation),
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
  payload::Pass pass() const { return {stage(), a, b, deviation()}; }
  payload::Patch patch() const { return {VertexId(a), b, depth_a, boundary}; }
  payload::Cap cap() const { return {a, b, verdict(), depth_a != 0, deviation()}; }
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
  float deviation() const { return std::bit_cast<float>(boundary); }
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
