// Crowds: pairs culled by the broad phase are separate, the others agree with brute force, and
// the number of threads shows in times alone.
#include <atomic>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/crowd/crowd_frames.hpp"
#include "scenarios/crowd/crowd_report.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/trace_schema.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/near_pairs.hpp>

using namespace lrb;
using nlohmann::json;

namespace {

/// A dozen small bodies, close together: some cross, some lie in others.
json good() {
  return json::parse(R"({"name": "few", "purpose": "p", "seed": 3, "room": [3, 3, 3], "arrangement": "random",
    "bodies": [
      {"name": "ball", "body": {"generator": "ball", "parameters": {"frequency": 3, "radius": 1.1}}, "count": 3},
      {"name": "bead", "body": {"generator": "ball", "parameters": {"frequency": 2, "radius": 0.1}}, "count": 4},
      {"name": "bowl", "body": {"generator": "bowl", "parameters": {"segments": 10, "rows": 4}}, "count": 2},
      {"name": "stick", "body": {"generator": "stick", "parameters": {"segments": 6, "rows": 3},
                                 "pose": {"position": [0, 0, 0.4], "axis": [1, 0, 0], "degrees": 20}}, "count": 3}],
    "motion": {"steps": 5, "speed": [0.05, 0.2], "spin": 7},
    "frames": {"at": "step", "every": 4, "size": [320, 240], "supersampling": 1}})");
}

json good_2d() {
  return json::parse(R"({"name": "flat", "purpose": "p", "room": [6, 4, 0],
    "bodies": [
      {"name": "island", "body": {"generator": "island", "parameters": {"levels": 2, "radius": 0.8}}, "count": 5},
      {"name": "cog", "body": {"generator": "cog2d", "parameters": {"radius": 0.6}}, "count": 6}],
    "motion": {"steps": 4, "speed": 0.1, "spin": [2, 9]},
    "frames": {"at": "step", "every": 3, "size": [320, 240], "supersampling": 1}})");
}

spec::Crowd crowd_of(const json& j) {
  return spec::parse_crowd(j.dump(1), "dir/c.json");
}

json with(const std::string& pointer, const json& value) {
  json j = good();
  j[json::json_pointer(pointer)] = value;
  return j;
}

std::string error_of(const json& j) {
  try {
    crowd_of(j);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

bool schema_accepts(const json& j) {
  static const json document = json::parse(io::embedded_file("crowd.schema.json"));
  static const json scenario = json::parse(io::embedded_file("scenario.schema.json"));
  return test::schema_faults(document, j, scenario).empty();
}

/// As write_crowd() left them.
std::vector<bodies::LoadedBody> saved_kinds(const spec::Crowd& crowd, const std::string& folder) {
  std::vector<bodies::LoadedBody> out;
  for (const spec::CrowdKind& kind : crowd.kinds)
    out.push_back(bodies::load_body(folder + "/" + kind.name + ".lrb"));
  return out;
}

std::string trace_of(const spec::Crowd& crowd, const crowd::CrowdRun& run) {
  trace::StringSink sink;
  crowd::write_crowd_trace(crowd, run, sink);
  return sink.text;
}

void check_against_brute_force(const crowd::CrowdRun& run, std::set<Relation>& seen) {
  const std::uint32_t n = run.motion.body_count();
  for (std::uint32_t step = 0; step < run.steps.size(); ++step) {
    const std::vector<crowd::CrowdQuery>& queries = run.steps[step].queries;
    auto next = queries.begin();
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = i + 1; j < n; ++j) {
        const BruteForceResult slow =
            brute_force(run.rep(i), run.motion.pose(i, step), run.rep(j), run.motion.pose(j, step));
        const bool is_queried = next != queries.end() && next->bodies == BodyPair{i, j};
        CAPTURE(step);
        CAPTURE(i);
        CAPTURE(j);
        CHECK(slow.relation == (is_queried ? next->result.relation : Relation::separate));
        CHECK(fingerprint(slow.pairs) == (is_queried ? next->result.fingerprint : fingerprint({})));
        if (is_queried) seen.insert(slow.relation);
        next += is_queried;
      }
    CHECK(next == queries.end());  // each is_queried once, in order
  }
}

}  // namespace

