/// Files of scenarios, crowds and experiments: schema and reader agree, and errors name the place.

#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/spec/crowd_spec.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;
using nlohmann::json;

namespace {

struct Format {
  const char* schema;
  void (*parse)(const std::string& text);
  const char* good;     ///< a file to spoil
  const char* changes;  ///< [pointer, value]: valid and invalid ones
  const char* errors;   ///< [pointer, value, part of the message]

  json with(const json& change) const {
    json file = json::parse(good);
    file[json::json_pointer(change.at(0).get<std::string>())] = change.at(1);
    return file;
  }
  /// Whether an independent validator accepts a file by our schema.
  bool accepts(const json& file) const {
    return test::schema_faults(json::parse(io::embedded_file(schema)), file,
                               json::parse(io::embedded_file("scenario.schema.json")))
        .empty();
  }
  std::string error_of(const json& file) const {
    return test::error_of([&] { parse(file.dump(1)); });
  }
};

const Format kFormats[] = {
    {"scenario.schema.json",
     [](const std::string& text) { static_cast<void>(spec::parse_scenario(text, "dir/s.json")); },
     R"({"name": "n", "purpose": "p",
         "bodies": {"a": {"generator": "ball"}, "b": {"generator": "rock", "parameters": {"frequency": 3}}},
         "motion": {"kind": "approach", "from": [3, 0, 0]}})",
     R"([["/seed", 3], ["/name", "../escape"], ["/seed", -1], ["/motoin", 1], ["/show", "refinement"],
         ["/bodies/a/generator", "bal"], ["/bodies/a/file", "x.obj"], ["/bodies/b/parameters/frequency", "3"],
         ["/bodies/b", {"generator": "fractal", "build": {"patch_interior": 3}}], ["/bodies/a/pose", [1, 2, 3]],
         ["/motion/from", [1, 2]], ["/motion", {"kind": "sweep", "from": [1, 2, 3], "to": [0, 0, 0]}],
         ["/motion", {"kind": "spin"}],
         ["/motion", {"kind": "keyframes", "keyframes": [{"step": 0, "position": [0, 0, 0]}]}],
         ["/query", {"recursion": "paper", "wrapper": "unregularised"}], ["/query", {"recursion": "papr"}],
         ["/query", {"tolerance": 0.1, "max_tests": 200, "separation": true}],
         ["/query", {"separation": true, "recursion": "paper"}], ["/query", {"tolerance": -0.1}],
         ["/query", {"max_tests": 0}], ["/query", {"max_time": 1}], ["/query", {"max_pairs": 0}],
         ["/query", {"near": -1}], ["/query", {"manifold": -0.5}], ["/query", {"near": "far"}],
         ["/query", {"tolerance": 0.1, "contacts": true}], ["/query", {"tolerance": 0.1, "recursion": "paper"}],
         ["/query", {"tolerance": 0.1, "wrapper": "unregularised"}],
         ["/expect", [{"step": 3, "relation": "unresolved"}]], ["/expect", [{"step": 3, "relation": "cross"}]],
         ["/expect", [{"step": 3, "relation": "crossing", "pairs": 4, "fingerprint": "cbf29ce484222325", "max_tests": 100}]],
         ["/trace", {"clock": "wall", "gzip": true, "max_events": 10}],
         ["/frames", {"at": "refinement", "every": 3, "size": [320, 200], "montage": {"panels": 4}}],
         ["/frames", {"dpi": 300, "format": "svg", "transparent": true}], ["/frames", {"style": "dark"}],
         ["/frames", {"format": "gif"}], ["/frames", {"size": [32, 200]}], ["/frames", {"views": []}]])",
     R"([["/motion/kind", "aproach", "/motion/kind: \"aproach\": unknown word; did you mean \"approach\"?"],
         ["/bodies/a/generator", "bal", "did you mean \"ball\"?"],
         ["/bodies/b/parameters/freqency", 3, "did you mean \"frequency\"?"],
         ["/bodies/a/pose", [1, 2, 3], "expected 12 numbers, found 3"],
         ["/query", {"max_time": 2}, "/query/max_time: a time limit would make the trace differ from run to run; use max_tests instead"],
         ["/query", {"tolerance": -1}, "/query/tolerance: expected a number from 0 to "],
         ["/query", {"tolerence": 1}, "unknown key; did you mean \"tolerance\"?"],
         ["/query", {"tolerance": 1, "contacts": true}, "/query: contacts and interiors_overlap are exact"],
         ["/query", {"max_tests": 9, "recursion": "paper"}, "requires recursion"]])"},
    {"crowd.schema.json",
     [](const std::string& text) { static_cast<void>(spec::parse_crowd(text, "dir/c.json")); },
     R"({"name": "few", "purpose": "p", "room": [3, 3, 3], "arrangement": "random",
         "bodies": [{"name": "ball", "body": {"generator": "ball"}, "count": 3},
                    {"name": "bead", "body": {"generator": "ball", "parameters": {"radius": 0.1}}, "count": 4}],
         "motion": {"steps": 5, "speed": [0.05, 0.2], "spin": 7}})",
     R"([["/arrangement", "grid"], ["/arrangement", "circle"], ["/room", [3, 3, 0]], ["/room", [1, 2]], ["/room", [1, 2, -1]],
         ["/bodies", []], ["/bodies/0/count", 0], ["/bodies/0/body/generator", "bal"], ["/bodies/0/name", "a b"],
         ["/bodies/0/colour", "red"], ["/motion/steps", 0], ["/motion/speed", [1, 2, 3]], ["/motion/speed", -1],
         ["/motion/spin", [2, 9]], ["/query", {"contacts": false}], ["/query", {"mode": "some"}],
         ["/query", {"tolerance": 0.1}], ["/query", {"max_tests": 10}], ["/query", {"separation": true}],
         ["/trace", {"clock": "wall", "max_events": 10}], ["/frames", {"at": "none"}]])",
     R"([["/arrangement", "grd", "did you mean \"grid\"?"],
         ["/motion/speed", [2, 1], "/motion/speed: expected 0 <= least <= most"],
         ["/bodies/1/name", "ball", "other bodies have the name ball"],
         ["/query", {"tolerance": 0.1}, "/query/tolerance: queries of a crowd are exact"]])"},
    {"experiment.schema.json",
     [](const std::string& text) { static_cast<void>(paper::parse_experiment(text, "dir/e.json")); },
     R"({"name": "n", "purpose": "p", "protocol": {"collisions": 3},
         "objects": [{"name": "A", "body": {"generator": "fractal", "parameters": {"real_faces": 144, "total_faces": 168}}},
                     {"name": "rock", "body": {"generator": "rock", "parameters": {"frequency": 4}}}]})",
     R"([["/report", ["table2", "settings", "heat_maps"]], ["/name", "../n"], ["/protocl", 1],
         ["/protocol", {"collisions": 0}], ["/protocol", {"collisions": 2.5}], ["/protocol", {"step": 0}],
         ["/protocol", {"steps_after": -1}], ["/protocol", {"steps": 1}],
         ["/protocol", {"seed": 7, "step": 0.01, "steps_after": 0}], ["/protocol", {"seeds": 10}],
         ["/protocol", {"seeds": 0}], ["/protocol", {"seeds": 1001}], ["/report", []], ["/report", ["table3"]],
         ["/report", ["table1", "table1"]], ["/close_up", "rock"], ["/objects", []], ["/objects/0/name", "A-B"],
         ["/objects/0/name", ""], ["/objects/0/body", {"file": "x.obj"}], ["/objects/0/body", {"generator": "rok"}],
         ["/objects/0/body", {"generator": "rock", "pose": {"degrees": 3}}], ["/objects/0/pose", {}]])",
     R"([["/close_up", "rok", "did you mean \"rock\"?"], ["/objects/1/name", "A", "another object has the name A"],
         ["/objects", [{"name": "A", "body": {"generator": "rock"}}], "expected a second object"]])"}};

}  // namespace

TEST_CASE("schema and reader agree on valid and invalid files of every format") {
  for (const Format& format : kFormats) {
    int valid = 0;
    for (const json& change : json::parse(format.changes)) {
      const json file = format.with(change);
      CAPTURE(file.dump());
      CAPTURE(format.error_of(file));
      CHECK(format.accepts(file) == format.error_of(file).empty());
      valid += format.accepts(file);
    }
    CHECK(valid > 3);
  }
}

TEST_CASE("errors in files of every format name the place and the nearest known word") {
  for (const Format& format : kFormats)
    for (const json& change : json::parse(format.errors))
      CHECK(format.error_of(format.with(change)).find(change.at(2)) != std::string::npos);
}
