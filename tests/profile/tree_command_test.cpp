/// The command `tree`: on captures, meshes and LRB-reps; text, JSON, exit codes and pages.

#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/capture_file.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/program.hpp"
#include "tests/support/toy_engine.hpp"

namespace lrb::test {
namespace {

/// Writes toy.lrbcap with the trees of two bodies, 1 and 2; tree 2 has a fault if wanted.
void write_trees(const Folder& folder, bool faulty) {
  ToyEngine engine;
  engine.add(captured(shapes::icosphere(3), "ball"));
  const std::uint32_t second = engine.add(captured(shapes::torus(20, 10), "ring"), 1);
  if (faulty) engine.capture.trees[second].triangle[7] = engine.capture.trees[second].triangle[6];
  engine.query(0, 1, {0.5, 0, 0});
  write_capture(engine.capture, folder / "toy.lrbcap");
}

}  // namespace

TEST_CASE("tree: a capture's trees are measured, and faults decide the exit code") {
  const Folder folder;
  write_trees(folder, false);
  const Outcome sound = run(folder, {"tree", "toy.lrbcap"});
  CHECK(sound.code == 0);
  CHECK(sound.err.empty());
  CHECK(sound.out.find("tree 1 of ball (1280 triangles), Toy 1.0: AABB\n") != std::string::npos);
  CHECK(sound.out.find(
            "tree 2 of ring (400 triangles), Toy 1.0: AABB\n  nodes: 799, of which leaves 400; depth 9") !=
        std::string::npos);
  CHECK(sound.out.find("faults: none") != std::string::npos);
  write_trees(folder, true);
  const Outcome faulty = run(folder, {"tree", "toy.lrbcap"});
  CHECK(faulty.code == 1);
  CHECK(faulty.out.find("  faults: none\ntree 2") != std::string::npos);
  CHECK(faulty.out.find("is in no leaf\n") != std::string::npos);
  CHECK(run(folder, {"tree", "toy.lrbcap", "--tree", "1"}).code == 0);
  CHECK(run(folder, {"tree", "toy.lrbcap", "--tree", "2"}).code == 1);
}

TEST_CASE("tree --json: one object with the figures, and each fault by kind, node and triangle") {
  const Folder folder;
  write_trees(folder, true);
  const Outcome o = run(folder, {"tree", "toy.lrbcap", "--json", "--exact"});
  CHECK(o.code == 1);
  const nlohmann::json j = nlohmann::json::parse(o.out);
  CHECK(j["kind"] == "capture");
  CHECK(j["engine"] == "Toy 1.0");
  REQUIRE(j["trees"].size() == 2);
  const nlohmann::json& tree = j["trees"][1];
  CHECK(tree["tree"] == 2);
  CHECK(tree["nodes"] == 799);
  CHECK(tree["leaf_sizes"] == nlohmann::json::parse(R"([{"triangles": 1, "leaves": 400}])"));
  CHECK(tree["epo"]["exact"] == true);
  CHECK(tree["epo"]["value"] > 0);
  CHECK(tree["worst_by_epo"].size() == 10);
  CHECK(tree["faults"]["total"] == j["faults"]);
  CHECK(tree["faults"]["by_kind"]["triangle_in_two_leaves"] == 1);
  CHECK(tree["faults"]["by_kind"]["triangle_in_no_leaf"] == 1);
  CHECK(tree["faults"]["by_kind"]["two_parents"] == 0);
  bool found = false;
  for (const nlohmann::json& fault : tree["faults"]["list"])
    if (fault["kind"] == "triangle_in_two_leaves")
      found = fault["leaves"].size() == 2 && fault.contains("triangle");
  CHECK(found);
}

TEST_CASE("tree: of a mesh and of an LRB-rep, lrbscope's own tree") {
  const Folder folder;
  write_mesh(shapes::torus(30, 16), folder / "ring.obj");
  REQUIRE(run(folder, {"--quiet", "build", "ring.obj", "-o", "ring.lrb"}).code == 0);
  for (const char* file : {"ring.obj", "ring.lrb"}) {
    const Outcome o = run(folder, {"tree", file});
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.out.find("(960 triangles), lrbscope: OBB") != std::string::npos);
    CHECK(o.out.find("faults: none") != std::string::npos);
  }
}

TEST_CASE("tree: invalid input is rejected in one line") {
  const Folder folder;
  write_trees(folder, false);
  ToyEngine none;
  write_capture(none.capture, folder / "none.lrbcap");
  CHECK(check_rejected(folder, {"tree", "none.lrbcap"}).err.find("expected trees, found none") !=
        std::string::npos);
  CHECK(check_rejected(folder, {"tree", "toy.lrbcap", "--tree", "7"})
            .err.find("--tree: expected a tree of toy.lrbcap (1, 2), found 7") != std::string::npos);
  CHECK(check_rejected(folder, {"tree", "absent.obj"}).err.find("absent.obj") != std::string::npos);
}

TEST_CASE("tree -o: a page for each tree, with the nodes, the worst ones and the faults") {
  const Folder folder;
  write_trees(folder, true);
  const Outcome one = run(folder, {"--quiet", "tree", "toy.lrbcap", "--tree", "2", "-o", "page"});
  CAPTURE(one.err);
  CHECK(one.code == 1);
  const std::string page = slurp(folder / "page/index.html");
  for (const char* part :
       {"Tree of ring", "Worst nodes by EPO", "Nodes by depth", "is in no leaf", "triangle in two leaves"})
    CHECK_MESSAGE(page.find(part) != std::string::npos, part);
  const std::string icicle = slurp(folder / "page/nodes.svg");
  CHECK(icicle.find("<title>node 0, depth 0: 400 triangles") != std::string::npos);
  const Outcome all = run(folder, {"--quiet", "tree", "toy.lrbcap", "-o", "pages"});
  CHECK(all.code == 1);
  CHECK(slurp(folder / "pages/index.html").find("tree_2/index.html") != std::string::npos);
  CHECK(slurp(folder / "pages/tree_1/index.html").find("no faults") != std::string::npos);
}

}  // namespace lrb::test