TEST_CASE("all pairs of a crowd agree with brute force") {
  std::set<Relation> seen;
  const crowd::CrowdRun run = crowd::run_crowd(crowd_of(good()), 2, run::kSilent);
  check_against_brute_force(run, seen);
  CHECK(seen.contains(Relation::crossing));
  CHECK(seen.contains(Relation::b_inside_a));  // or the test shows little
  std::size_t queried = 0;
  for (const crowd::CrowdStep& s : run.steps) queried += s.queries.size();
  CHECK(queried < run.steps.size() * 12 * 11 / 2);
}

TEST_CASE("a crowd of 2D bodies") {
  std::set<Relation> seen;
  const crowd::CrowdRun run = crowd::run_crowd(crowd_of(good_2d()), 2, run::kSilent);
  check_against_brute_force(run, seen);
  CHECK(seen.contains(Relation::crossing));
}

TEST_CASE("trace, numbers and pictures do not depend on the number of threads") {
  for (const json& j : {good(), good_2d()}) {
    const spec::Crowd crowd = crowd_of(j);
    const test::Folder scratch;
    const auto& folder = scratch.path;
    std::string trace, summary;
    std::vector<std::string> frames;
    for (const std::uint32_t threads : {1U, 2U, 5U}) {
      const crowd::CrowdRun run = crowd::run_crowd(crowd, threads, run::kSilent);
      const std::string out = (folder / std::to_string(threads)).string();
      const std::string text = crowd::write_crowd(crowd, run, out, "lrbscope crowd", run::kSilent);
      std::vector<std::string> files;
      for (const char* f : {"frame_0000.png", "frame_0001.png"})
        files.push_back(io::read_text(out + "/frames/" + f));
      if (threads == 1) {
        trace = io::read_text(out + "/trace.json");
        summary = text;
        frames = files;
      }
      CHECK(io::read_text(out + "/trace.json") == trace);
      CHECK(text == summary);
      CHECK((files == frames));
      CHECK(io::read_text(out + "/index.html").find("<html") != std::string::npos);
    }
  }
}

TEST_CASE("a crowd is redrawn from its trace, pixel by pixel") {
  const test::Folder scratch;
  const auto& folder = scratch.path;
  for (const json& j : {good(), good_2d()})
    for (const trace::Clock clock : {trace::Clock::event, trace::Clock::wall}) {
      spec::Crowd crowd = crowd_of(j);
      crowd.clock = clock;
      const crowd::CrowdRun run = crowd::run_crowd(crowd, 2, run::kSilent);
      const std::string first = (folder / "run").string(), again = (folder / "again").string();
      crowd::write_crowd(crowd, run, first, "lrbscope crowd", run::kSilent);
      const std::string text = io::read_text(first + "/trace.json");
      REQUIRE(crowd::is_crowd_trace(text));
      crowd::CrowdTrace trace = crowd::read_crowd_trace(text, "t.json");
      CHECK(trace.steps == crowd.steps);
      CHECK(trace.crowd.steps == crowd.steps);
      trace.crowd.frames = crowd.frames;
      const crowd::CrowdRun replayed = crowd::replay_crowd(trace, saved_kinds(crowd, first), 1, run::kSilent);
      CHECK(replayed.notes.empty());
      CHECK(crowd::crowd_summary(trace.crowd, replayed).size() > 1000);
      for (std::uint32_t step = 0; step < crowd.steps; ++step)
        for (std::uint32_t i = 0; i < run.motion.body_count(); ++i)
          REQUIRE(trace::equal(replayed.motion.pose(i, step), run.motion.pose(i, step)));
      crowd::redraw_crowd(trace.crowd, replayed, again, "lrbscope render", first + "/trace.json",
                          run::kSilent);
      for (const char* f : {"/frames/frame_0000.png", "/frames/frame_0001.png"})
        CHECK((io::read_text(again + f) == io::read_text(first + f)));
      const std::string page = io::read_text(again + "/index.html");
      CHECK(page.find("../run/trace.json") != std::string::npos);
      CHECK(page.find("summary.json") == std::string::npos);
    }
}

