#include "scenarios/bodies/generators.hpp"

#include <doctest/doctest.h>

#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

using namespace lrb;

namespace {

void check_clean(const Mesh& mesh) {
  const MeshReport report = check_mesh(mesh);
  CAPTURE(mesh.name);
  for (const std::string& line : report.lines(mesh)) CAPTURE(line);
  CHECK(report.closed);
  CHECK(report.components == 1);
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
    CAPTURE(i);
    CHECK(report.findings[i].count == 0);
  }
}

}  // namespace

TEST_CASE("every generator makes a closed, clean body that faces outward, whatever the seed") {
  for (const generators::Generator& g : generators::generators())
    for (std::uint64_t seed = 1; seed <= 4; ++seed) check_clean(generators::generate(g.name, {}, seed));
}

TEST_CASE("generated bodies are clean without the fallbacks") {
  check_clean(generators::generate("rock", {{"frequency", 7}, {"bumps", 0.5}, {"craters", 40}}, 5));
  check_clean(
      generators::generate("knot", {{"p", 3}, {"q", 2}, {"tube", 0.1}, {"segments", 90}, {"sides", 5}}));
  check_clean(generators::generate("gear", {{"teeth", 5}, {"rings", 1}, {"points", 4}, {"bore", 0.6}}));
  check_clean(generators::generate("stick", {{"length", 9}, {"segments", 7}, {"rows", 1}}));
  check_clean(generators::generate("pot", {{"mouth", 0.05}, {"rows", 1}, {"segments", 9}}));
  check_clean(generators::generate("bowl", {{"wall", 0.5}, {"rows", 2}, {"segments", 6}}));
  for (double levels = 0; levels <= 4; ++levels)
    check_clean(generators::generate("island", {{"levels", levels}, {"depth", 0.32}}, 9));
}

TEST_CASE("unknown names and values out of range are rejected") {
  CHECK_THROWS_WITH_AS(generators::generate("rok"), doctest::Contains("did you mean \"rock\"?"), InputError);
  CHECK_THROWS_WITH_AS(generators::generate("rock", {{"bump", 1}}),
                       doctest::Contains("did you mean \"bumps\"?"), InputError);
  CHECK_THROWS_AS(generators::generate("rock", {{"frequency", 1e9}}), InputError);
  CHECK_THROWS_AS(generators::generate("rock", {{"frequency", 2.5}}), InputError);
}
