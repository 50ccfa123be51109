#include "scenarios/record/recorded_run.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <system_error>

#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/record/engine_run.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::record {
namespace {

/// Throws if an event locates a vertex that the body does not have.
void check_vertex(const Recording& run, const trace::Event& e) {
  const std::size_t side = static_cast<std::size_t>(e.side);
  const std::size_t count =
      side < run.bodies.size() ? run.bodies[side].rep.vertices().size() : std::size_t{0};
  if (e.a >= count)
    throw InputError("an event refers to vertex " + std::to_string(e.a) + " of " +
                     std::string(name_of(e.side)) + ", which has only " + std::to_string(count));
}

/// Throws if the trace cannot be a recording of the run's bodies.
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

/// Computes the contacts of each step, which a trace does not contain, and what another engine got wrong.
void add_contacts(Recording& run) {
  const trace::Trace& trace = run.trace;
  if (run.bodies.size() < 2 || trace.header.request.mode != Mode::all_pairs ||
      trace.header.request.is_coarse())
    return;
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const trace::Step& step = trace.steps[i];
    const std::optional<trace::EngineReport>& report = step.result.engine;
    const std::vector<SimplexPair> found = pairs_found(trace.events_of(i));
    run.results.push_back(exact_answer({run.bodies[0].rep, step.pose_a, run.bodies[1].rep, step.pose_b},
                                       trace.header.request, report, found));
    if (trace.header.engine.empty()) continue;
    // Pairs of a step whose events were cut are not all known.
    const bool is_whole = step.events_seen == trace.events_of(i).size();
    run.wrong.emplace_back();
    if (is_whole) run.wrong.back().pairs = wrong_pairs(found, run.results.back().pairs, report);
  }
}

/// Returns the trees of another engine, if they were kept beside the trace.
std::vector<trace::TreeShape> engine_trees(const std::string& trace_path, const trace::TraceHeader& header) {
  const std::string path = (std::filesystem::path(trace_path).parent_path() / kTreesFile).string();
  std::error_code ignored;
  if (header.engine.empty() || header.bodies.size() != 2 || !std::filesystem::exists(path, ignored))
    return {};
  return read_trees(io::read_text(path), printable_name(path),
                    {header.bodies[0].real_simplices, header.bodies[1].real_simplices});
}

/// Loads the recorded bodies: those in `given`, or if it is empty the files of these names next to the trace.
std::vector<bodies::LoadedBody> find_bodies(const std::string& trace_path,
                                            const std::vector<std::string>& given,
                                            const std::vector<std::string>& names) {
  std::vector<std::string> paths = given;
  if (paths.empty()) {
    const std::filesystem::path beside = std::filesystem::path(trace_path).parent_path();
    for (const std::string& name : names) paths.push_back((beside / name).string());
  }
  if (paths.size() != names.size())
    throw InputError(trace_path + ": has " + std::to_string(names.size()) + " bodies, but --bodies gives " +
                     std::to_string(paths.size()));
  std::vector<bodies::LoadedBody> out;
  out.reserve(paths.size());
  if (paths.size() == 2)
    for (bodies::LoadedBody& body : bodies::load_two_bodies(paths[0], paths[1]))
      out.push_back(std::move(body));
  else
    for (const std::string& path : paths) out.push_back(bodies::load_body(path));
  return out;
}

}  // namespace

Recording open_run(trace::Trace trace, const std::string& trace_path,
                   const std::vector<std::string>& bodies) {
  Recording out;
  out.trace = std::move(trace);
  const bool alone = out.trace.header.bodies.size() == 1;
  out.bodies =
      find_bodies(trace_path, bodies,
                  alone ? std::vector<std::string>{"a.lrb"} : std::vector<std::string>{"a.lrb", "b.lrb"});
  out.trees = out.trace.header.engine.empty() ? trees_of(out.trace, out.bodies)
                                              : engine_trees(trace_path, out.trace.header);
  check_events(trace_path, out);
  add_contacts(out);
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
        ": no trace.json or trace.json.gz found; give the output folder of `lrbscope run`, or of "
        "`lrbscope import --trace`");
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
    throw InputError(printable_name(path) + ": expected a run of two bodies, found one body");
  if (trace.steps.empty()) throw InputError(printable_name(path) + ": the trace has no time steps");
  const auto at =
      number ? std::ranges::find_if(trace.steps, [&](const trace::Step& s) { return s.index == *number; })
             : trace.steps.end() - 1;
  if (at == trace.steps.end())
    throw InputError(printable_name(path) + ": no step " + std::to_string(*number) +
                     " in the trace; expected one from " + std::to_string(trace.steps.front().index) +
                     " to " + std::to_string(trace.steps.back().index));
  OpenStep out{find_bodies(path, {}, {"a.lrb", "b.lrb"}), *at};
  for (std::size_t i = 0; i < out.bodies.size(); ++i)
    if (out.bodies[i].rep.hash() != trace.header.bodies[i].hash)
      throw InputError(printable_name(path) + ": the .lrb file next to it is not the recorded body " +
                       (i == 0 ? "A" : "B"));
  return out;
}