TEST_CASE("truncated, damaged, old and foreign traces of crowds") {
  spec::Crowd crowd = crowd_of(good());
  crowd.frames.at = render::FrameSpec::At::none;
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, run::kSilent);
  const std::string text = trace_of(crowd, run);
  const auto kinds = [&] {
    std::vector<bodies::LoadedBody> out;
    for (const spec::CrowdKind& kind : crowd.kinds) out.push_back(run::make_body(kind.body));
    return out;
  };
  const auto error = [&](const std::string& damaged, std::vector<bodies::LoadedBody> bodies) -> std::string {
    try {
      static_cast<void>(crowd::replay_crowd(crowd::read_crowd_trace(damaged, "t.json"), std::move(bodies), 1,
                                            run::kSilent));
    } catch (const InputError& e) {
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
      return e.what();
    }
    return {};
  };
  CHECK(error(text, kinds()).empty());
  crowd.max_events = 150;
  const crowd::CrowdTrace cut = crowd::read_crowd_trace(trace_of(crowd, run), "t.json");
  CHECK(cut.steps == 5);
  CHECK(cut.crowd.steps > 0);
  CHECK(cut.crowd.steps < 5);
  const crowd::CrowdRun part = crowd::replay_crowd(cut, kinds(), 1, run::kSilent);
  CHECK(part.steps.size() == cut.crowd.steps);
  CHECK(part.notes.at(0).find(" of 5 steps (trace.max_events)") != std::string::npos);
  crowd.max_events = 3;
  CHECK(error(trace_of(crowd, run), kinds()) ==
        "t.json: contains no complete step; run the crowd again with a larger trace.max_events");

  const json whole = json::parse(text);
  const auto changed = [&](const std::string& pointer, const json& value) {
    json j = whole;
    j[json::json_pointer(pointer)] = value;
    return error(j.dump(), kinds());
  };
  std::vector<bodies::LoadedBody> swapped = kinds();
  std::swap(swapped[0], swapped[2]);
  CHECK(error(text, std::move(swapped)).find("trace: body ball: expected ") == 0);
  std::vector<bodies::LoadedBody> few = kinds();
  few.pop_back();
  CHECK(error(text, std::move(few)) == "t.json: has 4 kinds of bodies, found 3");
  CHECK(changed("/metadata/poses/2/0/3", 1.25).find("t.json: step 2, ball 1 and ") == 0);
  CHECK(changed("/metadata/version", 1).find("run the crowd again") != std::string::npos);
  CHECK(changed("/metadata/version", 3).find("written in format 3") != std::string::npos);
  CHECK(changed("/metadata/kinds/0/name", "../x").find("/metadata/kinds/0/name: ") != std::string::npos);
  CHECK(changed("/metadata/kinds/0/name", "bal").find("a query refers to ball 1, which does not exist") !=
        std::string::npos);
  CHECK(changed("/metadata/kinds/1/name", "ball").find("/metadata/kinds/1/name: ") != std::string::npos);
  CHECK(changed("/metadata/kinds/1/count", 100000).find("/metadata/kinds/1/count: ") != std::string::npos);
  CHECK(changed("/metadata/kinds/1/body/dim", 2).find("bodies of the same dimension") != std::string::npos);
  CHECK(changed("/metadata/poses/0/1", json::array({1, 2})).find("/metadata/poses/0/1: expected 12") !=
        std::string::npos);
  CHECK(changed("/metadata/poses/0/1/3", 1e300).find("/metadata/poses/0/1: ") != std::string::npos);
  CHECK(changed("/metadata/poses/0", json::array()).find("12 poses, one per body") != std::string::npos);
  CHECK(changed("/metadata/room", json::array({1, 2, -1})).find("/metadata/room/2: ") != std::string::npos);
  json other = whole;
  for (json& e : other["traceEvents"])
    if (e["args"].contains("fingerprint") && e["args"]["relation"] == "crossing")
      e["args"]["fingerprint"] = "0000000000000000";
  CHECK(error(other.dump(), kinds()).find(": expected crossing in ") != std::string::npos);
}

TEST_CASE("traces of crowds satisfy the schema of traces, on either clock; broken ones do not") {
  for (json text : {good(), good_2d()}) {
    for (const char* clock : {"event", "wall"}) {
      text["trace"] = {{"clock", clock}};
      const spec::Crowd c = crowd_of(text);
      const json trace = json::parse(trace_of(c, crowd::run_crowd(c, 2, run::kSilent)));
      CHECK(test::trace_faults(trace) == "");
      const auto broken = [&](const char* pointer, const json& value) {
        json bad = trace;
        bad[json::json_pointer(pointer)] = value;
        CAPTURE(pointer);
        CHECK(test::trace_faults(bad) != "");
      };
      broken("/metadata/clock", "sun");
      broken("/metadata/version", 3);
      broken("/metadata/colour", 1);
      broken("/metadata/kinds/0/body/dim", 4);
      broken("/metadata/poses/0/0", json::array({1, 2}));
      broken("/traceEvents/0/ph", "B");
      for (std::size_t i = 0; i < trace["traceEvents"].size(); ++i) {
        if (!trace["traceEvents"][i]["args"].contains("relation")) continue;
        const std::string event = "/traceEvents/" + std::to_string(i);
        broken((event + "/args/relation").c_str(), "near");
        broken((event + "/args/colour").c_str(), "red");
        broken((event + "/cat").c_str(), "test");
        broken((event + "/tid").c_str(), 2);
        break;
      }
    }
  }
}

