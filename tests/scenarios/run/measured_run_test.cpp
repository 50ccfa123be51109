// Scenarios with distances and kinds of contact: records, texts, pictures and charts.
#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include <doctest/doctest.h>

#include "scenarios/frames/frame_state.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;

namespace {

std::string balls(const std::string& query) {
  return R"({"name": "gap", "purpose": "Two balls meet.", "bodies": {
      "a": {"generator": "ball", "parameters": {"frequency": 4}},
      "b": {"generator": "ball", "parameters": {"frequency": 4}}},
    "motion": {"kind": "approach", "from": [3, 0.2, 0.1], "most_steps": 1000, "before": 2, "into": 4,
               "step_length": 0.05},
    "query": )" +
         query + "}";
}

record::Recording recorded(const std::string& query) {
  return record::record(spec::parse_scenario(balls(query), "gap.json"), record::kSilent);
}

bool draws_line(const render::DrawList& list, render::Rgba colour) {
  return std::any_of(list.lines.begin(), list.lines.end(), [&](const render::DrawLine& line) {
    return line.colour == colour && line.points.size() == 2;
  });
}

frames::RecordedRun played(const record::Recording& r) {
  frames::RecordedRun run;
  run.reps = {&r.bodies[0].rep, &r.bodies[1].rep};
  run.trace = &r.trace;
  run.results = &r.results;
  return run;
}

/// The page's note about the depth at the end of a run.
std::string note_on_depth(const record::Recording& r) {
  for (const report::Number& number : run::step_numbers(played(r), r.trace.steps.size() - 1))
    if (number.label == "Penetration depth") return number.note;
  return {};
}

/// The state at the end of a step.
frames::FrameState at_end(const record::Recording& r, std::size_t step, const pictures::FrameSpec& spec) {
  frames::FrameState state(played(r), spec, false);
  state.seek(r.trace.steps[step].first_event + static_cast<trace::EventId>(r.trace.events_of(step).size()) -
             1);
  return state;
}

}  // namespace

TEST_CASE("measured runs: each step has its distance and clash, and the contact search is recorded") {
  const record::Recording r = recorded(R"({"distance": true, "clash": true})");
  REQUIRE(r.trace.steps.size() == 7);
  for (const trace::Step& step : r.trace.steps) {
    REQUIRE(step.result.distance.has_value());
    REQUIRE(step.result.clash.has_value());
    CHECK((step.result.distance->lower > 0) == (step.result.relation == Relation::separate));
    CHECK((step.result.clash->kind == ClashKind::apart) == (step.result.relation == Relation::separate));
  }
  CHECK(r.trace.steps.back().result.clash->kind == ClashKind::protrudes);
  CHECK(r.trace.steps.back().result.clash->depth->at(0) > 0.1);
  CHECK(r.trace.steps.back().result.clash->finished);
  CHECK(note_on_depth(r).ends_with(", proven"));
  std::string rocks = balls(R"({"clash": 1})");  // not convex: the search for their depth has steps
  for (std::size_t at; (at = rocks.find("ball\"")) != std::string::npos;) rocks.replace(at, 4, "rock");
  const record::Recording limited = record::record(spec::parse_scenario(rocks, "gap.json"), record::kSilent);
  CHECK_FALSE(limited.trace.steps.back().result.clash->finished);
  CHECK(note_on_depth(limited).ends_with(". The limit of steps was reached"));
  REQUIRE(r.trace.header.first_contact.has_value());
  CHECK(r.trace.header.first_contact->history.size() > 2);
  const record::Recording plain = recorded("{}");
  CHECK_FALSE(plain.trace.steps[0].result.distance.has_value());
  CHECK_FALSE(plain.trace.steps[0].result.clash.has_value());
  REQUIRE(plain.trace.header.first_contact.has_value());
  CHECK(plain.trace.header.first_contact->step == r.trace.header.first_contact->step);
  CHECK(plain.trace.header.first_contact->history.empty());
}

TEST_CASE("measured runs: frames show closest points and separation vectors with their lengths") {
  const record::Recording r = recorded(R"({"distance": true, "clash": true})"), plain = recorded("{}");
  const pictures::FrameSpec spec;
  const frames::FrameState apart = at_end(r, 0, spec), met = at_end(r, 6, spec);
  CHECK(draws_line(apart.scene().list, pictures::kGapColour));
  CHECK_FALSE(draws_line(apart.scene().list, pictures::kSeparationColour));
  CHECK(apart.caption().find("distance ") != std::string::npos);
  CHECK(draws_line(met.scene().list, pictures::kSeparationColour));
  CHECK(met.caption().find(", depth ") != std::string::npos);
  CHECK(met.caption().find("protrudes") != std::string::npos);
  CHECK_FALSE(draws_line(at_end(plain, 0, spec).scene().list, pictures::kGapColour));
  CHECK_FALSE(draws_line(at_end(plain, 6, spec).scene().list, pictures::kSeparationColour));
}