namespace {

std::string source_of(const spec::BodySpec& spec) {
  return spec.file.empty() ? "generator " + spec.generator : spec.file;
}

trace::RecorderSettings recorder_settings(const spec::Scenario& s) {
  trace::RecorderSettings settings;
  settings.scenario = s.name;
  settings.scenario_hash = s.hash;
  for (std::size_t i = 0; i < s.bodies.size(); ++i) settings.sources[i] = source_of(s.bodies[i]);
  settings.request = s.request;
  settings.clock = s.clock;
  settings.event_cap = s.event_cap;
  settings.level = std::max(s.events, pictures::needed_level(s.frames));
  settings.coherent = s.more.coherent;
  return settings;
}

std::string note_of(const spec::Approach& approach) {
  const std::string step = spec::contact_step(approach.search);
  if (!step.empty())
    return "first contact at " + step + ", " + spec::contact_way(approach.search) +
           "; the first step in contact is step " + std::to_string(approach.first_contact);
  return approach.met ? "first contact at step " + std::to_string(approach.first_contact)
                      : "the bodies do not touch along the path";
}

std::vector<Pose> poses_of_b(const spec::Scenario& s, Recording& r) {
  if (s.motion.kind != spec::Motion::Kind::approach) return spec::poses_of(s.motion, s.bodies[1].pose);
  spec::Approach approach = spec::find_approach(r.bodies[0].rep, s.bodies[0].pose, r.bodies[1].rep,
                                                s.bodies[1].pose, s.motion, s.more.distance);
  r.notes.push_back(note_of(approach));
  r.trace.header.first_contact = std::move(approach.search);
  return std::move(approach.poses);
}

/// Runs the queries of a run's steps in order.
class StepQueries {
 public:
  StepQueries(const spec::Scenario& s, const LrbRep& a, const LrbRep& b) : s_(s), a_(a), b_(b) {
    // Always use caches: whether they save time depends on timing, and a trace must be reproducible.
    if (s.more.coherent) coherent_.emplace(a, b, s.request, CoherentQuery::CacheUse::always);
    if (!s.more.points.empty()) points_ = io::read_points(s.more.points);
  }

  CollideResult ask(std::uint32_t step, const Pose& pose_a, const Pose& pose_b, trace::Recorder& recorder) {
    try {
      CollideResult result =
          coherent_ ? coherent_->collide(pose_a, pose_b, recorder)
                    : std::move(collide(a_, pose_a, b_, pose_b, s_.request, workspace_, &recorder).value());
      ask_more(pose_a, pose_b, recorder);
      return result;
    } catch (const InputError& e) {
      throw InputError("scenario " + s_.name + ", step " + std::to_string(step) + ": " + e.what());
    }
  }

 private:
  void ask_more(const Pose& pose_a, const Pose& pose_b, trace::Recorder& recorder) {
    if (s_.more.distance) {
      BoundsHistory reported;
      const DistanceResult found = distance(a_, pose_a, b_, pose_b, {}, reported);
      recorder.add(trace::measured(found, std::move(reported.history)));
    }
    if (s_.more.clash) {
      ClashHistory reported;
      const ClashResult found = clash(a_, pose_a, b_, pose_b, *s_.more.clash, reported);
      recorder.add(trace::measured(found, std::move(reported.of_depth)));
    }
    if (s_.more.near) {
      NearPairsRequest request;
      request.within = *s_.more.near;
      recorder.add(trace::measured(near_pairs(a_, pose_a, b_, pose_b, request), request.within));
    }
    if (s_.more.manifold) {
      ManifoldRequest request;
      request.margin = *s_.more.manifold;
      manifolds_ = contact_manifolds(a_, pose_a, b_, pose_b, request, manifolds_ ? &*manifolds_ : nullptr);
      recorder.add(trace::measured(*manifolds_, request.margin));
    }
    if (!points_.empty()) {
      std::vector<Eigen::Vector3d> placed;
      for (const Eigen::Vector3d& x : points_) placed.push_back(pose_b.apply(x));
      recorder.add(trace::measured(point_distances(a_, pose_a, placed), placed, a_.closed()));
    }
  }

