#include "scenarios/run/open_run.hpp"

#include <algorithm>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "engine/query/collide.hpp"
#include "trace/cursor.hpp"
#include "trace/node_work.hpp"
#include "trace/trace_json.hpp"

namespace lrb::run {
namespace {

/// Throws if the body has no vertex that an event says was located.
void check_vertex(const Recording& run, const trace::Event& e) {
  const std::size_t side = static_cast<std::size_t>(e.side);
  const std::size_t count =
      side < run.bodies.size() ? run.bodies[side].rep.vertices().size() : std::size_t{0};
  if (e.a >= count)
    throw InputError("an event is about vertex " + std::to_string(e.a) + " of " +
                     std::string(name_of(e.side)) + ", which has " + std::to_string(count));
}

/// Throws if the trace cannot have come from the run's bodies.
void check_events(const std::string& path, const Recording& run) {
  const trace::Trace& trace = run.trace;
  try {
    trace::Cursor cursor = run.bodies.size() == 1
                               ? trace::Cursor(trace, run.bodies[0].rep)
                               : trace::Cursor(trace, run.bodies[0].rep, run.bodies[1].rep);
    if (!trace.events.empty()) cursor.seek(static_cast<trace::EventId>(trace.events.size() - 1));
    for (const trace::Event& e : trace.events)
      if (e.kind == EventKind::point) check_vertex(run, e);
    for (std::size_t i = 0; i < run.trees.size(); ++i) {
      trace::count_nodes(run.trees[i], static_cast<Side>(i), trace.events);
      for (const trace::Event& e : trace.events)
        if (e.kind == EventKind::begin && walks_trees(e.phase()))
          trace::walked_tree(run.bodies[i].rep, i == 0 ? e.depth_a : e.depth_b);
    }
  } catch (const InputError& e) {
    throw InputError(printable_name(path) + ": " + e.what());
  }
}

std::vector<CollideResult> contacts_of(const trace::Trace& trace,
                                       const std::vector<bodies::LoadedBody>& bodies) {
  std::vector<CollideResult> out;
  if (bodies.size() < 2 || trace.header.request.mode != Mode::all_pairs || trace.header.request.is_coarse())
    return out;
  CollideRequest request = trace.header.request;
  request.contacts = true;
  request.separation = false;  // the trace holds it
  for (const trace::Step& step : trace.steps)
    out.push_back(collide(bodies[0].rep, step.pose_a, bodies[1].rep, step.pose_b, request));
  return out;
}

}  // namespace

std::vector<bodies::LoadedBody> find_bodies(const std::string& trace_path,
                                            const std::vector<std::string>& given,
                                            const std::vector<std::string>& names) {
  std::vector<std::string> paths = given;
  if (paths.empty()) {
    const std::filesystem::path beside = std::filesystem::path(trace_path).parent_path();
    for (const std::string& name : names) paths.push_back((beside / name).string());
  }
  if (paths.size() != names.size())
    throw InputError(trace_path + ": has " + std::to_string(names.size()) + " bodies, --bodies names " +
                     std::to_string(paths.size()));
  std::vector<bodies::LoadedBody> out;
  out.reserve(paths.size());
  for (const std::string& path : paths) out.push_back(bodies::load_body(path));
  return out;
}

Recording open_run(trace::Trace trace, const std::string& trace_path,
                   const std::vector<std::string>& bodies) {
  Recording out;
  out.trace = std::move(trace);
  const bool alone = out.trace.header.bodies.size() == 1;
  out.bodies =
      find_bodies(trace_path, bodies,
                  alone ? std::vector<std::string>{"a.lrb"} : std::vector<std::string>{"a.lrb", "b.lrb"});
  out.trees = trees_of(out.trace, out.bodies);
  check_events(trace_path, out);
  out.results = contacts_of(out.trace, out.bodies);
  return out;
}

std::string trace_of(const std::string& run) {
  std::error_code error;
  if (!std::filesystem::is_directory(run, error)) return run;
  std::string path = (std::filesystem::path(run) / "trace.json").string();
  if (!std::filesystem::exists(path, error)) path += ".gz";
  if (!std::filesystem::exists(path, error))
    throw InputError(
        printable_name(run) +
        ": there is no trace.json or trace.json.gz: give the folder of a run, as `lrbscope run -o` writes it");
  return path;
}

Recording open_run(const std::string& run) {
  const std::string path = trace_of(run);
  return open_run(trace::load_trace(path), path);
}

OpenStep open_step(const std::string& run, std::optional<std::uint32_t> number) {
  const std::string path = trace_of(run);
  const trace::Trace trace = trace::load_trace(path);
  if (trace.header.bodies.size() != 2)
    throw InputError(printable_name(path) + ": is of one body, and pairs are of two");
  if (trace.steps.empty()) throw InputError(printable_name(path) + ": has no time step");
  const auto at = number ? std::find_if(trace.steps.begin(), trace.steps.end(),
                                        [&](const trace::Step& s) { return s.index == *number; })
                         : trace.steps.end() - 1;
  if (at == trace.steps.end())
    throw InputError(printable_name(path) + ": has no step " + std::to_string(*number) +
                     "; its steps go from " + std::to_string(trace.steps.front().index) + " to " +
                     std::to_string(trace.steps.back().index));
  OpenStep out{find_bodies(path, {}, {"a.lrb", "b.lrb"}), *at};
  for (std::size_t i = 0; i < out.bodies.size(); ++i)
    if (out.bodies[i].rep.hash() != trace.header.bodies[i].hash)
      throw InputError(printable_name(path) + ": the body beside it is not the one that was recorded as " +
                       (i == 0 ? "A" : "B"));
  return out;
}

}  // namespace lrb::run
