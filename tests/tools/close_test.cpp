/// lrbscope close, and the loops listed by inspect.

#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::test {

using namespace shapes;
using nlohmann::json;

TEST_CASE("inspect lists every loop, and close closes them") {
  const Folder folder;
  const Mesh ball = icosphere(2);
  std::set<FaceId> gone;
  for (std::uint32_t f = 0; f < ball.face_count(); f += 12) gone.insert(FaceId(f));
  write_mesh(without_faces(ball, gone), folder / "m.ply");
  const json before = json::parse(run(folder, {"inspect", "m.ply", "--json"}).out);
  std::size_t edges = 0;
  for (const json& loop : before["boundary_loops"]) {
    CHECK(loop["edges"] == loop["vertices"].size());
    CHECK(loop["is_loop"] == true);
    edges += loop["edges"].get<std::size_t>();
  }
  const std::size_t holes = before["boundary_loops"].size();
  REQUIRE(holes > 20);  // more than the text has lines for
  CHECK(before["findings"][0]["text"].get<std::string>().find("(" + std::to_string(edges) + " times)") !=
        std::string::npos);
  const Outcome text = run(folder, {"inspect", "m.ply"});
  CHECK(text.out.find("boundary: " + std::to_string(edges) + " open edges in " + std::to_string(holes) +
                      " loops, longest first:\n  0: ") != std::string::npos);
  CHECK(text.out.find("  and " + std::to_string(holes - 20) + " more: --json lists all\n") !=
        std::string::npos);

  const Outcome o = run(folder, {"close", "m.ply", "-o", "whole.ply", "--json"});
  CAPTURE(o.err);
  CHECK(o.code == 0);
  const json j = json::parse(o.out);
  CHECK(j["closed"] == holes);
  CHECK(j["holes"].size() == holes);
  CHECK(j["left"] == 0);
  CHECK(j["new_faces"] == edges - 2 * holes);
  CHECK(j["buildable"] == true);
  CHECK(run(folder, {"build", "whole.ply"}).code == 0);
  const Mesh was = read_mesh(folder / "m.ply"), is = read_mesh(folder / "whole.ply");
  CHECK(std::equal(was.face_vertices.begin(), was.face_vertices.end(), is.face_vertices.begin()));
  CHECK(is.vertices == was.vertices);
}

TEST_CASE("inspect and close distinguish a sheet from a body with a hole") {
  const Folder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\n",
                    faces = "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
  folder.write("sheet.obj", vertices + faces);
  const std::string what = "this is a sheet, which does not bound a solid";
  CHECK(run(folder, {"inspect", "sheet.obj"}).out.find("; " + what + "\n") != std::string::npos);
  CHECK(check_rejected(folder, {"close", "sheet.obj", "-o", "closed.obj"}).err.find(what) !=
        std::string::npos);
  // Beside a body with a hole, it is named and left.
  folder.write("both.obj", vertices + faces +
                               "v 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\n"
                               "f 6 8 7\nf 6 7 9\nf 6 9 8\n");
  CHECK(
      run(folder, {"inspect", "both.obj"})
          .out.find("close the hole (lrbscope close), but 1 of the 2 open components is a sheet, which does "
                    "not bound a solid") != std::string::npos);
  const Outcome o = run(folder, {"close", "both.obj", "-o", "closed.obj"});
  CHECK(o.code == 1);
  CHECK(o.out.find("1 of 2 holes closed") != std::string::npos);
  CHECK(o.out.find("not closed: its surface is a sheet, which does not bound a solid") != std::string::npos);
  // A bend of one unit in the last place is no plane any more.
  folder.write("bent.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1e-300\n" + faces);
  CHECK(run(folder, {"inspect", "bent.obj"}).out.find("close the hole") != std::string::npos);
}

TEST_CASE("close reports remaining holes with exit code 1, and rejects invalid input") {
  const Folder folder;
  Mesh pot = box();
  std::set<FaceId> top;
  for (FaceId f = 0; f < pot.face_count(); ++f) {
    bool flat = true;
    for (const VertexId v : pot.face(f)) flat &= pot.vertices[v].z() == 1;
    if (flat) top.insert(f);
  }
  write_mesh(several({without_faces(pot, top), box({0.4, 0.4, 0.1}, {0.6, 0.6, 3})}), folder / "pot.obj");
  const Outcome o = run(folder, {"close", "pot.obj", "-o", "closed.obj"});
  CHECK(o.code == 1);
  CHECK(
      o.out.starts_with("0 of 1 hole closed, 0 faces and 0 vertices added\n"
                        "  0: 4 edges, length 4, flat: not closed: the fill would intersect face "));
  CHECK(o.out.ends_with("buildable: no (lrbscope inspect lists the reasons)\n"));
  CHECK(slurp(folder / "closed.obj") == slurp(folder / "pot.obj"));

  write_mesh(circle(5), folder / "round.obj");
  check_rejected(folder, {"close", "round.obj", "-o", "x.obj"});
  check_rejected(folder, {"close", "pot.obj", "-o", "pot.obj"});
  check_rejected(folder, {"close", "pot.obj", "-o", "x.stl"});
  check_rejected(folder, {"close", "pot.obj"});
}

}  // namespace lrb::test