TEST_CASE("slices of a track do not overlap, and contain query and answer") {
  spec::Crowd crowd = crowd_of(good());
  for (const trace::Clock clock : {trace::Clock::event, trace::Clock::wall}) {
    crowd.clock = clock;
    const crowd::CrowdRun run = crowd::run_crowd(crowd, 2, run::kSilent);
    const json trace = json::parse(trace_of(crowd, run));
    std::size_t queries = 0, slices = 0;
    for (const crowd::CrowdStep& s : run.steps) queries += s.queries.size();
    std::map<int, double> ends;
    for (const json& e : trace["traceEvents"]) {
      for (const char* key : {"name", "cat", "ph", "ts", "pid", "tid", "args"}) REQUIRE(e.contains(key));
      if (e["ph"] != "X") continue;
      const int track = e["tid"];
      CHECK(e["ts"].get<double>() >= doctest::Approx(ends[track]));
      ends[track] = e["ts"].get<double>() + e["dur"].get<double>();
      if (!e["args"].contains("relation")) continue;
      ++slices;
      CHECK(e["args"]["fingerprint"].get<std::string>().size() == 16);
    }
    CHECK(slices == queries * (clock == trace::Clock::event ? 2 : 1));
    CHECK(trace["metadata"]["query_slices"]["truncated"] == false);
  }
  crowd.max_events = 3;
  const json cut = json::parse(trace_of(crowd, crowd::run_crowd(crowd, 1, run::kSilent)));
  CHECK(cut["metadata"]["query_slices"]["truncated"] == true);
  CHECK(cut["metadata"]["query_slices"]["stored"] == 3);
}

TEST_CASE("times of a crowd have units that people read") {
  crowd::CrowdRun run{{}, {}, crowd::CrowdMotion(spec::Crowd{}, std::vector<std::vector<Pose>>{}), {}, {},
                      {}, 2};
  crowd::CrowdStep step;
  step.broad_phase_ns = 1'600'000;
  step.queries_ns = 1'150'000'000;
  run.steps.push_back(step);
  CHECK(crowd::crowd_speed(run) ==
        "a step takes (medians): broad phase 1.6 ms, queries 1.15 s, on 2 threads");
  run.steps[0].broad_phase_ns = 12'000;
  CHECK(crowd::crowd_speed(run).find("broad phase 12 us,") != std::string::npos);
}

TEST_CASE("bodies stay in the arena if they fit") {
  for (const json& j : {good(), good_2d()}) {
    spec::Crowd crowd = crowd_of(j);
    crowd.speed = {0.5, 2};
    crowd.frames.at = render::FrameSpec::At::none;
    crowd.steps = 1;
    const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, run::kSilent);
    for (std::uint32_t step = 0; step < 40; ++step)
      for (std::uint32_t i = 0; i < run.motion.body_count(); ++i)
        for (FaceId f = 0; f < run.rep(i).real_face_count(); ++f)
          for (const VertexId v : run.rep(i).face(f)) {
            const Eigen::Vector3d x = run.motion.pose(i, step).apply(run.rep(i).vertices()[v]);
            REQUIRE(((x.cwiseAbs() - crowd.room / 2).array() <= 0x1p-40).all());
          }
  }
}

TEST_CASE("the shipped crowd is valid and has about forty bodies") {
  const spec::Crowd crowd = spec::open_crowd("crowd");
  CHECK((spec::shipped_crowds() == std::vector<std::string>{"crowd"}));
  CHECK(crowd.body_count() == 40);
  CHECK(schema_accepts(json::parse(io::embedded_file("crowd.crowd.json"))));
}