TEST_CASE("measured runs: distances of points that move with B are those of the library") {
  const test::Folder folder;
  folder.write("points.csv", "x,y,z\n0,0,0\n-1,0,0\n0,0,1\n3,3,3\n");
  const std::string file = folder / "gap.json";
  const auto record_with = [&](const std::string& query) {
    return record::record(spec::parse_scenario(balls(query), file), record::kSilent);
  };
  const record::Recording r = record_with(R"({"points": "points.csv"})");
  std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {3, 3, 3}};
  std::uint64_t inside = 0;
  for (const trace::Step& step : r.trace.steps) {
    REQUIRE(step.result.points.has_value());
    std::vector<Eigen::Vector3d> placed;
    for (const Eigen::Vector3d& x : points) placed.push_back(step.pose_b.apply(x));
    const LrbRep& a = r.bodies[0].rep;
    CHECK(*step.result.points == trace::measured(point_distances(a, step.pose_a, placed), placed, true));
    CHECK(step.result.points->smallest.size() == points.size());
    for (std::size_t i = 1; i < points.size(); ++i)
      CHECK(step.result.points->smallest[i - 1].lower <= step.result.points->smallest[i].lower);
    inside += step.result.points->inside;
  }
  CHECK(inside > 0);
  CHECK(trace::trace_from_json(trace::trace_to_json(r.trace), "t.json").steps.back().result ==
        r.trace.steps.back().result);
  const pictures::FrameSpec spec;
  const frames::FrameState last = at_end(r, r.trace.steps.size() - 1, spec);
  CHECK(last.caption().find(" of 4 points inside, smallest distance -") != std::string::npos);
  CHECK(draws_line(last.scene().list, render::palette::kContact));
  CHECK_THROWS_WITH_AS(record_with(R"({"points": "none.csv"})"), doctest::Contains("none.csv"), InputError);
}

TEST_CASE("measured runs: near pairs and contact manifolds of each step are those of the library") {
  const record::Recording r = recorded(R"({"near": 0.6, "manifold": 0.05})"), plain = recorded("{}");
  const LrbRep &a = r.bodies[0].rep, &b = r.bodies[1].rep;
  std::optional<ManifoldResult> before;
  std::size_t near_steps = 0, kept_ids = 0;
  std::set<std::uint64_t> ids;
  for (const trace::Step& step : r.trace.steps) {
    REQUIRE(step.result.near.has_value());
    REQUIRE(step.result.manifold.has_value());
    const trace::MeasuredNearPairs& near = *step.result.near;
    const NearPairsResult all = near_pairs(a, step.pose_a, b, step.pose_b, {.within = 0.6});
    CHECK(near.found == all.found);
    REQUIRE(near.nearest.size() == std::min(all.pairs.size(), trace::MeasuredNearPairs::kMaxListed));
    CHECK(near.nearest.empty() == (near.found == 0));
    for (std::size_t i = 1; i < near.nearest.size(); ++i)
      CHECK(near.nearest[i - 1].lower <= near.nearest[i].lower);
    near_steps += near.found > 0 && step.result.relation == Relation::separate;
    const trace::MeasuredManifolds& found = *step.result.manifold;
    before = contact_manifolds(a, step.pose_a, b, step.pose_b, {.margin = 0.05}, before ? &*before : nullptr);
    CHECK(found == trace::measured(*before, 0.05));
    CHECK(found.contacts.size() == found.found);
    for (const trace::MeasuredManifolds::Point& p : found.contacts) kept_ids += !ids.insert(p.id).second;
  }
  CHECK(near_steps > 0);
  CHECK(kept_ids > 0);
  CHECK_FALSE(plain.trace.steps[0].result.near.has_value());
  CHECK_FALSE(plain.trace.steps[0].result.manifold.has_value());
  const pictures::FrameSpec spec;
  const frames::FrameState met = at_end(r, 6, spec);
  CHECK(draws_line(met.scene().list, pictures::kSeparationColour));
  CHECK(met.caption().find(" pairs of faces within 0.6, ") != std::string::npos);
  CHECK(met.caption().find("contact manifold") != std::string::npos);
  CHECK(at_end(r, 0, spec).caption().find("no contact manifold") != std::string::npos);
}
