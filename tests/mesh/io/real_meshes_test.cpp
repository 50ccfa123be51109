#include <doctest/doctest.h>

#include "tests/support/shared_meshes.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::test {

TEST_CASE("real meshes are closed, manifold and clean" * doctest::test_suite("shared meshes")) {
  const auto directory = shared_meshes();
  struct Expected {
    const char* name;
    std::size_t vertices, faces;
    int genus;
  };
  for (const auto& [name, vertices, faces, genus] :
       {Expected{"cheburashka.obj", 6669, 13334, 0}, Expected{"fandisk.obj", 6475, 12946, 0},
        Expected{"homer.obj", 6002, 12000, 0}, Expected{"nefertiti.obj", 49971, 99938, 0},
        Expected{"rocker-arm.obj", 10044, 20088, 1}, Expected{"spot.obj", 2930, 5856, 0}}) {
    const std::string file = name;
    CAPTURE(file);
    Mesh mesh = read_mesh((directory / file).string());
    CHECK(mesh.vertices.size() == vertices);
    CHECK(mesh.face_count() == faces);
    const MeshReport report = check_mesh(mesh);
    CHECK(report.lines(mesh).empty());
    CHECK(report.closed);
    CHECK(report.components == 1);
    CHECK(report.genus == genus);
    CHECK(orient_outward(mesh) == 0);
  }
}

}  // namespace lrb::test