TEST_CASE("schema and reader agree on valid and invalid crowds") {
  const json texts[] = {good(),
                        good_2d(),
                        with("/arrangement", "grid"),
                        with("/arrangement", "circle"),
                        with("/room", {1, 2}),
                        with("/room", {1, 2, -1}),
                        with("/bodies", json::array()),
                        with("/bodies/0/count", 0),
                        with("/bodies/0/body/generator", "bal"),
                        with("/bodies/0/name", "a b"),
                        with("/bodies/0/colour", "red"),
                        with("/motion/steps", 0),
                        with("/motion/speed", {1, 2, 3}),
                        with("/motion/speed", -1),
                        with("/query", {{"contacts", false}}),
                        with("/query/mode", "some"),
                        with("/query/tolerance", 0.1),
                        with("/query/max_tests", 10),
                        with("/query/separation", true),
                        with("/trace", {{"clock", "wall"}, {"max_events", 10}}),
                        with("/trace/gzip", true),
                        with("/frames/at", "none"),
                        with("/frames/at", "refinement"),
                        with("/frames/montage", {{"panels", 3}}),
                        with("/frames/views", json::array({{{"camera", "orbit"}, {"turn_degrees", 90}}}))};
  for (const json& j : texts) {
    CAPTURE(j.dump());
    CHECK(schema_accepts(j) == error_of(j).empty());
  }
}

TEST_CASE("bodies of a crowd follow poses from files, one for all steps or one for each") {
  const test::Folder folder;
  json moved = good_2d();
  moved["motion"] = {{"steps", 11}, {"speed", 0.1}, {"spin", 5}};
  const spec::Crowd crowd = crowd_of(moved);
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, run::kSilent);
  std::vector<Pose> all;
  std::filesystem::create_directory(folder / "steps");
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    std::vector<Pose> of_step;
    for (std::uint32_t body = 0; body < crowd.body_count(); ++body)
      of_step.push_back(run.motion.pose(body, step));
    // Without leading zeros, steps 9 and 10 would be exchanged in the order of letters.
    io::save_poses(folder / ("steps/at" + std::to_string(step) + ".csv"), of_step);
    all.insert(all.end(), of_step.begin(), of_step.end());
  }
  io::save_poses(folder / "all.txt", all);
  folder.write("steps/.hidden", "not a pose");
  json given = moved;
  given.erase("room");
  const auto parse = [&](const std::string& poses) {
    given["motion"] = {{"poses", poses}};
    CHECK(schema_accepts(given));
    return spec::parse_crowd(given.dump(1), folder / "c.json");
  };
  const auto summary_of = [](spec::Crowd c, const crowd::CrowdRun& played) {
    c.hash = 0;
    return crowd::crowd_summary(c, played);
  };
  std::uint64_t hash = 0;
  for (const char* poses : {"all.txt", "steps"}) {
    CAPTURE(poses);
    const spec::Crowd read = parse(poses);
    CHECK(read.steps == 11);
    CHECK(read.hash != hash);
    hash = read.hash;
    CHECK(summary_of(read, crowd::run_crowd(read, 2, run::kSilent)) == summary_of(crowd, run));
  }
  // A body's own pose comes first, and a part of the steps can be chosen.
  given["bodies"][0]["body"]["pose"] = {{"position", {1, 0, 0}}};
  given["motion"]["steps"] = 2;
  const spec::Crowd read = spec::parse_crowd(given.dump(1), folder / "c.json");
  CHECK(read.steps == 2);
  const crowd::CrowdRun shifted = crowd::run_crowd(read, 1, run::kSilent);
  const Pose& pose = all[crowd.body_count()];
  CHECK(shifted.motion.pose(0, 1).t == pose.r * Eigen::Vector3d(1, 0, 0) + pose.t);
  CHECK(shifted.motion.pose(10, 1).t == all[crowd.body_count() + 10].t);
  CHECK_NOTHROW(crowd::write_crowd(read, shifted, folder / "out", "lrbscope crowd", run::kSilent));

  const auto error = [&](const json& motion) -> std::string {
    given["motion"] = motion;
    try {
      static_cast<void>(spec::parse_crowd(given.dump(1), folder / "c.json"));
    } catch (const InputError& e) {
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
      return e.what();
    }
    return {};
  };
  all.pop_back();
  io::save_poses(folder / "all.txt", all);
  CHECK(error({{"poses", "all.txt"}})
            .find("all.txt: expected for each step, a pose for each of the 11 bodies, "
                  "found 120 poses") != std::string::npos);
  io::save_poses(folder / "steps/at3.csv", all);
  CHECK(error({{"poses", "steps"}}).find("at3.csv: expected a pose for each of the 11 bodies") !=
        std::string::npos);
  CHECK(error({{"poses", "none.txt"}}).find("none.txt") != std::string::npos);
  CHECK(error({{"poses", "all.txt"}, {"speed", 1}}).find("given poses; remove it") != std::string::npos);
  CHECK_FALSE(schema_accepts(given));
  std::filesystem::create_directory(folder / "empty");
  CHECK(error({{"poses", "empty"}}).find("found no file") != std::string::npos);
  given["arrangement"] = "grid";
  CHECK_FALSE(schema_accepts(given));
  given.erase("arrangement");
  given["motion"] = {{"steps", 3}};
  CHECK_FALSE(schema_accepts(given));  // neither poses nor a room
  CHECK(error(given["motion"]).find("room") != std::string::npos);
}

