#include "scenarios/profile/captured_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/profile/query_walk.hpp"
#include "scenarios/profile/tree_report.hpp"
#include "scenarios/profile/verdicts.hpp"
#include "scenarios/profile/volumes.hpp"
#include "scenarios/record/engine_run.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::profile {
namespace {

/// Returns the events of one step.
std::vector<capture::Event> events_of(std::span<const trace::Event> events) {
  std::vector<capture::Event> out;
  bool is_body = true;  // else a level of detail, whose nodes have other numbers
  for (const trace::Event& e : events) {
    if (e.kind == lrb::EventKind::begin && walks_trees(e.phase())) {
      const trace::payload::PhaseBegin begin = e.phase_begin();
      is_body = begin.walked_a == 0 && begin.walked_b == 0;
    }
    if (!is_body) continue;
    if (e.kind == lrb::EventKind::node_pair) {
      const trace::payload::NodePair pair = e.node_pair();
      out.push_back({.a = pair.a,
                     .b = pair.b,
                     .kind = capture::EventKind::nodes,
                     .met = pair.work.met,
                     .tests = pair.work.box_tests});
    } else if (e.kind == lrb::EventKind::face_test) {
      const trace::payload::FaceTest test = e.face_test();
      out.push_back({.a = test.a,
                     .b = test.b,
                     .kind = capture::EventKind::triangles,
                     .met = static_cast<std::uint8_t>(test.meet != exact::Meet::disjoint)});
    }
  }
  return out;
}

}  // namespace

capture::Capture captured(const record::Recording& recording) {
  const trace::Trace& trace = recording.trace;
  const std::string who = trace.header.scenario.empty() ? "the run" : trace.header.scenario;
  if (recording.bodies.size() != 2 || recording.bodies[0].rep.dim() != 3)
    throw InputError(who + ": expected a run of two 3D bodies, found another; record two 3D bodies");
  if (recording.trees.size() != 2)
    throw InputError(who + ": expected pairs of tree nodes, found none; record it with --events nodes");
  capture::Capture out;
  out.engine = trace.header.engine.empty() ? "lrbscope " + trace.header.lrbscope : trace.header.engine;
  for (std::uint32_t side = 0; side < 2; ++side) {
    OwnTree own = own_tree(recording.bodies[side].rep, recording.trees[side]);
    own.tree.id = side + 1;
    own.tree.mesh = side;
    out.meshes.push_back(std::move(own.mesh));
    out.trees.push_back(std::move(own.tree));
  }
  for (std::size_t i = 0; i < trace.steps.size(); ++i) {
    const trace::Step& step = trace.steps[i];
    capture::Query q;
    q.number = static_cast<std::uint32_t>(i + 1);
    q.kind = trace.header.request.mode == Mode::all_pairs ? capture::QueryKind::all_pairs
                                                          : capture::QueryKind::any;
    q.trees = {0, 1};
    q.poses = {step.pose_a, step.pose_b};
    q.ended = true;
    q.verdict = step.result.pair_count > 0 ? capture::Verdict::intersecting : capture::Verdict::separate;
    q.pairs = step.result.pair_count;
    q.events = events_of(trace.events_of(i));
    q.parts = {{0, 0, q.events.size()}};
    // A trace that reached its limit lacks events of its last steps.
    q.events_seen = q.events.size() + (step.events_seen - trace.events_of(i).size());
    out.queries.push_back(std::move(q));
  }
  return out;
}

using render::counted;

void describe_probes(capture::Capture& capture) {
  std::map<std::vector<double>, std::uint32_t> known;  // tree by that of A and the vertices
  std::map<std::uint32_t, double> reach;               // by mesh
  for (capture::Query& q : capture.queries) {
    if (q.probe.shape == capture::ProbeShape::none) continue;
    const capture::Tree& tree = capture.trees[q.trees[0]];
    if (!reach.contains(tree.mesh)) reach[tree.mesh] = reach_of(capture.meshes[tree.mesh]);
    ProbeBody probe = probe_body(q, tree, reach[tree.mesh]);
    std::vector<double> key{double(q.trees[0]), double(q.probe.shape)};
    for (const Eigen::Vector3d& x : probe.mesh.vertices) key.insert(key.end(), x.data(), x.data() + 3);
    const auto [found, is_new] = known.emplace(key, static_cast<std::uint32_t>(capture.trees.size()));
    q.trees[1] = found->second;
    if (!is_new) continue;
    if (q.probe.shape == capture::ProbeShape::point) {  // pictures show its volume as a mark
      constexpr double kMark = 0.01;
      for (const std::size_t i : {3, 7, probe.tree.volumes.size() == 12 ? 11 : 9})
        probe.tree.volumes[i] = kMark * reach[tree.mesh];
    }
    probe.tree.mesh = static_cast<std::uint32_t>(capture.meshes.size());
    capture.meshes.push_back(std::move(probe.mesh));
    capture.trees.push_back(std::move(probe.tree));
  }
}

