/// The cells of proof maps tile the square of all pairs, for all kinds of bodies and queries.

#include "scenarios/frames/proof_map.hpp"

#include <numeric>

#include <doctest/doctest.h>

#include "scenarios/profile/captured_run.hpp"
#include "tests/matrix/bodies.hpp"
#include "tests/support/toy_engine.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::test {
namespace {

using frames::Argument;
using frames::ProofMap;

std::uint64_t pairs_of(const ProofMap& map, Argument argument) {
  return map.pairs[static_cast<std::size_t>(argument)];
}

/// Returns the map of the first step, after checks: each pair is in one cell, tested ones also in that of
/// their leaves; areas add up to the number of all pairs; and no cell but those of contacts, or in queries
/// that ended early of open pairs, has a pair of `truth`.
ProofMap checked_map(const frames::RecordedRun& recorded, std::span<const SimplexPair> truth, bool complete) {
  const std::optional<ProofMap> map = frames::proof_map(recorded, 0);
  REQUIRE(map);
  const std::size_t columns = map->size[1], all = map->size[0] * columns;
  CHECK(std::reduce(map->pairs.begin(), map->pairs.end()) == all);
  CHECK(map->strays == 0);
  std::vector<Argument> grid(all);
  std::vector<std::uint8_t> times(all);
  bool once = true;
  for (const frames::MapCell& cell : map->cells)
    for (std::size_t a = cell.low[0]; a < cell.high[0]; ++a)
      for (std::size_t b = cell.low[1]; b < cell.high[1]; ++b) {
        once &= times[a * columns + b]++ == (cell.is_upon() ? 1 : 0);
        grid[a * columns + b] = cell.argument;
      }
  CHECK(once);
  CHECK(std::ranges::count(times, 0) == 0);
  for (const Argument argument : {Argument::child_boxes, Argument::node_boxes, Argument::floats,
                                  Argument::filter, Argument::contact, Argument::tolerance})
    CHECK(static_cast<std::uint64_t>(std::ranges::count(grid, argument)) == pairs_of(*map, argument));
  const frames::MapAxis a(frames::walked_shape(recorded, 0, 0)), b(frames::walked_shape(recorded, 1, 0));
  for (const SimplexPair& pair : truth) {
    const Argument by = grid[std::size_t{a.rank[pair.a]} * columns + b.rank[pair.b]];
    CHECK((by == Argument::contact || (!complete && (by == Argument::open || by == Argument::face_boxes))));
  }
  if (complete) CHECK(pairs_of(*map, Argument::open) == 0);
  return *map;
}

trace::Trace recorded(const LrbRep& a, const LrbRep& b, const Pose& pose, const CollideRequest& request,
                      EventLevel level) {
  trace::RecorderSettings settings;
  settings.request = request;
  settings.level = level;
  trace::Recorder recorder(a, b, settings);
  Workspace workspace;
  recorder.begin_step(0, {}, pose);
  recorder.end_step(collide(a, {}, b, pose, request, workspace, &recorder).value());
  return recorder.take();
}

frames::RecordedRun run_of(const LrbRep& a, const LrbRep& b, const trace::Trace& trace) {
  frames::RecordedRun out;
  out.reps = {&a, &b};
  out.trace = &trace;
  return out;
}

}  // namespace

TEST_CASE("the cells of a proof map tile the square of all pairs, for every kind of body") {
  const matrix::Matrix all = matrix::make_matrix(2);
  std::uint64_t not_needed = 0;
  for (const matrix::Cell& cell : all.cells) {
    const matrix::Kind &x = all.kinds[cell.a], &y = all.kinds[cell.b];
    CAPTURE(x.name + " and " + y.name);
    const LrbRep a = LrbRep::without_regions(x.mesh, x.solid, !x.simple),
                 b = LrbRep::without_regions(y.mesh, y.solid, !y.simple);
    for (const matrix::Step& step : cell.steps)
      for (const Mode mode : {Mode::all_pairs, Mode::any_pair})
        for (const EventLevel level : {EventLevel::nodes, EventLevel::all}) {
          const trace::Trace trace = recorded(a, b, step.pose, {.mode = mode}, level);
          const ProofMap map = checked_map(run_of(a, b, trace), step.truth.pairs, mode == Mode::all_pairs);
          CHECK(map.visits ==
                static_cast<std::uint64_t>(std::ranges::count_if(
                    trace.events, [](const auto& e) { return e.kind == EventKind::node_pair; })));
          not_needed += pairs_of(map, Argument::open);
        }
  }
  CHECK(not_needed > 0);  // queries for one pair ended early
}

TEST_CASE("visits and tests of another tree of the same bodies are strays") {
  Mesh sphere = shapes::icosphere(2);
  const LrbRep a = LrbRep::without_regions(sphere, true, false);
  std::vector<VertexId>& corners = sphere.face_vertices;  // other faces have the same numbers
  std::rotate(corners.begin(), corners.begin() + 300, corners.end());
  const LrbRep b = LrbRep::without_regions(sphere, true, false);
  const trace::Trace trace = recorded(a, a, Pose::translation({1.5, 0.25, 0.125}), {}, EventLevel::all);
  CHECK(frames::proof_map(run_of(a, a, trace), 0)->strays == 0);
  CHECK(frames::proof_map(run_of(b, b, trace), 0)->strays > 0);
}

TEST_CASE("the map of another engine's query: each pair is rejected, tested, or not reported") {
  for (const bool wide : {false, true})
    for (const capture::QueryKind kind : {capture::QueryKind::all_pairs, capture::QueryKind::any}) {
      FaultyEngine engine;
      std::mt19937_64 random(1);
      const std::uint32_t a = engine.grow(engine.add(captured(shapes::icosphere(2))), random, 2),
                          b = engine.grow(engine.add(captured(shapes::icosphere(2))), random);
      engine.ask(a, {}, b, Pose::translation({1.5, 0.25, 0.125}), {.kind = kind, .wide = wide});
      const profile::TreePair pair = profile::tree_pairs(engine.capture).pairs[0];
      const record::Recording recording = profile::captured_run(
          engine.capture, pair, profile::captured_bodies(engine.capture, pair), {}, record::kSilent);
      frames::RecordedRun recorded =
          run_of(recording.bodies[0].rep, recording.bodies[1].rep, recording.trace);
      recorded.trees = &recording.trees;
      const bool complete = kind == capture::QueryKind::all_pairs;
      const ProofMap map = checked_map(recorded, recording.results[0].pairs, complete);
      CHECK(pairs_of(map, Argument::contact) == (complete ? recording.results[0].pairs.size() : 1));
      if (!complete && !wide) CHECK(pairs_of(map, Argument::open) > 0);
      // Spatial splits: the first triangle of a leaf is in another one as well.
      capture::Capture split = engine.capture;
      capture::Tree& tree = split.trees[a];
      tree.splits = true;
      tree.triangle.push_back(tree.triangle.front());
      ++tree.first_triangle.back();
      const record::Recording other =
          profile::captured_run(split, pair, profile::captured_bodies(split, pair), {}, record::kSilent);
      recorded = run_of(other.bodies[0].rep, other.bodies[1].rep, other.trace);
      recorded.trees = &other.trees;
      CHECK_FALSE(proof_map(recorded, 0));
    }
}

}  // namespace lrb::test
