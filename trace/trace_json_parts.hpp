#pragma once
/// Writes the parts shared by traces and summaries.

#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

/// Category of slices that show another engine's queries and phases.
inline constexpr std::string_view kEngineCategory = "engine";

void write_json(JsonWriter& w, const BodyInfo& body);
void write_json(JsonWriter& w, const Counters& counters);
void write_json(JsonWriter& w, const CollideRequest& request);
/// Writes {"faces", "refined"}, each for A and B.
void write_json(JsonWriter& w, const Separation& separation);
/// Writes the convergence of bounds (key "course"): a list of [work, lower, upper], or of [work, t0, t1,
/// lower, upper]. Infinite values are written as null.
void write_history(JsonWriter& w, const std::vector<Bounds>& history);
void write_history(JsonWriter& w, const std::vector<ContactBounds>& history);
/// Writes the answer to a further query, a Measured... or an EngineReport.
template <class Measured>
void write_json(JsonWriter& w, const Measured& m);
/// Writes the members of a first contact except its bound history, without brackets.
void write_answer(JsonWriter& w, const MeasuredApproach& m);
/// Writes a pose as the 12 numbers of a 3x4 matrix, row by row, as in pose files.
void write_json(JsonWriter& w, const Pose& pose);
/// Writes the members of a step's answer to `request`, without brackets.
void write_answer(JsonWriter& w, const StepResult& result, const CollideRequest& request);
/// Writes {"name", "hash"}.
void write_scenario(JsonWriter& w, const TraceHeader& header);
/// Writes {"stored", "seen", "cap", "truncated"}.
void write_event_counts(JsonWriter& w, const Trace& trace);

/// Writes a trace's `metadata`: everything not in its events.
void write_metadata(const Trace& trace, JsonOut& out);

}  // namespace lrb::trace