TEST_CASE("a crowd keeps the answers of bodies that have not moved; they equal those of new queries") {
  json start = good();
  start["motion"] = {{"steps", 9}, {"speed", 0.3}, {"spin", 20}};
  start["query"] = {{"contacts", true}, {"distance", true}};
  spec::Crowd crowd = crowd_of(start);
  const crowd::CrowdRun all = crowd::run_crowd(crowd, 1, run::kSilent);
  // At step s only bodies with a number divisible by s + 1 have moved; at step 5 none.
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    std::vector<Pose>& poses = crowd.poses.emplace_back();
    for (std::uint32_t body = 0; body < crowd.body_count(); ++body) {
      const bool moves = step == 0 || (step != 5 && body % (step + 1) == 0);
      poses.push_back(moves ? all.motion.pose(body, step) : crowd.poses[step - 1][body]);
    }
  }
  const auto play = [&](const spec::Crowd& c) {
    std::vector<bodies::LoadedBody> kinds = all.kinds;
    return crowd::play_crowd(c, std::move(kinds), crowd::CrowdMotion(c, c.poses), 2, run::kSilent);
  };
  crowd.frames.at = render::FrameSpec::At::none;
  const crowd::CrowdRun run = play(crowd);
  std::size_t kept = 0, queried = 0;
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    CAPTURE(step);
    spec::Crowd alone = crowd;
    alone.steps = 1;
    alone.poses = {crowd.poses[step]};
    const crowd::CrowdRun anew = play(alone);
    const auto &found = run.steps[step].queries, &expected = anew.steps[0].queries;
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const crowd::CrowdQuery &x = found[i], &y = expected[i];
      const auto stays = [&](std::uint32_t body) {
        return step > 0 && trace::equal(crowd.poses[step][body], crowd.poses[step - 1][body]);
      };
      CHECK(x.bodies == y.bodies);
      CHECK(x.is_kept == (stays(x.bodies.i) && stays(x.bodies.j)));
      trace::StepResult result = x.result;
      CHECK(result.counters == (x.is_kept ? Counters() : y.result.counters));
      result.counters = y.result.counters;
      CHECK(result == y.result);
      CHECK(x.contact_regions == y.contact_regions);
      CHECK(x.contact_faces == y.contact_faces);
      (x.is_kept ? kept : queried) += 1;
    }
  }
  CHECK(kept > 20);
  CHECK(queried > 20);
  CHECK(std::all_of(run.steps[5].queries.begin(), run.steps[5].queries.end(),
                    [](const crowd::CrowdQuery& q) { return q.is_kept; }));
  // Pictures do not change which answers are kept.
  crowd.frames.at = render::FrameSpec::At::step;
  CHECK(crowd::crowd_summary(crowd, play(crowd)) == crowd::crowd_summary(crowd, run));
}