TreePairs tree_pairs(const capture::Capture& capture) {
  TreePairs out;
  std::map<std::array<std::uint32_t, 2>, std::size_t> at;
  for (std::size_t i = 0; i < capture.queries.size(); ++i) {
    const std::array<std::uint32_t, 2>& trees = capture.queries[i].trees;
    if (trees[0] == kNull || trees[1] == kNull) {
      ++out.without_tree;
      continue;
    }
    const auto [found, is_new] = at.emplace(trees, out.pairs.size());
    if (is_new) out.pairs.push_back({trees, {}});
    out.pairs[found->second].queries.push_back(i);
  }
  return out;
}

bodies::LoadedBody captured_body(const capture::Mesh& mesh) {
  Mesh out;
  out.name = mesh.name.empty() ? "mesh" : mesh.name;
  out.vertices = mesh.vertices;
  for (const auto& corners : mesh.triangles) {
    const VertexId face[] = {VertexId(corners[0]), VertexId(corners[1]), VertexId(corners[2])};
    out.add_face(face);
  }
  // Both steps keep the numbers of faces: merging corners of a triangle soup, so that a closed one has an
  // inside, and turning components.
  join_corners_of_mesh(out);
  MadeBody made = make_body_of_faces(check(std::move(out)));
  std::vector<std::string> notes;
  if (!made.rep.closed())
    notes.push_back(printable_name(made.rep.name()) +
                    ": not a closed solid; pairs are exact, but inside and outside are undefined");
  return {std::move(made.rep), std::move(notes), 0};
}

namespace {

/// Returns the shape of a captured tree, with each volume's own box (Volumes::box). A broken tree keeps what
/// holds: see TreeShape::finish(); triangles that do not exist are left out. Adds a line to `notes` for each
/// kind of fault.
trace::TreeShape captured_shape(const capture::Tree& tree, std::uint32_t triangles, const std::string& name,
                                std::vector<std::string>& notes) {
  trace::TreeShape out;
  const Volumes volumes(tree);
  std::uint64_t unknown = 0;
  std::vector<char> is_in_leaf(triangles, 0);
  for (std::uint32_t n = 0; n < tree.size(); ++n) {
    std::vector<SimplexId> simplices;
    for (const std::uint32_t t : tree.triangles(n)) {
      if (t >= triangles) {
        ++unknown;
        continue;
      }
      simplices.emplace_back(t);
      is_in_leaf[t] = 1;
    }
    out.add(tree.children(n), simplices, volumes.box(n));
  }
  const trace::TreeShape::Faults faults = out.finish();
  const auto missing = static_cast<std::uint64_t>(std::count(is_in_leaf.begin(), is_in_leaf.end(), 0));
  const auto add = [&](std::uint64_t count, const char* one, const char* many) {
    if (count > 0) notes.push_back(name + ": " + counted(count, one, many));
  };
  add(faults.links, "link to a node with another parent is left out",
      "links to nodes with other parents are left out");
  add(faults.unreachable, "node is not below the root", "nodes are not below the root");
  add(unknown, "triangle of a leaf does not exist", "triangles of leaves do not exist");
  // In the leaf of a box, one triangle stands for all.
  if (tree.id != 0) add(missing, "triangle is in no leaf", "triangles are in no leaf");
  return out;
}

trace::EngineReport report_of(const capture::Query& query) {
  trace::EngineReport out;
  out.query = query.kind;
  out.verdict = query.verdict;
  out.pairs = query.pairs;
  out.complete = query.complete();
  out.thread = query.thread;
  out.begin_ns = static_cast<std::uint64_t>(std::llround(std::max(query.begin_ns, 0.0)));
  out.duration_ns = static_cast<std::uint64_t>(std::llround(std::max(query.duration_ns, 0.0)));
  return out;
}

std::vector<SimplexPair> pairs_of(const capture::Query& query) {
  std::vector<SimplexPair> out;
  for (const capture::Event& e : query.events)
    if (e.kind == capture::EventKind::triangles && e.met > 0) out.push_back({SimplexId(e.a), SimplexId(e.b)});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::uint32_t saturated(std::uint64_t value) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, kNull));
}

