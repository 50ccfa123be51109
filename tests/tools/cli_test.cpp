#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/json_lines.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>

namespace fs = std::filesystem;
using nlohmann::json;
using namespace lrb::test;

namespace {

const char* kTriangle = "v 0.5 0.5 -1\nv 0.5 0.6 2\nv 0.6 0.5 2\nf 1 2 3\n";

std::size_t files_in(const Folder& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("fingerprints: the two fixed values") {
  CHECK(lrb::fingerprint({}) == 0xcbf29ce484222325u);
  CHECK(lrb::fingerprint({{1, 2}, {3, 4}}) == 0x84c39a079fc08121u);
}

TEST_CASE("query: a JSON line per pose") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("p.txt", std::string("# apart, then overlapping, then the same\n") + kApart +
                            "1 0 0 0.5 0 1 0 0.25 0 0 1 0.125\n\n0.1 0 0 0.4 0 0.1 0 0.4 0 0 0.1 0.4\n");
  const std::vector<json> answers =
      lines_of(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt", "--pairs", "--repeat", "3"});
  REQUIRE(answers.size() == 3);
  CHECK(answers[0]["pose"] == 0);
  CHECK(answers[0]["relation"] == "separate");
  CHECK(answers[0]["pairs"] == 0);
  CHECK(answers[0]["fingerprint"] == "cbf29ce484222325");
  CHECK(answers[1]["relation"] == "crossing");
  CHECK(answers[1]["pairs"] == answers[1]["list"].size());
  CHECK(answers[1]["pairs"] > 0);
  CHECK(answers[1]["us"] > 0);
  CHECK(answers[2]["relation"] == "b_inside_a");
}

TEST_CASE("query: without --pairs and --repeat a line has four keys") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("p.txt", kApart);
  CHECK(run(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt"}).out ==
        "{\"pose\":0,\"relation\":\"separate\",\"pairs\":0,\"fingerprint\":\"cbf29ce484222325\"}\n");
}

TEST_CASE("query: touching bodies report whether they overlap, unless not all pairs were found exactly") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("p.txt", "1 0 0 0.1 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n" +
                            std::string("1 0 0 0.5 0 1 0 0.25 0 0 1 0.125\n"));
  std::istringstream lines(run(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt"}).out);
  const std::pair<const char*, const char*> expected[] = {
      {"touching", "yes"}, {"touching", "no"}, {"touching", "yes"}, {"crossing", nullptr}};
  std::string line;
  for (const auto& [relation, overlap] : expected) {
    REQUIRE(std::getline(lines, line));
    const json answer = json::parse(line);
    CAPTURE(line);
    CHECK(answer["relation"] == relation);
    if (overlap != nullptr)
      CHECK(answer["interiors_overlap"] == overlap);
    else
      CHECK_FALSE(answer.contains("interiors_overlap"));
  }
  for (const std::vector<std::string>& not_reported :
       {std::vector<std::string>{"--mode", "first"}, {"--recursion", "paper"}, {"--tolerance", "1e-9"}}) {
    std::vector<std::string> query = {"query", "a.obj", "a.obj", "--poses", "p.txt"};
    query.insert(query.end(), not_reported.begin(), not_reported.end());
    CHECK(run(folder, query).out.find("interiors_overlap") == std::string::npos);
  }
}

TEST_CASE(
    "query: a pose that moves a vertex beyond doubles is rejected by file and line, before any answer") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("p.txt", "# first\n" + std::string(kApart) + "\n1e308 1e308 0 0 0 1 0 0 0 0 1 0\n");
  const Outcome o = check_rejected(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt"});
  CHECK(o.err.starts_with("lrbscope: p.txt:4: body B, vertex "));
  // The error does not blame a pose if no pose is valid.
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3 1\n");
  CHECK(check_rejected(folder, {"query", "a.obj", "flat.obj", "--poses", "p.txt"}).err.find("p.txt") ==
        std::string::npos);
}

TEST_CASE("run: two scenario files of one name do not replace each other's run") {
  const Folder folder;
  const std::string text = R"({"name": "twin", "purpose": "p",
    "bodies": {"a": {"generator": "ball"}, "b": {"generator": "ball"}},
    "motion": {"kind": "poses", "poses": [{"position": [1.5, 0, 0]}]}, "frames": {"at": "none"}})";
  folder.write("one.json", text);
  folder.write("two.json", text);
  REQUIRE(run(folder, {"run", "one.json"}).code == 0);
  REQUIRE(run(folder, {"run", "./one.json"}).code == 0);  // again, and changed, as often as one likes
  const Outcome o = check_rejected(folder, {"run", "two.json"});
  CHECK(o.err.find("out/twin: contains the run of another scenario of this name, ") != std::string::npos);
  CHECK(o.err.find("one.json; rename one of them, or choose another folder with -o") != std::string::npos);
  CHECK(run(folder, {"run", "two.json", "-o", "elsewhere"}).code == 0);
  fs::rename(folder / "one.json", folder / "three.json");  // the other is not there any more
  CHECK(run(folder, {"run", "two.json"}).code == 0);
  CHECK(run(folder, {"run", "three.json"}).code == 2);
}

TEST_CASE("run: an open body has no wrapper to refine or construct") {
  const Folder folder;
  folder.write("open.obj", kTriangle);
  for (const char* show : {"refinement", "construction"}) {
    folder.write("s.json", std::string(R"({"name": "s", "purpose": "p", "show": ")") + show +
                               R"(", "bodies": {"a": {"file": "open.obj"}}})");
    const Outcome o = run(folder, {"--quiet", "run", "s.json"});
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.error_lines() == 1);
    CHECK(o.err.find("open.obj, is open") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "out"));
    CHECK(run(folder, {"--quiet", "golden", "approve", "s.json"}).code == 2);
    CHECK_FALSE(fs::exists(folder / "goldens"));
  }
}

