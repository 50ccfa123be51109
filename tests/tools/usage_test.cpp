/// Errors of invalid command lines and of the machine's limits.

#include <algorithm>
#include <sstream>

#include <doctest/doctest.h>

#include "tests/support/program.hpp"

namespace lrb::test {
namespace {

bool says(const Outcome& o, const std::string& what) {
  return o.err.find(what) != std::string::npos;
}

TEST_CASE("usage: a misspelt command is reported with a suggestion") {
  const Folder folder;
  const auto rejected = [&](const std::vector<std::string>& arguments, const std::string& message) {
    CHECK(check_rejected(folder, arguments).err == "lrbscope: " + message + "\n");
  };
  rejected({"figre"}, "'figre' is not a command of lrbscope; did you mean \"figure\"? (see lrbscope --help)");
  rejected({"figre", "run", "--width", "85mm"},
           "'figre' is not a command of lrbscope; did you mean \"figure\"? (see lrbscope --help)");
  rejected({"xyzzyplugh"}, "'xyzzyplugh' is not a command of lrbscope (see lrbscope --help)");
  rejected({"golden", "tst"},
           "'tst' is not a command of lrbscope golden; did you mean \"test\"? (see lrbscope golden --help)");
  rejected({}, "A subcommand is required (see lrbscope --help)");
}

TEST_CASE("usage: errors name the help of their own command") {
  const Folder folder;
  for (const auto& [arguments, help] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"figure"}, "(see lrbscope figure --help)"},
           {{"figure", "figure2", "--wdth", "85mm"}, "(see lrbscope figure --help)"},
           {{"golden", "test", "--jobs", "0"}, "(see lrbscope golden test --help)"},
           {{"levels"}, "(see lrbscope levels --help)"},
           {{"--nonsense"}, "(see lrbscope --help)"}}) {
    const Outcome o = check_rejected(folder, arguments);
    CHECK(says(o, help));
  }
}

TEST_CASE("usage: an empty text is rejected by every option") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("apart.txt", kApart);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"build", "cube.obj", "-o", ""},
           {"run", "figure2", "-o", ""},
           {"collide", "cube.obj", "cube.obj", "-o", ""},
           {"figure", "cube.obj", "--output", ""},
           {"export", "cube.obj", "-o", ""},
           {"close", "cube.obj", "-o", ""},
           {"inspect", "cube.obj", "--render", "-o", ""},
           {"inspect", "cube.obj", "--draw", ""},
           {"distance", "cube.obj", "cube.obj", "--poses", "apart.txt", "--draw", ""},
           {"query", "cube.obj", "cube.obj", "--poses", ""},
           {"golden", "test", "--goldens", ".", "--junit", ""},
           {"golden", "test", "--goldens", ".", "-o", ""},
           {"levels", "cube.obj", "-o", ""},
           {"inspect", ""}}) {
    CAPTURE(arguments[0]);
    const Outcome o = check_rejected(folder, arguments);
    CHECK(says(o, ": expected a value, found an empty string; is a shell variable unset?"));
  }
}

TEST_CASE("folders are created for exports and pictures, not for bodies") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("apart.txt", kApart);
  folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const auto writes = [&](std::vector<std::string> arguments, const std::string& file) {
    CAPTURE(file);
    arguments.push_back(file);
    const Outcome o = run(folder, arguments);
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(std::filesystem::exists(folder / file));
  };
  writes({"export", "cube.obj", "-o"}, "a/b/x.ply");
  check_rejected(folder, {"build", "cube.obj", "-o", "c/d/x.lrb"});
  check_rejected(folder, {"close", "open.obj", "-o", "e/f/x.obj"});
  writes({"distance", "cube.obj", "cube.obj", "--poses", "apart.txt", "--draw"}, "g/h/x.png");
  writes({"figure", "cube.obj", "--panels", "1", "-o"}, "i/j/x.pdf");
  check_rejected(folder, {"close", "open.obj", "-o", "k/x.stl"});
}

TEST_CASE("commands accept a recorded run by its folder and by its trace") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("apart.txt", kApart);
  REQUIRE(run(folder, {"-q", "collide", "cube.obj", "cube.obj", "--poses", "apart.txt", "--frames", "none",
                       "-o", "run"})
              .code == 0);
  const auto both = [&](std::vector<std::string> before, const std::vector<std::string>& after) {
    for (const char* given : {"run", "run/trace.json"}) {
      std::vector<std::string> arguments = before;
      arguments.emplace_back(given);
      arguments.insert(arguments.end(), after.begin(), after.end());
      const Outcome o = run(folder, arguments);
      CAPTURE(o.err);
      CHECK(o.code == 0);
    }
  };
  both({"render"}, {"--most", "1", "-o", "drawn"});
  CHECK(std::filesystem::exists(folder / "drawn/frames/frame_0000.png"));
  both({"export"}, {"-o", "run.ply"});
  both({"figure"}, {"--panels", "1", "-o", "run.pdf"});
  both({"why", "--run"}, {});
  both({"compare", "run"}, {"-o", "compared"});
  CHECK(says(check_rejected(folder, {"render", ".", "-o", "none"}), "no trace.json"));
}

TEST_CASE("inspect reports picture options without --draw") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  CHECK(check_rejected(folder, {"inspect", "cube.obj", "--regions", "--up", "y"}).err ==
        "lrbscope: --up: needs --render or --draw; add one, or leave --up out\n");
}

}  // namespace
TEST_CASE("usage: help of every command fits 100 columns, and no word is lost") {
  const Folder folder;
  const auto lines_of = [](const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
  };
  const std::string root = run(folder, {"--help"}).out;
  std::vector<std::vector<std::string>> calls = {{}, {"golden", "approve"}, {"chart", "draw"}};
  bool listed = false;
  for (const std::string& line : lines_of(root)) {
    listed |= line == "Subcommands:" || line == "SUBCOMMANDS:";  // CLI11 2.3, 2.6
    if (listed && line.size() > 3 && line.starts_with("  ") && line[2] != ' ')
      calls.push_back({line.substr(2, line.find(' ', 2) - 2)});
  }
  CHECK(calls.size() > 25);
  for (std::vector<std::string> call : calls) {
    CAPTURE(call.empty() ? "" : call[0]);
    call.emplace_back("--help");
    const std::string help = run(folder, call).out;
    CHECK(help.size() > 100);
    for (const std::string& line : lines_of(help)) CHECK_MESSAGE(line.size() <= 100, line);
  }
  // A description that is continued begins in the column of descriptions.
  const std::vector<std::string> query = lines_of(run(folder, {"query", "--help"}).out);
  const auto first = std::find_if(query.begin(), query.end(), [](const std::string& line) {
    return line.find("For separate bodies, add the coarsest") == 30;
  });
  REQUIRE(first != query.end());
  CHECK(first[1].starts_with(std::string(30, ' ')));
  CHECK(first[1].ends_with("certificate of separation)"));
}

TEST_CASE("collide: a 2D approach has no z") {
  const Folder folder;
  folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nl 2 3\nl 3 4\nl 4 1\n");
  CHECK(says(check_rejected(folder, {"collide", "square.obj", "square.obj", "--approach", "1,0.2,0.5"}),
             "--approach: expected z = 0 because the bodies are 2D, found 1,0.2,0.5"));
}

}  // namespace lrb::test
