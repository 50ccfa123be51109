/// The SQL in trace/sql, run by SQLite on the tables that Perfetto's trace processor makes of a trace,
/// against what the summary says.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;

namespace {

/// Table slice as Perfetto's JSON importer fills it; EXTRACT_ARG finds an argument by the slice's arg_set_id.
class TraceTables {
 public:
  explicit TraceTables(const Json& trace) {
    sqlite3* opened = nullptr;
    REQUIRE(sqlite3_open(":memory:", &opened) == SQLITE_OK);
    db_.reset(opened);
    run("CREATE TABLE slice (id INTEGER, ts INTEGER, dur INTEGER, name TEXT, category TEXT, arg_set_id INTEGER)");
    sqlite3_create_function(opened, "EXTRACT_ARG", 2, SQLITE_UTF8, this, extract_arg, nullptr, nullptr);
    sqlite3_stmt* insert = nullptr;
    REQUIRE(sqlite3_prepare_v2(opened, "INSERT INTO slice VALUES (?, ?, ?, ?, ?, ?)", -1, &insert, nullptr) ==
            SQLITE_OK);
    constexpr double kNanoseconds = 1000;  // in a microsecond, the file's unit
    for (const Json& e : trace.at("traceEvents")) {
      if (e.at("ph") != "X") continue;
      const auto id = static_cast<sqlite3_int64>(args_.size());
      args_.push_back(e.at("args"));
      const std::string name = e.at("name"), category = e.at("cat");
      sqlite3_bind_int64(insert, 1, id);
      sqlite3_bind_int64(insert, 2, std::llround(kNanoseconds * e.at("ts").get<double>()));
      sqlite3_bind_int64(insert, 3, std::llround(kNanoseconds * e.at("dur").get<double>()));
      sqlite3_bind_text(insert, 4, name.c_str(), -1, SQLITE_TRANSIENT);
      sqlite3_bind_text(insert, 5, category.c_str(), -1, SQLITE_TRANSIENT);
      sqlite3_bind_int64(insert, 6, id);
      REQUIRE(sqlite3_step(insert) == SQLITE_DONE);
      sqlite3_reset(insert);
    }
    sqlite3_finalize(insert);
  }

  /// Returns the rows of a query, each a map from column to text.
  std::vector<std::map<std::string, std::string>> run(const std::string& sql) {
    std::vector<std::map<std::string, std::string>> rows;
    char* error = nullptr;
    sqlite3_exec(db_.get(), sql.c_str(), add_row, &rows, &error);
    CHECK_MESSAGE(error == nullptr, sql, ": ", error != nullptr ? error : "");
    sqlite3_free(error);
    return rows;
  }
  std::vector<std::map<std::string, std::string>> run_file(const std::string& name) {
    std::ifstream in(std::string(LRB_SOURCE_DIR "/trace/sql/") + name);
    REQUIRE(in);
    return run({std::istreambuf_iterator<char>(in), {}});
  }

 private:
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close(db); }
  };

  static void extract_arg(sqlite3_context* context, int, sqlite3_value** values) {
    const auto& self = *static_cast<const TraceTables*>(sqlite3_user_data(context));
    const Json& args = self.args_[static_cast<std::size_t>(sqlite3_value_int64(values[0]))];
    const std::string key = reinterpret_cast<const char*>(sqlite3_value_text(values[1]));
    const auto found = args.find(key.substr(std::string("args.").size()));
    if (!key.starts_with("args.") || found == args.end())
      sqlite3_result_null(context);
    else if (found->is_string())
      sqlite3_result_text(context, found->get_ref<const std::string&>().c_str(), -1, SQLITE_TRANSIENT);
    else
      sqlite3_result_int64(context, found->get<std::int64_t>());
  }
  static int add_row(void* rows, int count, char** values, char** names) {
    auto& row = static_cast<std::vector<std::map<std::string, std::string>>*>(rows)->emplace_back();
    for (int i = 0; i < count; ++i) row[names[i]] = values[i] != nullptr ? values[i] : "NULL";
    return 0;
  }

  std::unique_ptr<sqlite3, Close> db_;
  std::vector<Json> args_;
};