TEST_CASE("query: first finds one pair; the paper's recursion is marked as incomplete") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("p.txt", "1 0 0 0.5 0 1 0 0.25 0 0 1 0.125\n");
  const json first =
      json::parse(run(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt", "--mode", "first"}).out);
  CHECK(first["pairs"] == 1);
  const json paper =
      json::parse(run(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt", "--recursion", "paper"}).out);
  CHECK(paper["recursion"] == "paper");
  CHECK(!paper.contains("predicates"));
  const json floating = json::parse(
      run(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt", "--predicates", "floating"}).out);
  CHECK(floating["predicates"] == "floating");
}

TEST_CASE("query: an open mesh is queried, without containment") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("b.obj", kTriangle);
  folder.write("p.txt",
               std::string("1 0 0 0 0 1 0 0 0 0 1 0\n0.1 0 0 0.5 0 0.1 0 0.5 0 0 0.1 0.5\n") + kApart);
  const Outcome o = run(folder, {"query", "a.obj", "b.obj", "--poses", "p.txt"});
  CHECK(o.code == 0);
  CHECK(o.err.find("will not use regions") != std::string::npos);
  CHECK(o.out.find("\"crossing\"") != std::string::npos);
  CHECK(o.out.find("\"separate\"") != std::string::npos);
  CHECK(o.out.find("\"undefined\"") != std::string::npos);
  CHECK(run(folder, {"--quiet", "query", "a.obj", "b.obj", "--poses", "p.txt"}).err.empty());
}

TEST_CASE("invalid input: one line on stderr, exit code 2, no output, no files") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("good.txt", kApart);
  folder.write("eleven.txt", std::string(kApart) + "1 0 0 3 0 1 0 0 0 0 1\n");
  folder.write("nan.txt", std::string(kApart) + "1 0 0 nan 0 1 0 0 0 0 1 0\n");
  folder.write("broken.obj", "v 0 0 0\nv 1 0 x\n");
  folder.write("empty.obj", "");
  folder.write("open.obj", kTriangle);
  folder.write("bad.json", "{\n  \"name\": \"x\",\n  \"porpose\": 1\n}");
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2 3 4 1\n");
  const std::size_t before = files_in(folder);
  const std::vector<std::vector<std::string>> bad = {
      {"query", "a.obj", "a.obj", "--poses", "eleven.txt"},
      {"query", "a.obj", "a.obj", "--poses", "nan.txt"},
      {"query", "a.obj", "a.obj", "--poses", "missing.txt"},
      {"query", "a.obj", "a.obj", "--poses", "."},
      {"query", "a.obj", "broken.obj", "--poses", "good.txt"},
      {"query", "a.obj", "missing.obj", "--poses", "good.txt"},
      {"query", "a.obj", "empty.obj", "--poses", "good.txt"},
      {"query", "a.obj", "flat.obj", "--poses", "good.txt"},
      {"query", "a.obj", "a.obj", "--poses", "good.txt", "--mode", "some"},
      {"query", "a.obj", "a.obj", "--poses", "good.txt", "--repeat", "0"},
      {"build", "broken.obj", "-o", "x.lrb"},
      {"build", "open.obj", "-o", "x.lrb"},
      {"build", "missing.obj"},
      {"inspect", "broken.obj"},
      {"run", "bad.json", "-o", "out"},
      {"run", "colision", "-o", "out"},
      {"run", "collision", "--size", "12", "-o", "out"},
      {"run", "collision", "--size", "96x64", "-o", "out"},  // too small for its texts
      {"collide", "a.obj", "broken.obj", "-o", "out"},
      {"collide", "a.obj", "flat.obj", "-o", "out"},
      {"collide", "a.obj", "a.obj", "--approach", "0,0,0", "-o", "out"},
      {"collide", "a.obj", "a.obj", "--poses", "eleven.txt", "-o", "out"},
      {"render", "missing.json"},
      {"render", "bad.json"},
      {"frobnicate"},
      {},
  };
  for (const auto& arguments : bad) {
    std::string shown;
    for (const std::string& a : arguments) shown += a + " ";
    CAPTURE(shown);
    const Outcome o = run(folder, arguments);
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK(o.error_lines() == 1);
    CHECK(files_in(folder) == before);
  }
  CHECK(run(folder, {"query", "a.obj", "a.obj", "--poses", "eleven.txt"})
            .err.find("eleven.txt:2: expected 12 numbers (a row-major 3x4 pose), found 11") !=
        std::string::npos);
  const std::pair<std::vector<std::string>, const char*> messages[] = {
      {{"query", "a.obj", "a.obj", "--tolerance", "-1"}, "--tolerance: expected at least 0, found -1 (see"},
      {{"figure", "figure1", "--font-size", "2"}, "--font-size: expected 4 to 24, found 2 (see"},
      {{"figure", "figure1", "--steps", "0,x"}, "--steps: cannot read '0,x' (see"},
      {{"query", "a.obj", "a.obj", "--pose", "x"},
       "'--pose' is not an option of lrbscope query; did you mean \"--poses\"? (see"}};
  for (const auto& [words, message] : messages)
    CHECK(run(folder, words).err.find(message) != std::string::npos);
  CHECK(run(folder, {"run", "bad.json"})
            .err.find("bad.json:3:3: /porpose: unknown key; did you mean \"purpose\"?") != std::string::npos);
}

TEST_CASE("build: the figures, the proof, and a file that replaces the mesh") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("p.txt", "1 0 0 0.5 0 1 0 0.25 0 0 1 0.125\n");
  const Outcome o = run(folder, {"build", "a.obj", "-o", "a.lrb", "--json"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  const json j = json::parse(o.out);
  for (const char* key : {"real_faces", "pseudo_faces", "total_faces", "outer_faces", "regions", "layers",
                          "volume_solid", "volume_outer", "volume_hull", "seconds", "valid"}) {
    CAPTURE(key);
    CHECK(j.contains(key));
  }
  CHECK(j["real_faces"] == 6);
  CHECK(j["valid"] == true);
  CHECK(j["volume_solid"] == doctest::Approx(1));
  CHECK(j["volume_hull"] == doctest::Approx(1));
  CHECK(j["total_faces"] == j["real_faces"].get<int>() + j["pseudo_faces"].get<int>());
  CHECK(run(folder, {"query", "a.lrb", "a.lrb", "--poses", "p.txt"}).out ==
        run(folder, {"query", "a.obj", "a.obj", "--poses", "p.txt"}).out);
  CHECK(run(folder, {"inspect", "a.lrb", "--validate"}).code == 0);
}

TEST_CASE("levels: faces and proven distances for several tolerances, the same as build --json") {
  const Folder folder;
  lrb::write_mesh(lrb::shapes::icosphere(3), (folder.path / "ball.obj").string());
  const json built = json::parse(run(folder, {"build", "ball.obj", "-o", "ball.lrb", "--json"}).out);
  const Outcome o = run(folder, {"levels", "ball.lrb", "--json"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  const json j = json::parse(o.out);
  CHECK(j["levels"] == built["levels"]);
  REQUIRE(j["levels"].size() >= 5);
  std::uint32_t last = 1280;
  for (const json& level : j["levels"]) {
    CHECK(level["bound"].get<double>() <= level["tolerance"].get<double>());
    CHECK(level["faces"].get<std::uint32_t>() <= last);
    last = level["faces"].get<std::uint32_t>();
  }
  CHECK(last < 640);
  const json coarse =
      json::parse(run(folder, {"levels", "ball.obj", "--at", "0.02", "--lean", "--json"}).out);
  REQUIRE(coarse["levels"].size() == 1);
  CHECK(coarse["levels"][0]["share"] == 0.02);
  CHECK(run(folder, {"levels", "ball.lrb"}).out.find("deviation") != std::string::npos);
  CHECK(run(folder, {"levels", "ball.lrb", "--at", "2"}).code == 2);
}

TEST_CASE("inspect: faults are findings, not errors") {
  const Folder folder;
  folder.write("open.obj", kTriangle);
  const Outcome o = run(folder, {"inspect", "open.obj", "--json"});
  REQUIRE(o.code == 0);
  const json j = json::parse(o.out);
  CHECK(j["closed"] == false);
  CHECK(j["buildable"] == false);
  CHECK(j["queryable"] == true);
  CHECK(j["findings"].size() >= 1);
}

TEST_CASE("run: page, trace, summary and frames; twice the same bytes; a mismatch ends with 1") {
  const Folder folder;
  json s = {{"name", "small"},
            {"purpose", "two balls"},
            {"bodies",
             {{"a", {{"generator", "ball"}, {"parameters", {{"frequency", 3}}}}},
              {"b", {{"generator", "ball"}, {"parameters", {{"frequency", 2}}}}}}},
            {"motion", {{"kind", "approach"}, {"from", {3, 0.1, 0.2}}, {"before", 1}, {"into", 1}}},
            {"frames", {{"size", {320, 240}}, {"montage", {{"panels", 2}}}}},
            {"expect", json::array({{{"step", 0}, {"relation", "separate"}},
                                    {{"step", 1}, {"relation", "crossing"}}})}};
  folder.write("s.json", s.dump(1));
  const Outcome first = run(folder, {"run", "s.json", "-o", "one"});
  CAPTURE(first.err);
  REQUIRE(first.code == 0);
  CHECK(first.out == "one/index.html\n");
  REQUIRE(run(folder, {"run", "s.json", "-o", "two"}).code == 0);
  for (const char* file : {"trace.json", "summary.json", "a.lrb", "b.lrb", "montage.png",
                           "frames/frame_0000.png", "frames/frame_0001.png", "frames/frame_0002.png"}) {
    CAPTURE(file);
    CHECK(fs::file_size(folder.path / "one" / file) > 0);
    CHECK(slurp(folder / ("one/" + std::string(file))) == slurp(folder / ("two/" + std::string(file))));
  }
  const lrb::render::DecodedPng png = lrb::render::read_png(folder / "one/frames/frame_0000.png");
  CHECK(png.image.width() == 320);
  CHECK(png.image.height() == 240);
  CHECK(slurp(folder / "one/index.html").find("data:image/png;base64,") != std::string::npos);

  const Outcome again = run(folder, {"render", "one/trace.json", "-o", "three", "--size", "320x240"});
  CAPTURE(again.err);
  REQUIRE(again.code == 0);  // drawn from the trace alone: the same pictures
  CHECK(lrb::render::read_png(folder / "three/frames/frame_0002.png").image ==
        lrb::render::read_png(folder / "one/frames/frame_0002.png").image);

  s["expect"][0]["relation"] = "touching";
  folder.write("s.json", s.dump(1));
  const Outcome wrong = run(folder, {"run", "s.json", "-o", "four", "--frames", "none"});
  CHECK(wrong.code == 1);
  CHECK(wrong.err.find("expected relation touching, found separate") != std::string::npos);
}

TEST_CASE("collide: two user files") {
  const Folder folder;
  folder.write("a cube.obj", kCube);
  const Outcome o = run(folder, {"collide", "a cube.obj", "a cube.obj", "-o", "out dir", "--size", "320x240",
                                 "--most", "3", "--approach", "0.3,0.2,1"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(fs::exists(folder / "out dir/index.html"));
  CHECK(fs::exists(folder / "out dir/frames/frame_0002.png"));
  const json summary = json::parse(slurp(folder / "out dir/summary.json"));
  CHECK(summary["steps"].back()["relation"] == "crossing");
}

TEST_CASE("an output folder that cannot be created is an EnvironmentError") {
  const Folder folder;
  folder.write("a.obj", kCube);
  folder.write("in_the_way", "x");
  const Outcome o = run(folder, {"collide", "a.obj", "a.obj", "-o", "in_the_way/out", "--frames", "none"});
  CHECK(o.code == 3);
  CHECK(o.error_lines() == 1);
  CHECK(o.out.empty());
}

TEST_CASE("run and render: tolerance, limit and certificates, with the answers of query") {
  const Folder folder;
  std::set<std::string> relations;
  bool pseudo = false;
  for (const json& query : {json{{"tolerance", 0.3}, {"separation", true}}, json{{"max_tests", 60}},
                            json{{"max_tests", 1}}, json{{"separation", true}}}) {
    CAPTURE(query.dump());
    const json rock = {{"generator", "rock"}, {"parameters", {{"frequency", 5}}}};
    const json s = {
        {"name", "coarse"},
        {"purpose", "two rocks"},
        {"bodies", {{"a", rock}, {"b", rock}}},
        {"motion", {{"kind", "sweep"}, {"from", {3.2, 0.1, 0.2}}, {"to", {1.2, 0, 0}}, {"steps", 6}}},
        {"query", query},
        {"frames",
         {{"size", {400, 300}}}}};  // in a smaller one a limit of one test has no room for its words
    folder.write("s.json", s.dump(1));
    const Outcome ran = run(folder, {"run", "s.json", "-o", "one"});
    CAPTURE(ran.err);
    REQUIRE(ran.code == 0);
    const json steps = json::parse(slurp(folder / "one/summary.json"))["steps"];
    const json trace = json::parse(slurp(folder / "one/trace.json"));
    std::string poses;
    for (const json& step : trace["metadata"]["steps"]) {
      for (const json& x : step["pose_b"]) poses += x.dump() + " ";
      poses += "\n";
    }
    folder.write("p.txt", poses);
    std::vector<std::string> ask = {"query", "one/a.lrb", "one/b.lrb", "--poses", "p.txt"};
    if (query.contains("tolerance")) ask.insert(ask.end(), {"--tolerance", query["tolerance"].dump()});
    if (query.contains("max_tests")) ask.insert(ask.end(), {"--max-tests", query["max_tests"].dump()});
    if (query.contains("separation")) ask.emplace_back("--separation");
    std::istringstream lines(run(folder, ask).out);
    std::size_t at = 0;
    bool proved = false;
    for (std::string line; std::getline(lines, line); ++at) {
      const json answer = json::parse(line);
      for (const char* key : {"relation", "pairs", "fingerprint", "finished", "separation"}) {
        CAPTURE(key);
        CHECK(answer.value(key, json()) == steps[at].value(key, json()));
      }
      CHECK(answer.contains("error_bound") == steps[at].contains("error_bound"));
      if (answer.contains("error_bound") && answer["error_bound"].is_number())
        CHECK(answer["error_bound"].get<double>() ==
              doctest::Approx(steps[at]["error_bound"].get<double>()).epsilon(1e-4));
      relations.insert(answer["relation"].get<std::string>());
      proved |= answer.contains("separation");
    }
    CHECK(at == steps.size());
    CHECK(fs::exists(folder / "one/separation.png") == proved);
    CHECK(proved == query.contains("separation"));
    pseudo |= slurp(folder / "one/trace.json").find("pseudo simplex of A") != std::string::npos;
    const std::string page = slurp(folder / "one/index.html");
    CHECK((page.find("Error bound") != std::string::npos) ==
          (query.contains("tolerance") || query.contains("max_tests")));
    CHECK((page.find("Proof of separation") != std::string::npos) == proved);
    REQUIRE(run(folder, {"render", "one/trace.json", "-o", "two", "--size", "400x300"}).code == 0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const std::string frame = "/frames/frame_000" + std::to_string(i) + ".png";
      CHECK(lrb::render::read_png(folder / ("two" + frame)).image ==
            lrb::render::read_png(folder / ("one" + frame)).image);
    }
    CHECK(fs::exists(folder / "two/separation.png") == proved);
  }
  CHECK(relations.contains("separate"));
  CHECK(relations.contains("unresolved"));
  CHECK(relations.contains("crossing"));
  CHECK(pseudo);
}

TEST_CASE("list, help and version go to stdout") {
  const Folder folder;
  const std::string list = run(folder, {"list"}).out;
  for (const char* line :
       {"scenarios, for lrbscope run\n", "\n  figure2 ", "crowds, for lrbscope crowd\n  crowd ",
        "experiments, for lrbscope paper --experiment\n", "\n  table1 "}) {
    CAPTURE(line);
    CHECK(list.find(line) != std::string::npos);
  }
  std::map<std::string, int> kinds;
  for (const json& item : json::parse(run(folder, {"list", "--json"}).out)) {
    CHECK(item["purpose"].get<std::string>().size() > 20);
    ++kinds[item["kind"].get<std::string>()];
  }
  CHECK(kinds["scenario"] >= 9);
  CHECK(kinds["crowd"] >= 1);
  CHECK(kinds["experiment"] >= 5);
  CHECK(json::parse(run(folder, {"list", "--generators", "--json"}).out).size() >= 8);
  CHECK(run(folder, {"--help"}).code == 0);
  CHECK(run(folder, {"query", "--help"}).out.find("--poses") != std::string::npos);
  CHECK(run(folder, {"--version"}).out.rfind("lrbscope ", 0) == 0);
}

TEST_CASE("doctor: optional programs and engines, with what needs them") {
  const Folder folder;
  setenv("LRBSCOPE_METHODS", folder.path.c_str(), 1);  // a folder without programs
  setenv("LRB_FFMPEG", "/no/such/program", 1);
  const json found = json::parse(run(folder, {"doctor", "--json"}).out);
  unsetenv("LRB_FFMPEG");
  unsetenv("LRBSCOPE_METHODS");
  std::map<std::string, json> by_name;
  for (const json& f : found["findings"]) by_name[f["what"]] = f;
  const std::pair<const char*, const char*> missing[] = {
      {"ffmpeg", "--animate"}, {"lrbscope-methods", "stability"}, {"lrbscope-xray-fcl", "xray --method fcl"}};
  for (const auto& [name, use] : missing) {
    const std::string shown = name;  // clang: no structured binding in a captured message
    CAPTURE(shown);
    CHECK(by_name[name]["level"] == "warning");
    CHECK(by_name[name]["detail"].get<std::string>().find(use) != std::string::npos);
  }
}

TEST_CASE("inspect --self-intersections: a JSON line for each pair, and exit code 1 if there is one") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("cross.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.25 0.25 -1\nv 0.25 0.25 1\nv 0.75 0.75 0\nf 1 2 3\nf 4 5 6\n");
  const Outcome found = run(folder, {"inspect", "cross.obj", "--self-intersections", "-q"});
  CHECK(found.code == 1);
  CHECK(json::parse(found.out) == json({{"faces", {0, 1}},
                                        {"kind", "cross"},
                                        {"shared", 0},
                                        {"curve", 0},
                                        {"segments", {{{0.5, 0.5, 0.0}, {0.25, 0.25, 0.0}}}}}));
  const Outcome none = run(folder, {"inspect", "cube.obj", "--self-intersections", "-q"});
  CHECK(none.code == 0);
  CHECK(none.out.empty());
  check_rejected(folder, {"inspect", "cube.obj", "--self-intersections", "--json"});
  check_rejected(folder, {"inspect", "missing.obj", "--self-intersections"});
}

TEST_CASE("--cache and LRBSCOPE_CACHE keep LRB-reps for commands that need them") {
  const Folder folder;
  lrb::write_mesh(lrb::shapes::bumpy_sphere(2, 1), folder / "rock.obj");
  std::vector<std::string> coarse = {"levels", "rock.obj"};
  const Outcome plain = run(folder, coarse);
  CHECK(plain.code == 0);
  const auto entries = [&](const std::string& name) {
    const auto all = folder.tree();
    return std::count_if(all.begin(), all.end(), [&](const std::string& f) {
      return f.starts_with(name + "/") && f.ends_with(".lrb");
    });
  };
  // Off by default, and not used by commands that need no LRB-rep.
  CHECK(run(folder, {"inspect", "rock.obj", "--cache", "kept"}).code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "kept"));
  coarse.insert(coarse.end(), {"--cache", "kept"});
  for (int i = 0; i < 2; ++i) {
    const Outcome o = run(folder, coarse);
    CHECK(o.code == 0);
    CHECK(o.out == plain.out);
    CHECK(o.err == plain.err);
    CHECK(entries("kept") == 1);
  }
  coarse.resize(coarse.size() - 2);
  const Environment variable("LRBSCOPE_CACHE", "from_environment");
  CHECK(run(folder, coarse).out == plain.out);
  CHECK(entries("from_environment") == 1);
  // One line if the folder cannot be used.
  folder.write("file", "");
  coarse.insert(coarse.end(), {"--cache", "file"});
  const Outcome o = run(folder, coarse);
  CHECK(o.code == 0);
  CHECK(o.out == plain.out);
  CHECK(o.err == plain.err +
                     "note: file: cannot create the folder (Not a directory); continuing "
                     "without the cache of LRB-reps\n");
}
