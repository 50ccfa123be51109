/// `lrbscope levels`: the numbers in its pictures and on its page are those that are proved and measured.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/pixels.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/overlay.hpp>

namespace fs = std::filesystem;
using nlohmann::json;
using namespace lrb::test;

namespace {

json levels_json(const Folder& folder, const std::string& where) {
  return json::parse(slurp(folder / (where + "/levels.json")));
}

/// Returns the number behind a word of a text.
double number_after(const std::string& text, const std::string& word) {
  const auto at = text.find(word);
  return at == std::string::npos ? -1 : std::strtod(text.c_str() + at + word.size(), nullptr);
}

/// Returns the share of a picture's pixels that are neither white, grey nor nearly so.
double coloured_share(const lrb::render::Image& image) {
  const auto is_coloured = [](lrb::render::Rgba c) {
    return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}) > 60;
  };
  return static_cast<double>(count_pixels(image, {}, is_coloured)) /
         static_cast<double>(image.pixels().size());
}

}  // namespace

TEST_CASE("levels: a body that has none says why, in place of a table") {
  const Folder folder;
  folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const Outcome o = run(folder, {"--quiet", "levels", "open.obj"});
  CHECK(o.code == 0);
  CHECK(o.out == "open.obj: 3 faces\nno levels of detail, because its surface does not bound a solid\n");
  const json said = json::parse(run(folder, {"--quiet", "levels", "open.obj", "--json"}).out);
  CHECK(said["levels"].empty());
  CHECK(said["no_levels"] == "its surface does not bound a solid");
}

TEST_CASE("levels: distances in pictures and page are proven, and at least the measured ones") {
  const Folder folder;
  lrb::write_mesh(lrb::shapes::bumpy_sphere(3, 1), folder / "rock.obj");
  const Outcome o = succeed(folder, {"levels", "rock.obj", "-o", "out", "--up", "y", "--json"});
  const json said = json::parse(o.out), written = levels_json(folder, "out");
  CHECK(said["page"] == "out/index.html");
  REQUIRE(written["levels"].size() == said["levels"].size());
  const double size = written["largest_side"];
  const std::string page = slurp(folder / "out/index.html");
  double faces_before = 1e9;
  bool any_lid = false;
  for (std::size_t i = 0; i < said["levels"].size(); ++i) {
    const json& level = written["levels"][i];
    CAPTURE(level.dump());
    for (const char* key : {"share", "tolerance", "faces", "bound"})
      CHECK(level[key] == said["levels"][i][key]);
    const double bound = level["bound"], sampled = level["sampled"];
    CHECK(bound <= level["tolerance"].get<double>());
    CHECK(sampled <= bound);
    CHECK(bound <= 1.25 * sampled);  // or there are no lids, and both are 0
    CHECK(level["faces"].get<double>() <= faces_before);
    faces_before = level["faces"];
    const std::string digits = lrb::render::group_digits(level["faces"].get<std::uint64_t>());
    CHECK(level["caption"].get<std::string>().find(": " + digits + " faces") != std::string::npos);
    CHECK(page.find(">" + digits + "<") != std::string::npos);
    if (bound == 0) continue;
    any_lid = true;
    const double proved = number_after(level["caption"], "proved ");
    CHECK(proved >= bound / size);
    CHECK(proved <= 1.01 * bound / size);
  }
  CHECK(any_lid);
  // The curve goes through the levels that are shown, and further.
  CHECK(written["curve"].size() > said["levels"].size());
  for (std::size_t i = 1; i < written["curve"].size(); ++i)
    CHECK(written["curve"][i]["bound"].get<double>() > written["curve"][i - 1]["bound"].get<double>());
  const auto wrappers = lrb::render::read_png(folder / "out/wrappers.png").image,
             distances = lrb::render::read_png(folder / "out/distances.png").image;
  CHECK(coloured_share(wrappers) > 0.05);
  CHECK(coloured_share(distances) > 0.05);
  CHECK(!(wrappers == distances));
}

TEST_CASE("levels: an unconstrained simplification is shown next to the wrappers if its program was built") {
  if (!fs::exists(fs::path(LRBSCOPE_BINARY).parent_path() / "lrbscope-simplify")) return;
  const Folder folder;
  lrb::write_mesh(lrb::shapes::bumpy_sphere(3, 1), folder / "rock.obj");
  REQUIRE(run(folder, {"levels", "rock.obj", "--at", "0.02", "0.1", "-o", "out"}).code == 0);
  const json written = levels_json(folder, "out");
  REQUIRE(written["free"].size() == 2);
  const json &fine = written["free"][0], &coarse = written["free"][1];
  CHECK(fine["faces"] == written["levels"][0]["faces"]);
  CHECK(fine["faces"].get<int>() > coarse["faces"].get<int>());
  CHECK(fine["to_body"].get<double>() < coarse["to_body"].get<double>());
  // It may cut through the body, so that with as many faces it is nearer than any wrapper.
  CHECK(fine["to_body"].get<double>() < written["levels"][0]["bound"].get<double>());
}

TEST_CASE("levels: a 2D body is drawn") {
  const Folder folder;
  std::string comb = "v 0 0 0\nv 10 0 0\n";
  int corners = 2;
  for (int tooth = 9; tooth >= 0; --tooth)
    for (const auto& [x, y] : {std::pair{tooth + 0.8, 1.0}, {tooth + 0.5, 0.7}, {tooth + 0.2, 1.0}}) {
      comb += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
      ++corners;
    }
  comb += "l";
  for (int i = 1; i <= corners; ++i) comb += " " + std::to_string(i);
  folder.write("comb.obj", comb + " 1\n");
  const Outcome o = succeed(folder, {"levels", "comb.obj", "--at", "0.01", "0.2", "-o", "out"});
  const json levels = levels_json(folder, "out")["levels"];
  CHECK(levels[1]["faces"].get<int>() < levels[0]["faces"].get<int>());
  CHECK(levels[1]["sampled"].get<double>() > 0);
  CHECK(levels[1]["sampled"].get<double>() <= levels[1]["bound"].get<double>());
  CHECK(coloured_share(lrb::render::read_png(folder / "out/distances.png").image) > 0.002);
}

TEST_CASE("levels: invalid input is rejected in one line, and nothing is written") {
  const Folder folder;
  folder.write("cube.obj", kCube);
  folder.write("open.obj", "v 0.5 0.5 -1\nv 0.5 0.6 2\nv 0.6 0.5 2\nf 1 2 3\n");
  CHECK(check_rejected(folder, {"levels", "open.obj", "-o", "out"}).err.find("not closed") !=
        std::string::npos);
  CHECK(check_rejected(folder, {"levels", "cube.obj", "--at", "0", "0.1", "-o", "out"})
            .err.find("--at: found 2") != std::string::npos);
  std::vector<std::string> many = {"levels", "cube.obj", "-o", "out", "--at"};
  for (int i = 1; i <= 30; ++i) many.push_back(std::to_string(i * 0.01));
  check_rejected(folder, many);
  check_rejected(folder, {"levels", "cube.obj", "--up", "w", "-o", "out"});
}
