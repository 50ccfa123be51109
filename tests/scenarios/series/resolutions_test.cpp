// A body at several resolutions: what comes out is checked by the mesh checker, exactly.

#include "scenarios/bodies/resolutions.hpp"

#include <doctest/doctest.h>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

using namespace lrb;

namespace {

using test::volume;

void check_embedded(const Mesh& mesh, int genus, std::uint32_t components) {
  CAPTURE(mesh.name);
  CAPTURE(mesh.face_count());
  const MeshReport report = check_mesh(mesh);
  CHECK(report.closed);
  CHECK(report.genus == genus);
  CHECK(report.components == components);
  CHECK(report.buildable());
  CHECK(report[MeshFault::self_intersection].count == 0);
}

}  // namespace

TEST_CASE("resolutions: wrappers of about half of the faces each, closed, embedded, around the body") {
  for (const auto& [mesh, genus] :
       {std::pair{generators::generate("rock", {{"frequency", 16}}), 0},
        std::pair{generators::generate("knot", {{"segments", 200}, {"sides", 12}}), 1},
        std::pair{shapes::bowl(48, 24, 0.02), 0}}) {
    const std::vector<Mesh> series = resolutions::resolutions(mesh, {0, 4, 200});
    REQUIRE(series.size() == 4);
    for (std::size_t i = 0; i < series.size(); ++i) {
      check_embedded(series[i], genus, 1);
      CHECK(series[i].face_count() <= series[0].face_count() >> i);
      CHECK(series[i].face_count() >= 0.8 * static_cast<double>(series[0].face_count() >> i));
      CHECK(volume(series[i]) >= volume(mesh));
    }
    CHECK(volume(series[1]) == doctest::Approx(volume(mesh)).epsilon(0.05));
  }
}

TEST_CASE("subdivision: four faces for one, smoother, still closed") {
  const Mesh coarse = shapes::icosphere(1), fine = resolutions::subdivide(coarse),
             finer = resolutions::subdivide(fine);
  CHECK(fine.face_count() == 4 * coarse.face_count());
  CHECK(finer.vertices.size() == 2 + finer.face_count() / 2);  // Euler
  check_embedded(finer, 0, 1);
  double least = 10, most = 0;
  for (const auto& v : finer.vertices) least = std::min(least, v.norm()), most = std::max(most, v.norm());
  CHECK(most - least < 0.02);
  check_embedded(resolutions::subdivide(generators::generate("knot", {{"segments", 60}, {"sides", 6}})), 1,
                 1);
}

TEST_CASE("resolutions: subdivided, limited, of polygons and around voids; invalid meshes are rejected") {
  const Mesh rock = generators::generate("rock", {{"frequency", 10}});
  CHECK(resolutions::resolutions(rock, {1, 8, 500}).front().face_count() == 8000);
  CHECK(resolutions::resolutions(rock, {0, 2, 500}).size() == 2);
  CHECK(resolutions::resolutions(shapes::quad_box(), {}).front().face_count() == 12);
  const Mesh shell =
      shapes::several({shapes::icosphere(3), shapes::turned_inside_out(shapes::icosphere(2, 0.6))});
  for (const Mesh& m : resolutions::resolutions(shell, {0, 8, 200})) check_embedded(m, 0, 2);
  CHECK_THROWS_AS(resolutions::resolutions(shapes::open_cylinder(12), {}), InputError);
  CHECK_THROWS_AS(resolutions::resolutions(shapes::circle(12), {}), InputError);
}

TEST_CASE("resolutions of real meshes" * doctest::test_suite("shared meshes")) {
  const auto folder = test::shared_meshes();
  for (const auto& [name, genus] : {std::pair{"rocker-arm.obj", 1}, std::pair{"fandisk.obj", 0}}) {
    const Mesh mesh = read_mesh((folder / name).string());
    for (const Mesh& m : resolutions::resolutions(mesh, {})) {
      check_embedded(m, genus, 1);
      CHECK(volume(m) == doctest::Approx(volume(mesh)).epsilon(0.05));
    }
  }
}