TEST_CASE("two bodies of a recorded crowd are a run of their own, with the same answers") {
  for (const json& j : {good(), good_2d()}) {
    const test::Folder folder;
    const spec::Crowd crowd = crowd_of(j);
    const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, run::kSilent);
    crowd::write_crowd(crowd, run, folder / "c", "lrbscope crowd", run::kSilent);
    const std::string path = folder / "c/trace.json";
    crowd::CrowdTrace trace = crowd::read_crowd_trace(io::read_text(path), path);
    std::set<BodyPair> pairs = {{0, 1}};
    for (const crowd::CrowdQuery& q : run.steps[0].queries) pairs.insert(q.bodies);
    for (const BodyPair& pair : pairs) {
      // The names in either order.
      CHECK((crowd::find_pair(trace, run.names[pair.j] + "," + run.names[pair.i]) == pair));
      spec::Scenario scenario = crowd::scenario_of_pair(trace, pair, path);
      scenario.frames.at = render::FrameSpec::At::none;
      run::Recording recording = run::record(scenario, run::kSilent);
      CHECK_NOTHROW(crowd::check_answers(trace, pair, recording));
      REQUIRE(recording.trace.steps.size() == crowd.steps);
      CHECK(trace::equal(recording.trace.steps[1].pose_a, run.motion.pose(pair.i, 1)));
      CHECK(trace::equal(recording.trace.steps[1].pose_b, run.motion.pose(pair.j, 1)));
      recording.results.back().pairs.push_back({});
      CHECK_THROWS_AS(crowd::check_answers(trace, pair, recording), InputError);
    }
    const auto error = [&](const char* names) -> std::string {
      try {
        static_cast<void>(crowd::find_pair(trace, names));
      } catch (const InputError& e) {
        return e.what();
      }
      return {};
    };
    CHECK(error("ball 1").find("expected the names of two bodies") != std::string::npos);
    CHECK(error("").find("expected the names of two bodies") != std::string::npos);
    CHECK(error((run.names[1] + "," + run.names[1]).c_str()).find("twice") != std::string::npos);
    CHECK(error((run.names[1] + ",cat 1").c_str()).find("has no body cat 1") != std::string::npos);
  }
}

TEST_CASE("schema and reader agree on every key of a query") {
  const json scenario = json::parse(io::embedded_file("scenario.schema.json"));
  const json& keys = scenario["properties"]["query"]["properties"];
  REQUIRE(keys.size() > 10);
  for (const auto& item : keys.items()) {
    const std::string& key = item.key();
    const json& about = item.value();
    CAPTURE(key);
    json value = true;
    if (about.contains("enum"))
      value = about["enum"][0];
    else if (about.value("type", "") != "boolean")
      value = about.value("minimum", 1);
    json crowd = good();
    crowd["query"] = {{key, value}};
    CHECK(schema_accepts(crowd) == error_of(crowd).empty());
  }
  const std::string unknown = error_of(with("/query/clsh", true));
  CHECK(unknown.find("/query/clsh") != std::string::npos);
  for (const char* refused : {"tolerance", "separation", "coherent"})
    CHECK(unknown.find(refused) == std::string::npos);
  CHECK(error_of(with("/query/manifold", 0.1)).find("/query/manifold: not supported for a crowd") !=
        std::string::npos);
}

TEST_CASE("distance, clash and near pairs of a crowd are those of each pair of bodies") {
  json j = good();
  constexpr double kWithin = 0.3;
  j["query"] = {{"distance", true}, {"clash", true}, {"near", kWithin}};
  const spec::Crowd crowd = crowd_of(j);
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 2, run::kSilent);
  NearPairsRequest near;
  near.within = kWithin;
  std::size_t queried = 0, separate = 0, deep = 0, near_by = 0;
  const std::uint32_t n = run.motion.body_count();
  for (std::uint32_t step = 0; step < run.steps.size(); step += 2) {
    auto next = run.steps[step].queries.begin();
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j2 = i + 1; j2 < n; ++j2) {
        const LrbRep &a = run.rep(i), &b = run.rep(j2);
        const Pose pose_a = run.motion.pose(i, step), pose_b = run.motion.pose(j2, step);
        const auto pairs = trace::measured(near_pairs(a, pose_a, b, pose_b, near), kWithin);
        if (next == run.steps[step].queries.end() || next->bodies != BodyPair{i, j2}) {
          CHECK(pairs.pairs == 0);  // no face of the one is near one of the other
          continue;
        }
        const trace::StepResult& r = next->result;
        ++next;
        ++queried;
        REQUIRE(r.distance);
        REQUIRE(r.clash);
        REQUIRE(r.near);
        CHECK(*r.near == pairs);
        CHECK(*r.distance == trace::measured(distance(a, pose_a, b, pose_b), {}));
        CHECK(*r.clash == trace::measured(clash(a, pose_a, b, pose_b), {}));
        separate += r.distance->lower > 0;
        deep += r.clash->depth && (*r.clash->depth)[0] > 0;
        near_by += r.relation == Relation::separate && r.near->pairs > 0;
      }
    CHECK(next == run.steps[step].queries.end());
  }
  CHECK(queried > 50);
  CHECK(separate > 5);
  CHECK(deep > 5);
  CHECK(near_by > 0);

  // Trace, summary, page and the run of two bodies.
  const test::Folder folder;
  const json summary = json::parse(crowd::write_crowd(crowd, run, folder / "c", "command", run::kSilent));
  const json& first = summary["steps"][0]["queries"][0];
  CHECK(first["distance"]["upper"] == run.steps[0].queries[0].result.distance->upper);
  CHECK(first["clash"]["kind"] == std::string(name_of(run.steps[0].queries[0].result.clash->kind)));
  CHECK(first["near"]["pairs"] == run.steps[0].queries[0].result.near->pairs);
  const std::string text = io::read_text(folder / "c/trace.json");
  CHECK(test::trace_faults(json::parse(text)) == "");
  const std::string page = io::read_text(folder / "c/index.html");
  for (const char* shown :
       {"smallest distance", "largest depth", "contact kind there", "most near pairs",
        "Smallest distance of separate bodies by step", "Largest penetration depth by step"})
    CHECK(page.find(shown) != std::string::npos);
  const crowd::CrowdTrace trace = crowd::read_crowd_trace(text, "t.json");
  CHECK(trace.crowd.more.distance);
  CHECK(trace.crowd.more.clash);
  CHECK(trace.crowd.more.near == kWithin);
  const crowd::CrowdRun replayed =
      crowd::replay_crowd(trace, saved_kinds(crowd, folder / "c"), 1, run::kSilent);
  for (std::size_t step = 0; step < run.steps.size(); ++step)
    for (std::size_t q = 0; q < run.steps[step].queries.size(); ++q)
      REQUIRE(replayed.steps[step].queries[q].result == run.steps[step].queries[q].result);
  const spec::Scenario pair = crowd::scenario_of_pair(trace, {0, 1}, folder / "c/trace.json");
  CHECK(pair.more.clash);
  CHECK(pair.more.near == kWithin);

  json flat = good_2d();
  flat["query"] = {{"clash", true}};
  CHECK_THROWS_AS(static_cast<void>(crowd::run_crowd(crowd_of(flat), 1, run::kSilent)), InputError);
  flat["query"] = {{"distance", true}, {"near", 0.2}};
  CHECK_NOTHROW(static_cast<void>(crowd::run_crowd(crowd_of(flat), 1, run::kSilent)));
}