Trace record(Clock clock) {
  static const LrbRep rock = build_lrb(shapes::bumpy_sphere(3, 7, 0.3));
  RecorderSettings settings;
  settings.level = EventLevel::all;
  settings.clock = clock;
  Recorder recorder(rock, rock, settings);
  QueryContext context;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Pose pose = Pose::translation({2.6 - 0.5 * i, 0.1, 0.2});
    recorder.begin_step(2 * i, {}, pose);
    recorder.end_step(collide(rock, {}, rock, pose, {}, context, recorder));
  }
  return recorder.take();
}

}  // namespace

TEST_CASE("the SQL for Perfetto gives the summary's numbers") {
  for (const Clock clock : {Clock::event, Clock::wall}) {
    const Trace t = record(clock);
    const Json summary = Json::parse(summary_json(t));
    TraceTables tables(Json::parse(trace_to_json(t)));

    const auto totals = tables.run_file("totals.sql");
    REQUIRE(totals.size() == 1);
    CHECK(totals[0].size() == 10);
    for (const auto& total : totals[0])
      CHECK_MESSAGE(total.second == summary["totals"].at(total.first).dump(), total.first);

    const auto steps = tables.run_file("steps.sql");
    REQUIRE(steps.size() == t.steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Json& step = summary["steps"][i];
      CHECK(steps[i].at("time_step") == step["index"].dump());
      CHECK(steps[i].at("relation") == step["relation"].get<std::string>());
      CHECK(steps[i].at("pairs") == step["pairs"].dump());
      CHECK(steps[i].at("face_tests") == step["events"]["face_tests"].dump());
      CHECK(steps[i].at("contacts") == step["events"]["contacts"].dump());
    }

    const Json& depths = summary["histograms"][0];
    REQUIRE(depths["name"] == "tests_by_depth");
    std::size_t rows = 0;
    for (const auto& row : tables.run_file("tests_by_depth.sql")) {
      CHECK(row.at("face_tests") == depths["counts"].at(std::stoul(row.at("depth"))).dump());
      ++rows;
    }
    CHECK(rows > 1);

    std::uint64_t node_pairs = 0, box_tests = 0, decided = 0, face_tests = 0;
    for (const auto& row : tables.run_file("walk_by_depth.sql")) {
      node_pairs += std::stoull(row.at("node_pairs"));
      box_tests += std::stoull(row.at("box_tests"));
    }
    for (const auto& row : tables.run_file("decided_by.sql")) {
      CHECK(row.at("decided_by") != "NULL");
      decided += std::stoull(row.at("face_tests"));
    }
    for (const Step& s : t.steps) {
      node_pairs -= s.result.counters.node_pairs;
      box_tests -= s.result.counters.box_tests;
      face_tests += s.result.counters.face_tests;
    }
    CHECK(node_pairs == 0);
    CHECK(box_tests == 0);
    CHECK(decided == face_tests);
    CHECK(face_tests > 100);
  }
}

TEST_CASE("the SQL for Perfetto gives the passes of a construction") {
  for (const Clock clock : {Clock::event, Clock::wall}) {
    RecorderSettings settings;
    settings.clock = clock;
    ConstructRecorder recorder(settings);
    BuildOptions options;
    options.probe = &recorder;
    const LrbRep rep = build_lrb(shapes::bumpy_sphere(3, 7, 0.3), options);
    const Trace t = recorder.take(rep, {});
    const Json passes = Json::parse(summary_json(t))["construction"]["passes"];
    TraceTables tables(Json::parse(trace_to_json(t)));
    const auto rows = tables.run_file("passes.sql");
    REQUIRE(rows.size() == passes.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      CHECK(rows[i].at("stage") == passes[i]["stage"].get<std::string>());
      for (const char* number : {"patches", "accepted", "regions", "pieces_merged", "faces_after"})
        CHECK_MESSAGE(rows[i].at(number) == passes[i].at(number).dump(), number);
    }
    CHECK(tables.run_file("totals.sql")[0].at("events") == std::to_string(t.events.size()));
  }
}

TEST_CASE("every file of SQL is tested") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LRB_SOURCE_DIR "/trace/sql"))
    files += entry.path().extension() == ".sql";
  CHECK(files == 6);
}
