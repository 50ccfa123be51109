#pragma once
/// The parts that traces and summaries have in common.

#include "trace/hex.hpp"
#include "trace/json_out.hpp"
#include "trace/names.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

void write_json(JsonWriter& w, const BodyInfo& body);
void write_json(JsonWriter& w, const Counters& counters);
void write_json(JsonWriter& w, const CollideRequest& request);
/// {"faces", "refined"}, each of A and B.
void write_json(JsonWriter& w, const Separation& separation);
/// Row-major 3x4, as in pose files.
void write_json(JsonWriter& w, const Pose& pose);
/// The members of a step's answer to `request`, without brackets.
void write_answer(JsonWriter& w, const StepResult& result, const CollideRequest& request);
/// {"name", "hash"}
void write_scenario(JsonWriter& w, const TraceHeader& header);
/// {"stored", "seen", "cap", "truncated"}
void write_event_counts(JsonWriter& w, const Trace& trace);

}  // namespace lrb::trace