/// Reports an engine's queries to a recorder, as one of lrbscope's would.
class QueryReplay {
 public:
  /// The indices of both trees must outlive this object.
  QueryReplay(trace::Recorder& recorder, const TreeIndex& a, const TreeIndex& b)
      : recorder_(recorder), a_(a), b_(b) {}

  /// Returns the engine's answer, and adds its counters and phases to `report`.
  CollideResult replay(const capture::Query& query, trace::EngineReport& report) {
    const std::vector<Visit> visits = visits_of(a_, b_, query.events);
    std::vector<std::uint32_t> reported(visits.size(), kNull);
    CollideResult result;
    recorder_.begin(Phase::walk, 0, 0);
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const capture::Event& e = query.events[i];
      switch (e.kind) {
        case capture::EventKind::nodes:
          reported[i] = node_pair(e, visits[i], reported);
          result.counters.node_pairs += 1;
          result.counters.box_tests += e.tests;
          break;
        case capture::EventKind::triangles:
          triangles(e);
          result.counters.face_tests += 1;
          break;
        case capture::EventKind::count:
          report.counts.push_back({e.a, saturated(recorder_.events_of_step()), e.b});
          break;
        case capture::EventKind::phase:
          report.phases.push_back({e.a, saturated(recorder_.events_of_step()), 0});
          break;
      }
    }
    recorder_.end(Phase::walk, result.counters.box_tests);
    result.counters.real_tests = result.counters.face_tests;
    result.pairs = pairs_of(query);
    // The engine's verdict; without one, the pairs that it found.
    const bool meets = query.verdict != capture::Verdict::unreported
                           ? query.verdict == capture::Verdict::intersecting
                           : !result.pairs.empty();
    result.relation = meets ? Relation::crossing : Relation::separate;
    return result;
  }

 private:
  std::uint32_t node_pair(const capture::Event& e, const Visit& v,
                          const std::vector<std::uint32_t>& reported) {
    const std::uint32_t id =
        recorder_.node_pair({.a = e.a,
                             .b = e.b,
                             .parent = v.parent == Visit::kNone ? kNull.kValue : reported[v.parent],
                             .step = v.step.value_or(NodeStep::descend_both),
                             .box_tests = e.tests,
                             .met = v.children > 0 && v.step != NodeStep::leaves ? v.children : e.met});
    if (e.axis != capture::kNoAxis) recorder_.set_engine_axis(e.axis);
    return id;
  }

  void triangles(const capture::Event& e) {
    const exact::Meet meet = e.met > 0 ? exact::Meet::cross : exact::Meet::disjoint;
    recorder_.face_test(SimplexId(e.a), SimplexId(e.b), meet, 0, 0);
    if (e.met > 0) recorder_.contact(SimplexId(e.a), SimplexId(e.b), meet);
  }

  trace::Recorder& recorder_;
  const TreeIndex &a_, &b_;
};

trace::RecorderSettings recorder_settings(const capture::Capture& capture,
                                          const CapturedRunSettings& settings) {
  trace::RecorderSettings out = settings;
  out.level = EventLevel::nodes;
  out.engine = capture.engine.empty() ? "another engine" : capture.engine;
  out.names = capture.names;
  return out;
}

/// Adds the error of the distance, and takes out the pairs that the engine's precision cannot decide.
void add_verdict(Checker& checker, const capture::Query& query, const QueryWalk& walk,
                 const CollideResult& exact, record::WrongAnswer& wrong) {
  const QueryVerdict verdict = checker.check(query, &walk, &exact.pairs);
  if (query.value) wrong.distance = verdict.distance;
  wrong.is_verdict_undecidable = verdict.answer == Judgement::undecidable && verdict.distance.empty();
  std::erase_if(wrong.pairs, [&](const pictures::WrongPair& w) {
    const TrianglePair pair{w.pair.a, w.pair.b};
    if (!checker.is_undecidable(query, walk, pair, w.missed)) return false;
    ++(w.missed ? wrong.undecidable_missed : wrong.undecidable_false);
    return true;
  });
}

}  // namespace

