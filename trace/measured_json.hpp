#pragma once
/// The members of recorded answers as they are in JSON. Each record states them once, for writing
/// (trace_json_parts.cpp) and for reading (record_read.cpp): members(io, record) passes them to `io` in
/// order.

#include <concepts>
#include <type_traits>

#include <lrbscope/trace/measured.hpp>

namespace lrb::trace {

/// The values that a number may have in a file.
enum class Values : std::uint8_t {
  any,
  not_negative,
  or_infinite,  ///< not negative; infinity is written as null
};

template <class T, class Record>
concept Is = std::same_as<std::remove_const_t<T>, Record>;

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// The convergence of bounds.
void history(auto& io, Is<std::vector<Bounds>> auto& all) {
  io.rows("course", all, 3, "work, lower bound and upper bound", [](auto& row, auto& b) {
    row.cell(b.work);
    row.cell(b.lower);
    row.cell(b.upper, Values::or_infinite);
  });
}

void history(auto& io, Is<std::vector<ContactBounds>> auto& all) {
  io.rows("course", all, 5, "work, t0, t1, lower bound and upper bound", [](auto& row, auto& b) {
    row.cell(b.work);
    row.cell(b.t0);
    for (auto* end : {&b.t1, &b.lower, &b.upper}) row.cell(*end, Values::or_infinite);
  });
}

void members(auto& io, Is<MeasuredDistance> auto& m) {
  io.member("lower", m.lower, Values::or_infinite);
  io.member("upper", m.upper, Values::or_infinite);
  io.member("solids_meet", m.solids_meet);
  io.member("point_a", m.points[0], Values::any);
  io.member("point_b", m.points[1], Values::any);
  history(io, m.history);
}

void members(auto& io, Is<MeasuredClash> auto& m) {
  io.member("kind", m.kind);
  io.member_unless(ClashReason::none, "reason", m.reason);
  io.member("shares_faces", m.shares_faces);
  io.member("distance", m.distance, Values::or_infinite);
  io.member("depth", m.depth, Values::or_infinite);
  if (m.depth) io.member("translation", m.translation, Values::any);
  io.member("volume", m.volume, Values::or_infinite);
  io.member_unless(true, "finished", m.finished);
  history(io, m.history);
}

void members(auto& io, Is<MeasuredNearPairs> auto& m) {
  io.member("within", m.within);
  for (const auto& n : NearPairsNumbers::kShown)
    n.required ? io.member(n.in_traces, m.*n.member)
               : io.member_unless(std::uint64_t{0}, n.in_traces, m.*n.member);
  io.rows("nearest", m.nearest, 10, "10 numbers", [](auto& row, auto& p) {
    row.cell(p.a);
    row.cell(p.b);
    row.cell(p.lower);
    row.cell(p.upper);
    row.cell(p.points, Values::any);
  });
}

void members(auto& io, Is<MeasuredManifolds> auto& m) {
  io.member("margin", m.margin);
  io.member("manifolds", m.manifolds);
  io.member("points", m.found);
  io.rows("contacts", m.contacts, 12, "12 numbers", [](auto& row, auto& p) {
    row.cell(p.id);
    row.cell(p.manifold);
    row.cell(p.depth, Values::any);
    row.cell(p.normal, Values::any);
    row.cell(p.points, Values::any);
  });
}

void members(auto& io, Is<MeasuredPoints> auto& m) {
  io.member("count", m.count);
  io.member("inside", m.inside);
  io.member("on_surface", m.on_surface);
  io.member("has_sides", m.has_sides);
  io.rows("smallest", m.smallest, 10, "10 numbers", [](auto& row, auto& p) {
    row.cell(p.number);
    row.cell(p.face);
    row.cell(p.lower, Values::any);
    row.cell(p.upper, Values::any);
    row.cell(p.points, Values::any);
  });
}

/// The members of a first contact except the history of its bounds.
void answer_members(auto& io, Is<MeasuredApproach> auto& m) {
  io.member("outcome", m.outcome);
  io.member("t0", m.t0);
  io.member("t1", m.t1);
  io.member("step", m.step, Values::any);
  if (m.step) io.member("length", m.length, Values::any);
}

void members(auto& io, Is<MeasuredApproach> auto& m) {
  answer_members(io, m);
  history(io, m.history);
}

void members(auto& io, Is<EngineReport> auto& r) {
  io.member("query", r.query);
  io.member("verdict", r.verdict);
  io.member("pairs", r.pairs);
  io.member("complete", r.complete);
  io.member("thread", r.thread);
  io.member("begin_ns", r.begin_ns);
  io.member("duration_ns", r.duration_ns);
  io.rows_if_any("counts", r.counts, 3, "name, place and value", [](auto& row, auto& mark) {
    row.cell(mark.name);
    row.cell(mark.at);
    row.cell(mark.value);
  });
  io.rows_if_any("phases", r.phases, 2, "name and place", [](auto& row, auto& mark) {
    row.cell(mark.name);
    row.cell(mark.at);
  });
}

}  // namespace lrb::trace
