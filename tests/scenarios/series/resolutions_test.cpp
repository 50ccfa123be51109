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
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
    CAPTURE(i);
    CHECK(report.findings[i].count == 0);
  }
}

/// A ball in a ball with hardly any room between them, as shell and void: careless collapses would break
/// through.
Mesh thin_shell() {
  return shapes::several(
      {shapes::icosphere(4), shapes::turned_inside_out(shapes::scaled(shapes::icosphere(4), 0.99))});
}

}  // namespace

TEST_CASE("decimation: closed, of the same genus, free of self-intersections, at every target") {
  const std::uint32_t targets[] = {2000, 700, 200, 60};
  for (const auto& [mesh, genus, components] :
       {std::tuple{generators::generate("rock", {{"frequency", 16}}), 0, 1u},
        std::tuple{generators::generate("knot", {{"segments", 200}, {"sides", 12}}), 1, 1u},
        std::tuple{shapes::bowl(48, 24, 0.02), 0, 1u}, std::tuple{thin_shell(), 0, 2u}}) {
    const std::vector<Mesh> series = resolutions::decimate(mesh, targets);
    REQUIRE(series.size() == std::size(targets));
    for (std::size_t i = 0; i < series.size(); ++i) {
      check_embedded(series[i], genus, components);
      CHECK(series[i].face_count() <= std::max<std::size_t>(series.back().face_count(), targets[i]));
      CHECK(volume(series[i]) > 0);
    }
    CHECK(volume(series[0]) == doctest::Approx(volume(mesh)).epsilon(0.05));
  }
}

TEST_CASE("decimation: without the proof the thin shell would intersect itself") {
  // 60 faces for both balls: the inner one's corners reach further out than the outer one's faces, unless
  // collapses that would bring this about are refused.
  const std::uint32_t targets[] = {60};
  const Mesh series = resolutions::decimate(thin_shell(), targets).front();
  CHECK(series.face_count() > 200);
}

TEST_CASE("decimation: deterministic, and ends at an unreachable target") {
  const Mesh mesh = generators::generate("rock", {{"frequency", 8}});
  const std::uint32_t targets[] = {300, 2};
  const auto once = resolutions::decimate(mesh, targets), again = resolutions::decimate(mesh, targets);
  for (int i = 0; i < 2; ++i) {
    CHECK(once[i].face_vertices == again[i].face_vertices);
    CHECK(once[i].vertices == again[i].vertices);
  }
  CHECK(once[1].face_count() >= 4);
  check_embedded(once[1], 0, 1);
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

TEST_CASE("resolutions: half of the faces each time; invalid meshes are rejected") {
  const auto series =
      resolutions::resolutions(generators::generate("rock", {{"frequency", 10}}), {1, 8, 500});
  REQUIRE(series.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) CHECK(series[i].face_count() == (8000u >> i));
  CHECK(resolutions::resolutions(generators::generate("rock", {{"frequency", 10}}), {1, 2, 500}).size() == 2);
  CHECK(resolutions::resolutions(shapes::quad_box(), {}).front().face_count() == 12);
  CHECK_THROWS_AS(resolutions::resolutions(shapes::open_cylinder(12), {}), InputError);
  CHECK_THROWS_AS(resolutions::resolutions(shapes::circle(12), {}), InputError);
}

TEST_CASE("resolutions of real meshes" * doctest::test_suite("shared meshes")) {
  const auto folder = test::shared_meshes();
  for (const auto& [name, genus] : {std::pair{"rocker-arm.obj", 1}, std::pair{"fandisk.obj", 0}}) {
    const Mesh mesh = read_mesh((folder / name).string());
    for (const Mesh& m : resolutions::resolutions(mesh, {})) {
      check_embedded(m, genus, 1);
      CHECK(volume(m) == doctest::Approx(volume(mesh)).epsilon(0.02));
    }
  }
}