  const spec::Scenario& s_;
  const LrbRep &a_, &b_;
  std::vector<Eigen::Vector3d> points_;  ///< of B
  std::optional<CoherentQuery> coherent_;
  std::optional<ManifoldResult> manifolds_;  ///< of the previous step, whose ids continue
  Workspace workspace_;
};

void record_collision(const spec::Scenario& s, Recording& r, const ProgressReport& progress) {
  const LrbRep &a = r.bodies[0].rep, &b = r.bodies[1].rep;
  const std::vector<Pose> poses = poses_of_b(s, r);
  trace::Recorder recorder(a, b, recorder_settings(s));
  StepQueries queries(s, a, b);
  for (std::uint32_t step = 0; step < poses.size(); ++step) {
    progress("query", step, poses.size());
    const Pose& pose_a = s.motion.of_a.empty() ? s.bodies[0].pose : s.motion.of_a[step];
    recorder.begin_step(step, pose_a, poses[step]);
    r.results.push_back(queries.ask(step, pose_a, poses[step], recorder));
    recorder.end_step(r.results.back());
  }
  trace::Trace recorded = recorder.take();
  recorded.header.first_contact = std::move(r.trace.header.first_contact);
  r.trace = std::move(recorded);
}

/// Returns all regions, those of the builder's last pass (the outermost ones) first, so that each can be
/// refined in turn.
std::vector<RegionId> outside_in(const LrbRep& rep) {
  std::vector<RegionId> order(rep.region_count());
  std::iota(order.begin(), order.end(), RegionId{0});
  std::ranges::stable_sort(order, [&](RegionId x, RegionId y) { return rep.layer(x) > rep.layer(y); });
  return order;
}

void require_closed(const spec::Scenario& s, const LrbRep& rep) {
  if (rep.closed()) return;
  throw InputError("scenario " + s.name + ": body a, " + printable_name(source_of(s.bodies[0])) +
                   ", is open, so it has no wrapper to refine or to construct; close it (lrbscope inspect "
                   "lists its open edges, lrbscope close fills holes), or show a collision");
}

/// Returns the transitions from a lid through the regions to a real face: "face 7 -> region 3 -> face 2".
std::string transitions(const LrbRep& rep, const std::vector<RegionId>& regions, FaceId face) {
  std::string out;
  CellId outer = kOutside;
  for (const RegionId region : regions) {
    const auto lids = rep.lids(region);
    const auto lid = std::ranges::find_if(lids, [&](FaceId f) { return rep.outer_cell(f) == outer; });
    if (lid != lids.end()) out += "face " + std::to_string(*lid) + " -> ";  // a void has no lids
    out += "region " + std::to_string(region) + " -> ";
    outer = region;
  }
  return out + "face " + std::to_string(face);
}

void record_refinement(const spec::Scenario& s, Recording& r) {
  const LrbRep& rep = r.bodies[0].rep;
  require_closed(s, rep);
  trace::Recorder recorder(rep, recorder_settings(s));
  const Pose& pose = s.bodies[0].pose;
  const auto record = [&](std::uint32_t step, const std::vector<RegionId>& regions) {
    recorder.begin_step(step, pose);
    for (const RegionId region : regions)
      recorder.refine(Side::a, region, static_cast<std::uint32_t>(rep.floor(region).size()));
  };
  if (s.towards.empty()) record(0, outside_in(rep));
  const std::vector<PointDistance> nearest =
      point_distances(rep, pose, s.towards, {.tolerance = 0, .relative_tolerance = 0, .side = false});
  for (std::uint32_t i = 0; i < nearest.size(); ++i) {
    const FaceId face = nearest[i].closest.face;
    Wrapper wrapper(rep);
    wrapper.refine_path(rep.outer_cell(face));
    record(i, wrapper.excluded());
    r.notes.push_back("towards point " + std::to_string(i) + ": " +
                      transitions(rep, wrapper.excluded(), face));
  }
  r.trace = recorder.take();
}

void record_known(const spec::Scenario& s, Recording& r) {
  const LrbRep& rep = r.bodies[0].rep;
  require_closed(s, rep);
  r.trace = trace::known_construction(rep, s.bodies[0].pose, recorder_settings(s));
  if (rep.region_count() > 0)
    r.notes.push_back(rep.name() + ": its regions were not built in this run, so they are shown by layers");
}

void record_construction(const spec::Scenario& s, Recording& r) {
  trace::ConstructRecorder recorder(recorder_settings(s));
  spec::BodySpec body = s.bodies[0];
  body.build.probe = &recorder;
  r.bodies.push_back(make_body(body));
  if (recorder.empty()) return record_known(s, r);
  r.trace = recorder.take(r.bodies[0].rep, body.pose);
}

/// Adds data derived from a recorded run: drawing options, trees, notes.
void finish(const spec::Scenario& s, Recording& r) {
  r.trace.header.pictures = spec::pictures_text(s.frames);
  r.trees = trees_of(r.trace, r.bodies);
  std::vector<std::string> of_bodies;
  for (const bodies::LoadedBody& body : r.bodies)
    of_bodies.insert(of_bodies.end(), body.notes.begin(), body.notes.end());
  r.notes.insert(r.notes.begin(), of_bodies.begin(), of_bodies.end());
  if (r.trace.truncated())
    r.notes.push_back("the trace contains only the first " + std::to_string(r.trace.events.size()) + " of " +
                      std::to_string(r.trace.events_seen) + " events (trace.max_events)");
}

}  // namespace

