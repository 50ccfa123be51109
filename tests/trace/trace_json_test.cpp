#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <regex>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/mesh/io/encode.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using OrderedJson = nlohmann::ordered_json;
using namespace std::string_literals;
namespace fs = std::filesystem;
using runs::box;
using runs::plate;
using test::load_bytes;

namespace {

Trace ordered_box_run(Clock clock = Clock::event) {
  RecorderSettings settings;
  settings.clock = clock;
  return runs::record(box(), box(), runs::kBoxPoses, settings).trace;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("poses, counters and names are read back to the last bit") {
  RecorderSettings settings;
  settings.scenario = "quotes \" \\ / \b \f \x01 \x7f tab\t and nul\0 inside, € 😀"s;
  settings.sources[0] = "a\nb";
  Recorder recorder(plate(), plate(), settings);
  std::mt19937_64 random(7);
  std::uint32_t index = 0;
  const double special[] = {0.0,  -0.0, 5e-324, -2.2250738585072014e-308, 1.7976931348623157e308, 1.0, -3.0,
                            1e22, 0.1,  1.0 / 3};
  for (int i = 0; i < 200; ++i) {
    Pose p;
    for (int k = 0; k < 12; ++k) {
      const std::uint64_t bits = random();
      double x;
      static_assert(sizeof x == sizeof bits);
      std::memcpy(&x, &bits, sizeof x);
      if (i < 20 || !std::isfinite(x)) x = special[random() % std::size(special)];
      (k < 9 ? p.r.data()[k] : p.t.data()[k - 9]) = x;
    }
    recorder.begin_step(index++, p, p);
    CollideResult result;
    result.relation = static_cast<Relation>(i % 6);
    result.interiors_overlap = static_cast<Answer>(i % 3);
    result.counters.node_pairs = random();
    result.counters.exact_fallbacks = std::numeric_limits<std::uint64_t>::max();
    result.counters.face_tests_by_level = {0, 4294967295u, 3};
    if (i % 4 != 0) recorder.end_step(result);
  }
  const Trace t = recorder.take();
  CHECK(trace_from_json(trace_to_json(t), "t") == t);
}

TEST_CASE("files: plain, compressed, the same bytes each time, replaced whole, or not at all") {
  const test::Folder folder;
  const Trace t = ordered_box_run();
  const std::string plain = folder / "t.json", gz = folder / "t.json.gz";
  save_trace(t, plain);
  save_trace(t, gz);
  CHECK(load_trace(plain) == t);
  CHECK(load_trace(gz) == t);
  CHECK(load_bytes(plain) == trace_to_json(ordered_box_run()));
  save_trace(ordered_box_run(), folder / "again.json.gz");
  CHECK(load_bytes(folder / "again.json.gz") == load_bytes(gz));
  fs::remove(folder / "again.json.gz");
  CHECK(load_bytes(gz).substr(0, 2) == "\x1f\x8b");
  CHECK(4 * fs::file_size(gz) < fs::file_size(plain));
  CHECK(folder.tree().size() == 2);
  CHECK_THROWS_AS(save_trace(t, folder / "no/such/folder.json"), InputError);
  CHECK_THROWS_AS(save_trace(t, folder.path.string()), InputError);
  CHECK(folder.tree().size() == 2);
  if (fs::exists("/dev/full")) CHECK_THROWS_AS(save_trace(t, "/dev/full"), EnvironmentError);
}

TEST_CASE("the file satisfies the rules of Perfetto and chrome://tracing") {
  for (const Clock clock : {Clock::event, Clock::wall}) {
    const Trace t = ordered_box_run(clock);
    const OrderedJson document = OrderedJson::parse(trace_to_json(t));
    REQUIRE(document.size() == 2);
    CHECK(document.begin().key() == "traceEvents");  // lrbscope's keys come last
    CHECK_FALSE(document.contains("displayTimeUnit"));
    double last = 0;
    std::size_t recorded = 0;
    std::map<int, std::vector<double>> open;  // ends of the slices that are open on a thread
    struct Point {
      std::string phase;
      double ts;
      int tid;
    };
    std::map<std::uint64_t, std::vector<Point>> flows;
    std::map<int, std::set<double>> begins;
    std::set<std::string> counters, threads;
    for (const OrderedJson& e : document["traceEvents"]) {
      for (const char* key : {"name", "cat", "ph", "ts", "pid", "tid", "args"}) REQUIRE(e.contains(key));
      REQUIRE(e["args"].is_object());
      const double ts = e["ts"];
      REQUIRE(ts >= last);
      last = ts;
      const int tid = e["tid"];
      const std::string phase = e["ph"];
      if (phase == "X") {
        const double dur = e.at("dur");
        REQUIRE(dur > 0);
        constexpr double kHalfNanosecond = 0.0005;  // ts + dur of whole nanoseconds in microseconds, rounded
        std::vector<double>& ends = open[tid];
        while (!ends.empty() && ends.back() <= ts + kHalfNanosecond) ends.pop_back();
        if (!ends.empty()) REQUIRE(ts + dur <= ends.back() + kHalfNanosecond);
        ends.push_back(ts + dur);
        begins[tid].insert(ts);
        CHECK(e["args"]["event"] == recorded++);
      } else if (phase == "C") {
        counters.insert(e["name"]);
        for (const auto& [name, value] : e["args"].items()) CHECK(value.is_number());
      } else if (phase == "M") {
        if (e["name"] == "thread_name") threads.insert(e["args"]["name"]);
      } else {
        CHECK(e["bp"] == "e");
        flows[e["id"]].push_back({phase, ts, tid});
      }
    }
    CHECK(recorded == t.events.size());
    CHECK(counters == std::set<std::string>{"work", "wrapper"});
    CHECK(threads.size() == 5);
    REQUIRE_FALSE(flows.empty());
    for (const auto& flow : flows) {
      const std::uint64_t id = flow.first;
      const std::vector<Point>& points = flow.second;
      CAPTURE(id);
      CHECK((t.events[id].kind == EventKind::refine || t.events[id].kind == EventKind::face_test));
      REQUIRE(points.size() == 2);
      CHECK(points[0].phase == "s");
      CHECK(points[1].phase == "f");
      if (clock == Clock::event) CHECK(points[0].ts == t.events[id].cause);
      for (const Point& p : points) CHECK(begins[p.tid].count(p.ts) == 1);  // each end sits on a slice
    }
  }
}

TEST_CASE("counters show the wrappers of the step") {
  const Trace t = ordered_box_run();
  const OrderedJson document = OrderedJson::parse(trace_to_json(t));
  std::map<double, OrderedJson> wrapper;
  for (const OrderedJson& e : document["traceEvents"])
    if (e["name"] == "wrapper" && e["ph"] == "C") wrapper[e["ts"]] = e["args"];
  for (EventId i = 0; i < t.events.size(); ++i) {
    const Event& e = t.events[i];
    if (e.kind == EventKind::step) CHECK(wrapper.at(i)["faces of B"] == box().outermost_faces().size());
    if (e.kind == EventKind::refine)
      CHECK(wrapper.at(i)[e.side == Side::a ? "faces of A" : "faces of B"] == e.boundary);
  }
}

TEST_CASE("invalid files are rejected with location and reason in one line") {
  const std::string good = trace_to_json(ordered_box_run());
  const auto complaint = [](const std::string& text) {
    std::string what = test::error_of([&] { return trace_from_json(text, "t.json"); });
    CHECK(what.find('\n') == std::string::npos);
    CHECK((what.empty() || what.starts_with("t.json: ")));
    return what.empty() ? "accepted" : what;
  };
  const auto names = [&](const std::string& text, const std::string& part) {
    CHECK_MESSAGE(complaint(text).find(part) != std::string::npos, complaint(text), " should contain ", part);
  };
  names("", "line 1, column 1");
  names("{\"traceEvents\": [\n\n  tru]}", "line 3, column 6");
  names(good.substr(0, good.size() / 2), "not valid JSON");
  names("[]", "expected an object");
  names("{\"traceEvents\": []}", "/metadata/format");
  names("{\"traceEvents\": [{}]}", "/traceEvents/0/ph: expected a string, found nothing");
  names(std::string(100000, '['), "nested");
  names(replaced(good, "\"version\": 3", "\"version\": 6"), "/metadata/version: written in format 6");
  names(replaced(good, "lrbscope trace", "another trace"), "found another file format");
  RecorderSettings settings;
  settings.request.tolerance = 0.5;
  settings.request.separation = true;
  Recorder recorder(box(), box(), settings);
  recorder.begin_step(0, {}, {});
  CollideResult result;
  result.error_bound = 0.25;
  result.separation = Separation{{{{0}, {0}}}, {7, 6}};
  recorder.end_step(result);
  const std::string coarse = trace_to_json(recorder.take());
  CHECK(complaint(coarse) == "accepted");
  names(replaced(coarse, "\"tolerance\": 0.5", "\"tolerance\": -0.5"),
        "/metadata/request/tolerance: expected a number of at least 0");
  names(replaced(coarse, "\"error_bound\": 0.25", "\"error_bound\": -1"), "/result/error_bound");
  CHECK(complaint(replaced(coarse, "\"error_bound\": 0.25", "\"error_bound\": null")) == "accepted");
  names(replaced(coarse, "\"finished\": true", "\"finished\": 1"),
        "/result/finished: expected true or false");
  names(replaced(coarse, "[7, 6]", "[7]"), "/result/separation/faces: expected two numbers");
  names(replaced(coarse, "[[0], [0]]", "[[0], [1000000]]"),
        "step 0: its separation refers to a region that does not exist");
  names(replaced(good, "\"meet\":\"cross\"", "\"meet\":\"crosses\""),
        "/args/meet: expected disjoint, touch or cross");
  names(replaced(good, "\"region\":1", "\"region\":2"), "no such region");
  names(replaced(good, "\"region\":1", "\"region\":-1"), "/args/region: expected an integer from 0");
  names(replaced(good, "\"simplex of B\":", "\"simplex of B\":99999"), "B has no such simplex");
  names(replaced(good, "\"event\":7,", "\"event\":8,"), "/args/event: expected 7");
  names(replaced(good, "\"stored\": ", "\"stored\": 1"), "/metadata/events/stored");
  names(replaced(good, "\"first_event\": 0", "\"first_event\": 1"),
        "the first event does not begin the first step");
  names(replaced(good, "\"hash\": \"fedc", "\"hash\": \"FEDC"), "/metadata/scenario/hash: expected a hash");
  names(replaced(good, "\"pose_a\": [1.0, ", "\"pose_a\": ["),
        "/metadata/steps/0/pose_a: expected 12 numbers");
  names(replaced(good, "\"pose_a\": [1.0, ", "\"pose_a\": [1e999, "), "too large");
  names(replaced(good, "\"clock\": \"event\"", "\"clock\": \"wall\""), "wall clock");
  names(replaced(good, "\"dim\": 3", "\"dim\": 4"), "/metadata/bodies/0/dim: expected 2 or 3");
  names(replaced(good, "\"bodies\": [", "\"bodies\": [{}, {}, "),
        "/metadata/bodies: expected one body or two");
}

TEST_CASE("traces of older formats are read: their steps are named \"step\"") {
  const Trace t = ordered_box_run();
  std::string old = replaced(trace_to_json(t), "\"version\": 3", "\"version\": 1");
  old = std::regex_replace(old, std::regex("\"name\":\"step [^\"]*\""), "\"name\":\"step\"");
  CHECK(trace_from_json(old, "old.json") == t);
}