record::Recording captured_run(const capture::Capture& capture, const TreePair& pair,
                               std::vector<bodies::LoadedBody> bodies, const CapturedRunSettings& settings,
                               const record::ProgressReport& progress) {
  record::Recording out;
  out.bodies = std::move(bodies);
  std::vector<TreeIndex> indices;
  for (std::size_t side = 0; side < 2; ++side) {
    const capture::Tree& tree = capture.trees[pair.trees[side]];
    const std::uint32_t triangles = out.bodies[side].rep.real_simplex_count();
    out.trees.push_back(
        captured_shape(tree, triangles, std::string("tree ") + (side == 0 ? "A" : "B"), out.notes));
    indices.emplace_back(tree, triangles);
  }
  trace::Recorder recorder(out.bodies[0].rep, out.bodies[1].rep, recorder_settings(capture, settings));
  QueryReplay replay(recorder, indices[0], indices[1]);
  const bool of_shapes = std::all_of(pair.queries.begin(), pair.queries.end(), [&](std::size_t i) {
    return capture.queries[i].kind == capture::QueryKind::shape;
  });
  CapturedBodies all(capture);
  Checker checker(all, precision_of(capture));
  // An engine that records no tests of triangles at all does not say which pairs it found.
  const bool records_triangles = std::ranges::any_of(capture.queries, tests_triangles);
  for (std::size_t i = 0; i < pair.queries.size(); ++i) {
    progress("query", i, pair.queries.size());
    const capture::Query& query = capture.queries[pair.queries[i]];
    recorder.begin_step(query.number, query.poses[0], query.poses[1]);
    std::optional<trace::EngineReport> report = report_of(query);
    report->complete = report->complete && records_triangles;
    const CollideResult answer = replay.replay(query, *report);
    if (settings.check && !of_shapes) {
      out.results.push_back(record::exact_answer(
          {out.bodies[0].rep, query.poses[0], out.bodies[1].rep, query.poses[1]}, {}, report, answer.pairs));
      fill_box(query, out.bodies[0].rep, capture.meshes[capture.trees[pair.trees[0]].mesh],
               out.results.back().pairs);
      if (report->query == trace::EngineQuery::distance && !is_first_hit(query))
        recorder.add(trace::measured(
            distance(out.bodies[0].rep, query.poses[0], out.bodies[1].rep, query.poses[1]), {}));
    }
    if (i < out.results.size()) {
      record::WrongAnswer& wrong = out.wrong.emplace_back();
      wrong.pairs = record::wrong_pairs(answer.pairs, out.results[i].pairs, report);
      const bool is_verdict_wrong =
          query.verdict != capture::Verdict::unreported &&
          (query.verdict == capture::Verdict::intersecting) == out.results[i].pairs.empty();
      if (query.value || is_verdict_wrong || !wrong.pairs.empty())
        add_verdict(checker, query, QueryWalk(all, query, all.trees_of(query).value()), out.results[i],
                    wrong);
      if (wrong.has_wrong_distance() && out.notes.size() < 10)
        out.notes.push_back("query " + std::to_string(query.number) + ": " + *wrong.distance);
    }
    recorder.add(std::move(*report));
    recorder.end_step(answer);
  }
  out.trace = recorder.take();
  if (out.trace.truncated())
    out.notes.push_back(out.trace.header.engine + ": the trace contains only the first " +
                        std::to_string(out.trace.events.size()) + " of " +
                        std::to_string(out.trace.events_seen) + " events; choose fewer queries (--queries)");
  return out;
}