std::vector<trace::TreeShape> trees_of(const trace::Trace& trace,
                                       const std::vector<bodies::LoadedBody>& bodies) {
  std::vector<trace::TreeShape> out;
  if (trace.header.level == EventLevel::faces || !trace.header.engine.empty() || bodies.size() != 2)
    return out;
  for (const bodies::LoadedBody& body : bodies) out.emplace_back(body.rep.tree());
  return out;
}

bodies::LoadedBody make_body(const spec::BodySpec& spec) {
  if (!spec.file.empty()) return bodies::load_body(spec.file, spec.build);
  if (std::optional<LrbRep> rep = generators::generate_rep(spec.generator, spec.parameters, spec.build.seed))
    return {std::move(*rep), {}, 0};
  return bodies::body_of_mesh(generators::generate(spec.generator, spec.parameters, spec.build.seed),
                              spec.build);
}

Recording record(const spec::Scenario& scenario, const ProgressReport& progress) {
  if (scenario.show == spec::Show::construction) {
    progress("build", 0, 1);
    Recording r;
    record_construction(scenario, r);
    finish(scenario, r);
    return r;
  }
  std::vector<bodies::LoadedBody> bodies;
  for (std::size_t i = 0; i < scenario.bodies.size(); ++i) {
    progress("build", i, scenario.bodies.size());
    bodies.push_back(make_body(scenario.bodies[i]));
  }
  return record(scenario, std::move(bodies), progress);
}

Recording record(const spec::Scenario& scenario, std::vector<bodies::LoadedBody> bodies,
                 const ProgressReport& progress) {
  Recording r;
  r.bodies = std::move(bodies);
  switch (scenario.show) {
    case spec::Show::collision:
      record_collision(scenario, r, progress);
      break;
    case spec::Show::refinement:
      record_refinement(scenario, r);
      break;
    case spec::Show::construction:
      record_known(scenario, r);
      break;
  }
  finish(scenario, r);
  return r;
}

std::vector<std::string> mismatches(const spec::Scenario& scenario, const Recording& r) {
  std::vector<std::string> out;
  for (const spec::Expectation& e : scenario.expect) {
    const std::string where = e.place + ": step " + std::to_string(e.step) + ": ";
    if (e.step >= r.results.size()) {
      out.push_back(where + "the run has only " + std::to_string(r.results.size()) + " steps");
      continue;
    }
    const CollideResult& result = r.results[e.step];
    const std::uint64_t print = fingerprint(result.pairs);
    if (e.relation && *e.relation != result.relation)
      out.push_back(where + "expected relation " + to_string(*e.relation) + ", found " +
                    to_string(result.relation));
    if (e.pairs && *e.pairs != result.pairs.size())
      out.push_back(where + "expected " + std::to_string(*e.pairs) + " pairs, found " +
                    std::to_string(result.pairs.size()));
    if (e.fingerprint && *e.fingerprint != print)
      out.push_back(where + "expected fingerprint " + trace::to_hex(*e.fingerprint) + ", found " +
                    trace::to_hex(print));
    const std::uint64_t tests = result.counters.box_tests + result.counters.face_tests;
    if (e.max_tests && tests > *e.max_tests)
      out.push_back(where + "expected at most " + std::to_string(*e.max_tests) +
                    " tests of boxes and faces, found " + std::to_string(tests));
  }
  return out;
}

std::string numbered_frame(std::size_t frame) {
  std::ostringstream out;
  out << "frames/frame_" << std::setw(4) << std::setfill('0') << frame;
  return out.str();
}

std::string frame_file(std::size_t frame) {
  return numbered_frame(frame) + ".png";
}

void remove_old_frames(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/frames", error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && (name.ends_with(".png") || name.ends_with(".svg")))
      std::filesystem::remove(entry.path(), error);
  }
  for (const char* file : {"/montage.png", "/montage.svg", "/caption.txt", "/separation.png"})
    std::filesystem::remove(folder + file, error);
}

}  // namespace lrb::record
