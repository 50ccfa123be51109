// `lrbscope build MESH --json` on real models: the figures that the builder promises.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/shared_meshes.hpp"

namespace lrb::test {
namespace {

std::vector<std::string> models() {
  std::vector<std::string> names = {"spot", "homer", "fandisk", "cheburashka", "rocker-arm"};
#ifndef LRB_ADDRESS_SANITIZER  // 100,000 faces: the proof takes seconds, under the sanitizers a minute
  names.push_back("nefertiti");
#endif
  return names;
}

TEST_CASE("build --json: few outer faces, little overhead, proven" * doctest::test_suite("shared meshes")) {
  const auto meshes = shared_meshes();
  const Folder folder;
  for (const std::string& name : models()) {
    CAPTURE(name);
    const std::string file = std::filesystem::absolute(meshes / (name + ".obj")).string();
    const Outcome o = run(folder, {"build", file, "--json"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    const nlohmann::json j = nlohmann::json::parse(o.out);
    CHECK(j["valid"] == true);
    CHECK(j["outer_faces"].get<int>() <= 20);
    CHECK(j["total_faces"].get<double>() <= 2.0 * j["real_faces"].get<double>());
    CHECK(j["volume_outer"].get<double>() <= 1.4 * j["volume_hull"].get<double>());
    CHECK(j["bytes_per_real_face"].get<double>() <= 300);
  }
}

}  // namespace
}  // namespace lrb::test