TEST_CASE("the geometry of contacts is computed only on request") {
  json crowd = good();
  crowd.erase("query");
  CHECK_FALSE(crowd_of(crowd).request.contacts);
  crowd["query"] = {{"max_pairs", 1000}};
  CHECK_FALSE(crowd_of(crowd).request.contacts);
  crowd["query"] = {{"contacts", true}};
  CHECK(crowd_of(crowd).request.contacts);
}

TEST_CASE("commands for runs of two bodies name the trace of a crowd as such") {
  const test::Folder folder;
  const spec::Crowd crowd = crowd_of(good());
  crowd::write_crowd(crowd, crowd::run_crowd(crowd, 1, run::kSilent), folder / "c", "command", run::kSilent);
  const std::string expected =
      (folder / "c/trace.json") +
      ": expected a run of one or two bodies, found the trace of a crowd; draw it with lrbscope "
      "render, or record two of its bodies with lrbscope crowd --pair";
  CHECK_THROWS_WITH_AS(static_cast<void>(run::open_run(folder / "c")), expected.c_str(), InputError);
  CHECK_THROWS_WITH_AS(static_cast<void>(run::open_step(folder / "c", 0)), expected.c_str(), InputError);
}

TEST_CASE("errors in crowds are reported with their location") {
  CHECK(error_of(with("/arrangement", "grd")).find("did you mean \"grid\"?") != std::string::npos);
  CHECK(error_of(with("/motion/speed", {2, 1})).find("/motion/speed: expected 0 <= least <= most") !=
        std::string::npos);
  CHECK(error_of(with("/bodies/1/name", "ball")).find("other bodies have the name ball") !=
        std::string::npos);
  CHECK(error_of(with("/query/tolerance", 0.1)).find("/query/tolerance: queries of a crowd are exact") !=
        std::string::npos);
  json mixed = good();
  mixed["bodies"].push_back({{"name", "flat"}, {"body", {{"generator", "island"}}}});
  CHECK_THROWS_WITH_AS(static_cast<void>(crowd::run_crowd(crowd_of(mixed), 1, run::kSilent)),
                       "crowd few: flat is 2D and ball is 3D; expected bodies of the same dimension",
                       InputError);
  CHECK_THROWS_WITH_AS(static_cast<void>(spec::open_crowd("crowds")),
                       "crowds: neither a shipped crowd nor a file; did you mean \"crowd\"? known: crowd",
                       InputError);
}
