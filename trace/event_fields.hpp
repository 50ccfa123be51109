#pragma once
/// The fields of events in files and messages. Each kind states them once, for writing
/// (trace_json_write.cpp), reading (trace_json_read.cpp) and comparing (divergence.cpp): event_fields(io,
/// event) passes them to `io` in order. Names are literals, so that data() is NUL-terminated.

#include <bit>
#include <string_view>
#include <type_traits>

#include "trace/measured_json.hpp"
#include <lrbscope/trace/event.hpp>

namespace lrb::trace {

/// An enumerator that is stored as a number.
template <class Enum, class Stored>
void stored_word(auto& io, std::string_view name, Stored& stored) {
  auto value = static_cast<Enum>(stored);
  io.word(name, value);
  if constexpr (!std::is_const_v<Stored>) stored = static_cast<Stored>(value);
}

void node_pair_fields(auto& io, Is<Event> auto& e) {
  constexpr bool kReads = !std::is_const_v<std::remove_reference_t<decltype(e)>>;
  NodeWork work = kReads ? NodeWork{} : e.work();
  NodeEnd end = kReads ? NodeEnd{} : e.node_end();
  auto axis = static_cast<std::uint8_t>(e.depth_b - 1);
  io.word("step", end.step);
  io.number("box tests", work.box_tests);
  io.number("boxes that meet", work.met);
  if (end.step == NodeStep::leaves) {
    io.number("parted by planes", work.rejected);  // language: keep
    io.number("certain", work.certain);
  }
  if (io.has("axis", e.depth_b > 0)) {
    io.number("axis", axis);
    if constexpr (kReads) e.set_engine_axis(axis);
  } else if (work.met == 0) {
    end.apart = io.has("apart along", end.apart);
    io.word(end.apart ? "apart along" : "overlap least along", end.axis);
  }
  io.number("pairs above", e.depth_a);
  if constexpr (kReads) e.boundary = std::bit_cast<std::uint32_t>(work), e.set_node_end(end);
}

/// `io` has: has(name, present), true if an optional field is there; number(name, x); word(name, enumerator);
/// flag(name, x), which is there if true; real(name, bits of a float); simplex(side, name, x), which has
/// another name if it is not real; vertices(patch).
void event_fields(auto& io, Is<Event> auto& e) {
  constexpr bool kReads = !std::is_const_v<std::remove_reference_t<decltype(e)>>;
  const auto [a, b] = fields_of(e.kind);
  bool has_wrapper = true;  // `boundary` is the number of faces of a wrapper, if it is known
  if (e.kind == EventKind::refine || e.kind == EventKind::coarsen) io.word("side", e.side);
  if (e.kind == EventKind::contact) {
    io.simplex(Side::a, a, e.a);
    io.simplex(Side::b, b, e.b);
  } else {
    if (e.kind == EventKind::result)
      stored_word<Relation>(io, a, e.a);
    else if (e.kind == EventKind::begin || e.kind == EventKind::end)
      stored_word<Phase>(io, a, e.a);
    else if (!a.empty())
      io.number(a, e.a);
    if (!b.empty()) io.number(b, e.b);
  }
  switch (e.kind) {
    case EventKind::face_test:
      io.word("meet", e.meet);
      io.number("depth of A", e.depth_a);
      io.number("depth of B", e.depth_b);
      if (io.has("decided by", e.tested_by() != TestedBy::unreported))
        stored_word<TestedBy>(io, "decided by", e.detail);
      break;
    case EventKind::contact:
      io.word("meet", e.meet);
      break;
    case EventKind::node_pair:
      has_wrapper = false;
      node_pair_fields(io, e);
      break;
    case EventKind::plane_test:
      io.word("plane of", e.side);
      break;
    case EventKind::point:
      io.word("of", e.side);
      stored_word<Where>(io, "where", e.detail);
      break;
    case EventKind::begin:
      if (!walks_trees(e.phase())) break;
      io.number("level of A", e.depth_a);
      io.number("level of B", e.depth_b);
      break;
    case EventKind::pass:
      has_wrapper = false;
      stored_word<BuildStage>(io, "stage", e.detail);
      if constexpr (kReads) e.boundary = 0;
      if (io.has("distance allowed", e.deviation() > 0)) io.real("distance allowed", e.boundary);
      break;
    case EventKind::patch:
      has_wrapper = false;
      io.number("interior vertices", e.depth_a);
      io.vertices(e);
      break;
    case EventKind::cap:
      has_wrapper = false;
      stored_word<CapVerdict>(io, "verdict", e.detail);
      io.flag("careful", e.depth_a);
      if (io.has("distance", e.boundary != kNull)) io.real("distance", e.boundary);
      break;
    case EventKind::pass_end:
      io.flag("given up", e.depth_a);
      break;
    case EventKind::step:
    case EventKind::refine:
    case EventKind::coarsen:
    case EventKind::result:
    case EventKind::end:
    case EventKind::region:
    case EventKind::merged:
    case EventKind::closed:
      break;
  }
  if (has_wrapper && io.has("wrapper faces", e.boundary != kNull)) io.number("wrapper faces", e.boundary);
  if (io.has("cause", e.cause != kNull)) io.number("cause", e.cause);
}

}  // namespace lrb::trace