std::string captured_words(const capture::Capture& capture, const TreePair& pair) {
  std::string out;
  const auto add = [&](const std::string& sentence) { out += (out.empty() ? "" : " ") + sentence; };
  const auto count = [&](const auto& test) {
    return static_cast<std::uint64_t>(std::count_if(pair.queries.begin(), pair.queries.end(),
                                                    [&](std::size_t i) { return test(capture.queries[i]); }));
  };
  const auto volume_words = [&](capture::VolumeKind kind, const char* name) {
    for (const std::uint32_t tree : pair.trees)
      if (capture.trees[tree].volume == kind && capture.trees[tree].id != 0)
        return add(std::string("Its ") + name + " are drawn as the boxes around them.");
  };
  volume_words(capture::VolumeKind::sphere, "spheres");
  volume_words(capture::VolumeKind::rss, "rounded rectangles");
  volume_words(capture::VolumeKind::kdop, "k-DOPs");
  if (const std::uint64_t n = count([](const auto& q) { return q.kind == capture::QueryKind::self; }); n > 0)
    add(counted(n, "query is", "queries are") +
        " of a body with itself, shown as two equal bodies in one place; only the pairs that the engine found "
        "are checked.");
  if (const std::uint64_t n =
          count([](const auto& q) { return q.kind == capture::QueryKind::first_contact; });
      n > 0)
    add(counted(n, "query is a search", "queries are searches") +
        " for the first contact, shown at the first pose; the answer is not checked.");
  if (const std::uint64_t n = count([](const auto& q) { return q.kind == capture::QueryKind::shape; }); n > 0)
    add(counted(n, "query is", "queries are") +
        " of A with a shape: B is drawn as it was described, tests show its first triangle, and the answer is not "
        "checked.");
  if (capture.every > 1)
    add("One of " + std::to_string(capture.every) + " queries was recorded; all numbers are of these.");
  if (const std::uint64_t n = count([](const auto& q) { return !q.complete(); }); n > 0)
    add("The capture does not contain all events of " + counted(n, "query.", "queries."));
  return out;
}

pictures::FrameSpec captured_frames() {
  pictures::FrameSpec out;
  out.views = frames::whole_and_contact();
  out.views[0].wrapper = false;
  out.views[0].title = "Overview";
  out.views[1].title = "Contact";
  out.most = 12;
  out.colour_by = pictures::FrameSpec::ColourBy::box_tests;
  return out;
}

std::string mesh_name(const capture::Capture& c, std::uint32_t tree) {
  const std::filesystem::path name = c.meshes[c.trees[tree].mesh].name;
  if (name.filename().empty()) return "mesh " + std::to_string(c.trees[tree].mesh + 1);
  return printable_name((has_mesh_extension(name.string()) ? name.stem() : name.filename()).string());
}

spec::Scenario captured_scenario(const capture::Capture& c, const TreePair& pair,
                                 const std::vector<bodies::LoadedBody>& bodies, const std::string& file) {
  spec::Scenario s;
  s.name = mesh_name(c, pair.trees[0]) + "-" + mesh_name(c, pair.trees[1]) + ", " + c.engine;
  // Every number on the page is of the sample.
  if (c.every > 1) s.name += ", a sample: one of " + std::to_string(c.every) + " queries";
  const capture::Query &first = c.queries[pair.queries.front()], &last = c.queries[pair.queries.back()];
  s.purpose = "Recorded in " + c.engine + ": " + counted(pair.queries.size(), "query", "queries") + " of " +
              printable_name(std::filesystem::path(file).filename().string()) + ", number " +
              std::to_string(first.number) +
              (pair.queries.size() > 1 ? " to " + std::to_string(last.number) : "") +
              "; time steps have these numbers.";
  if (const std::string more = captured_words(c, pair); !more.empty()) s.purpose += " " + more;
  s.bodies = {{}, {}};
  s.event_cap = 20'000'000;  // in a gigabyte of memory
  s.events = EventLevel::nodes;
  s.frames = captured_frames();
  Fnv64 hash;
  for (const bodies::LoadedBody& body : bodies) hash.add_value(body.rep.hash());
  for (const std::size_t i : pair.queries)
    for (const Pose& pose : c.queries[i].poses) {
      hash.add_bytes(pose.r.data(), sizeof(double) * 9);
      hash.add_bytes(pose.t.data(), sizeof(double) * 3);
    }
  s.hash = hash.value();
  return s;
}

std::vector<bodies::LoadedBody> captured_bodies(const capture::Capture& c, const TreePair& pair) {
  std::vector<bodies::LoadedBody> out;
  for (const std::uint32_t tree : pair.trees) {
    out.push_back(captured_body(c.meshes[c.trees[tree].mesh]));
    if (c.trees[tree].id == 0) out.back().notes.clear();  // a ray is no solid
  }
  return out;
}

CapturedRunSettings captured_settings(const spec::Scenario& scenario, const capture::Capture& c,
                                      const TreePair& pair, const std::string& file) {
  CapturedRunSettings out;
  out.scenario = scenario.name;
  out.scenario_hash = scenario.hash;
  for (std::size_t side = 0; side < 2; ++side)
    out.sources[side] = file + ", " + mesh_name(c, pair.trees[side]);
  out.event_cap = scenario.event_cap;
  return out;
}

}  // namespace lrb::profile
