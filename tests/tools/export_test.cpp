// lrbscope export: files and errors.
#include <string>

#include <doctest/doctest.h>

#include "scenarios/io/poses.hpp"
#include "tests/support/command.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {
namespace {

TEST_CASE("export: a body, its wrapper, and a run by folder, trace and scenario") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  CHECK(run(folder, {"-q", "export", "cube.obj", "-o", "cube.ply"}).code == 0);
  CHECK(read_mesh(folder / "cube.ply").face_count() == 6);
  CHECK(run(folder, {"-q", "export", "cube.obj", "--layer", "0", "-o", "real.ply"}).code == 0);
  CHECK(read_mesh(folder / "real.ply").face_count() == 6);

  REQUIRE(run(folder, {"-q", "run", "stick_through_wall", "-o", "r"}).code == 0);
  for (const char* input : {"r", "r/trace.json", "stick_through_wall"}) {
    CAPTURE(input);
    const Outcome o = run(folder, {"export", input, "-o", "r.vtp"});
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.out == "r.vtp\n");
    std::filesystem::rename(folder / "r.vtp", folder / (input[0] == 's' ? "scenario.vtp" : "trace.vtp"));
  }
  CHECK(slurp(folder / "scenario.vtp") == slurp(folder / "trace.vtp"));
  CHECK(
      run(folder, {"-q", "export", "r", "--event", "0", "--what", "wrapper", "--of", "a", "-o", "first.ply"})
          .code == 0);
  CHECK(run(folder, {"-q", "export", "r", "--what", "body", "--of", "a", "-o", "a.ply"}).code == 0);
  CHECK(read_mesh(folder / "first.ply").face_count() < read_mesh(folder / "a.ply").face_count());
}

TEST_CASE("export: poses of a run, and from one form to another") {
  const Folder folder;
  REQUIRE(run(folder, {"-q", "export", "stick_through_wall", "--what", "poses", "-o", "p.csv"}).code == 0);
  for (const char* name : {"p.json", "p.txt", "again.csv"})
    REQUIRE(run(folder, {"-q", "export", name == std::string("p.json") ? "p.csv" : "p.json", "--what",
                         "poses", "-o", name})
                .code == 0);
  CHECK(slurp(folder / "p.csv") == slurp(folder / "again.csv"));
  folder.write("cube.obj", kCube);
  const Outcome text = run(folder, {"-q", "query", "cube.obj", "cube.obj", "--poses", "p.txt"});
  CHECK(text.code == 0);
  CHECK(!text.out.empty());
  for (const char* name : {"p.csv", "p.json"}) {
    const Outcome o = run(folder, {"-q", "query", "cube.obj", "cube.obj", "--poses", name});
    CHECK(o.code == 0);
    CHECK(o.out == text.out);
  }
}

TEST_CASE("export: invalid requests are rejected, and nothing is written") {
  const Command command({"-q", "export"});
  command.folder.write("p.csv", "1,2\n");
  command.check_refusals(
      {{{"cube.obj", "-o", "cube.3ds"}, "expected a name that ends in .ply, .vtp or .glb"},
       {{"cube.obj", "-o", "cube.stl"}, "expected a name that ends in .ply, .vtp or .glb"},
       {{"cube.obj", "-o", "c.ply", "--step", "1"}, "--step: needs a run"},
       {{"cube.obj", "-o", "c.ply", "--what", "contacts"}, "--what contacts: needs a run"},
       {{"cube.obj", "-o", "c.ply", "--colour-by", "hits"}, "the other quantities need a run"},
       {{"cube.obj", "-o", "c.ply", "--faces", "2"}, "the outermost wrapper has"},
       {{"cube.obj", "-o", "c.ply", "--what", "boddy"}, "boddy"},
       {{"no_such_thing", "-o", "c.ply"}, "no_such_thing"},
       {{"islands", "-o", "c.ply", "--step", "999"}, "no such step in the trace"},
       {{"islands", "-o", "c.ply", "--event", "99999999"}, "events, numbered from 0"},
       {{"islands", "-o", "c.ply", "--faces", "50"}, "need a body file"},
       {{"p.csv", "-o", "p.json", "--what", "poses"}, "p.csv:1: expected 12 numbers"}});
}

}  // namespace
}  // namespace lrb::test
