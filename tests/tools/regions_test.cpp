/// Which regions are bad, and what helps: inspect --regions, what build warns of, render --region and
/// --layer.

#include <numeric>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "render/pictures/body_picture.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/pixels.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {

using namespace shapes;
using nlohmann::json;
namespace {

using bodies::RegionFigures;
using bodies::RegionOrder;

/// A disc so thin that the outermost wrapper, which keeps its distance, is far larger.
Mesh thin_disc() {
  Mesh m = icosphere(3);
  for (Point3& x : m.vertices) x.z() *= 0.004;
  return m;
}

const char* const kThinGear = R"({"name": "thin", "purpose": "y", "show": "refinement",
    "bodies": {"a": {"generator": "gear", "parameters": {"thickness": 0.02}}}, "frames": {"at": "none"}})";

json run_json(const Folder& folder, std::vector<std::string> words) {
  words.emplace_back("--json");
  return json::parse(succeed(folder, words).out);
}

}  // namespace

TEST_CASE("figures of regions add up to the body's") {
  for (const Mesh& mesh : {bowl(24, 8), comb(4), gear(12)}) {
    const LrbRep rep = build_lrb(mesh);
    std::vector<FaceId> real(rep.real_face_count());
    std::iota(real.begin(), real.end(), FaceId{0});
    const double outer = enclosed_volume(rep, rep.outermost_faces());
    const std::vector<double> thickness = region_thickness(rep);
    for (const RegionOrder order :
         {RegionOrder::waste, RegionOrder::thickness, RegionOrder::volume, RegionOrder::lids}) {
      const std::vector<RegionFigures> regions = bodies::region_figures(rep, order, 1);
      REQUIRE(regions.size() == rep.region_count());
      double volume = 0;
      std::set<RegionId> seen;
      for (std::size_t i = 0; i < regions.size(); ++i) {
        const RegionFigures& r = regions[i];
        seen.insert(r.region);
        volume += r.volume;
        CHECK(r.lids == rep.lids(r.region).size());
        CHECK(r.thickness == thickness[r.region]);
        CHECK(r.parent == rep.parent(r.region));
        CHECK(r.waste == doctest::Approx(r.floor * r.volume / outer));
        if (i == 0) continue;
        const RegionFigures& before = regions[i - 1];
        if (order == RegionOrder::waste) CHECK(before.waste >= r.waste);
        if (order == RegionOrder::thickness) CHECK(before.thickness >= r.thickness);
        if (order == RegionOrder::volume) CHECK(before.volume >= r.volume);
        if (order == RegionOrder::lids) CHECK(before.lids >= r.lids);
      }
      CHECK(seen.size() == regions.size());
      CHECK(volume == doctest::Approx(outer - enclosed_volume(rep, real)));
      const std::vector<double> shares = bodies::waste_over_faces(rep, regions);
      std::set<RegionId> above;  // some real face, along parents
      for (const FaceId f : real)
        for (CellId c = rep.outer_cell(f); is_region(c); c = rep.parent(c.as_region()))
          above.insert(c.as_region());
      double beneath = 0;
      for (const RegionFigures& r : regions)
        if (above.contains(r.region)) beneath += r.waste;
      CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == doctest::Approx(beneath));
      CHECK(beneath <= doctest::Approx(bodies::total_waste(regions)));
      CHECK(beneath > 0.9 * bodies::total_waste(regions));
    }
  }
}

TEST_CASE("inspect --regions lists all in JSON, the worst in text, and draws ten") {
  const Folder folder;
  write_mesh(bowl(40, 20), folder / "bowl.obj");
  REQUIRE(run(folder, {"build", "bowl.obj", "-o", "bowl.lrb"}).code == 0);
  const json j = run_json(folder, {"inspect", "bowl.lrb", "--regions", "--sort", "lids"});
  REQUIRE(j["region_figures"].size() == j["regions"]);
  CHECK(j["regions"] > 25);
  double waste = 0;
  for (const json& r : j["region_figures"]) waste += r["waste"].get<double>();
  CHECK(waste == doctest::Approx(j["total_waste"].get<double>()));
  CHECK(j["region_figures"].front()["lids"] >= j["region_figures"].back()["lids"]);
  // A mesh is built first, and has the same regions.
  CHECK(run_json(folder, {"inspect", "bowl.obj", "--regions", "--sort", "lids"})["region_figures"] ==
        j["region_figures"]);

  const Outcome text =
      succeed(folder, {"inspect", "bowl.lrb", "--regions", "--render", "-o", "r.png", "--size", "200x160"});
  const std::string more =
      "  and " + std::to_string(j["regions"].get<int>() - 25) + " more: --json lists all\n";
  CHECK(text.out.find(more) != std::string::npos);
  const render::Image image = render::read_png(folder / "r.png").image;  // eleven panels in rows of four
  CHECK(image.width() > 4 * 200);
  CHECK(image.height() > 3 * 160);
  check_rejected(folder, {"inspect", "bowl.lrb", "--sort", "lids"});
  check_rejected(folder, {"inspect", "bowl.lrb", "--try"});
  check_rejected(folder, {"inspect", "bowl.lrb", "--regions", "--sort", "beauty"});
  write_mesh(without_faces(bowl(40, 20), {0}), folder / "open.obj");
  check_rejected(folder, {"inspect", "open.obj", "--regions"});
}

TEST_CASE("inspect --try: trials match build, and only better settings are advised") {
  const Folder folder;
  write_mesh(thin_disc(), folder / "disc.obj");
  const LrbRep disc = build_lrb(thin_disc());
  const json j = run_json(folder, {"inspect", "disc.obj", "--regions", "--try"});
  REQUIRE(j["trials"].size() == 7);
  CHECK(j["trials"][0]["setting"] == "as it is");
  CHECK(j["trials"][0]["waste"].get<double>() == doctest::Approx(j["total_waste"].get<double>()));
  for (const json& trial : j["trials"]) {
    std::vector<std::string> words = {"build", "disc.obj", "--no-validate"};
    std::istringstream options(trial["setting"] == "as it is" ? "" : trial["setting"].get<std::string>());
    for (std::string word; options >> word;) words.push_back(word);
    const json built = run_json(folder, words);
    CHECK(trial["total_per_real"] == built["total_per_real"]);
    CHECK(trial["outer_faces"] == built["outer_faces"]);
    CHECK(trial["outer_per_hull"].get<double>() ==
          doctest::Approx(built["volume_outer"].get<double>() / built["volume_hull"].get<double>()));
  }
  REQUIRE_FALSE(j["advice"].empty());
  // A setting is only recommended if its numbers are better.
  const std::vector<bodies::Trial> worse = {{"", {1.5, 20, 1.2, 3, 0}}, {"--patch 8", {1.6, 20, 1.3, 4, 1}}};
  CHECK(bodies::advice(disc, worse) == std::vector<std::string>{"no setting tried is more than 5 % better"});
  const std::vector<bodies::Trial> better = {{"", {1.59, 20, 1.2, 3, 0}},
                                             {"--patch 40", {1.42, 20, 1.2, 2, 1}}};
  REQUIRE(bodies::advice(disc, better).size() == 2);
  CHECK(
      bodies::advice(disc, better)[0] ==
      "--patch 40 has the lowest waste: 2 instead of 3 faces per point, with 1.42 instead of 1.59 faces per real face");
}

TEST_CASE("build warns on one line about a poor LRB-rep, with the reason") {
  const Folder folder;
  write_mesh(thin_disc(), folder / "disc.obj");
  write_mesh(bumpy_sphere(3, 1), folder / "fine.obj");
  const Outcome poor = run(folder, {"build", "disc.obj", "--no-validate"});
  CHECK(poor.code == 0);
  CHECK(poor.error_lines() == 1);
  CHECK(poor.err.starts_with("note: disc.obj: low-quality LRB-rep: its outermost wrapper has "));
  CHECK(poor.err.find("times as long as it is thick") != std::string::npos);
  CHECK(run_json(folder, {"build", "disc.obj", "--no-validate"})["notes"].size() == 1);
  CHECK(run(folder, {"build", "fine.obj", "--no-validate"}).err.empty());
}

TEST_CASE("build warns about the waste of a noisy scan, and names the cause") {
  const Folder folder;
  Mesh scan = bumpy_sphere(5, 1);
  RandomEngine random(1);
  for (Point3& x : scan.vertices) x += 0.05 * random_direction(random);
  write_mesh(scan, folder / "scan.obj");
  const Outcome poor = run(folder, {"build", "scan.obj", "--no-validate", "-o", "scan.lrb"});
  CHECK(poor.code == 0);
  CHECK(poor.err.find("faces on average (typical of clean meshes: 20 to 120)") != std::string::npos);
  CHECK(poor.err.find("its surface intersects itself, and intersecting faces cannot be covered") !=
        std::string::npos);
  CHECK(poor.err.find("approximate queries are not supported, because its surface intersects itself") !=
        std::string::npos);
  CHECK(run(folder, {"inspect", "scan.lrb", "--levels"}).err.find("approximate queries are not supported") !=
        std::string::npos);
  folder.write("p.txt", "1 0 0 0.1  0 1 0 0  0 0 1 0\n");
  CHECK(run(folder, {"query", "scan.lrb", "scan.lrb", "--poses", "p.txt", "--tolerance", "0.1"})
            .err.find("approximate queries are not supported") != std::string::npos);
  CHECK(run(folder, {"inspect", "scan.lrb", "--regions"}).out.find("(typical of clean meshes: 20 to 120)") !=
        std::string::npos);
  const LrbRep rep = build_lrb(scan);
  const bodies::Trial poor_trial{"", {1.5, 20, 1.2, 5000, 0}};
  const auto lines =
      bodies::advice(rep, std::vector{poor_trial, {"--max-outer 80", {1.5, 80, 1.0, 4990, 1}}});
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].starts_with("no setting lowers the waste of 5e+03 (typical of clean meshes: 20 to 120)"));
}

TEST_CASE("an isolated region is drawn once, in a close-up with its name") {
  const Folder folder;
  folder.write("s.json", kThinGear);
  REQUIRE(run(folder, {"run", "s.json", "-o", "run"}).code == 0);
  const json j = run_json(folder, {"inspect", "run/a.lrb", "--regions", "--sort", "lids"});
  const json &most = j["region_figures"].front(), &least = j["region_figures"].back();
  const auto picture = [&](const json& region) {
    const std::string r = std::to_string(region["region"].get<int>());
    succeed(folder, {"render", "run/trace.json", "-o", "r" + r, "--region", r, "--size", "480x360"});
    CHECK_FALSE(std::filesystem::exists(folder / ("r" + r + "/frames/frame_0001.png")));
    const std::string page = slurp(folder / ("r" + r + "/index.html"));
    CHECK(page.find("region " + r + ": layer " + std::to_string(region["layer"].get<int>()) + ", ") !=
          std::string::npos);
    CHECK(page.find("; parent ") != std::string::npos);
    return render::read_png(folder / ("r" + r + "/frames/frame_0000.png")).image;
  };
  // Close up: even a small region fills a good part of the picture.
  for (const json& region : {most, least}) {
    const render::Image image = picture(region);
    CHECK(count_pixels(image, {}, is_painted) > image.pixels().size() / 25);
  }
  const Outcome layer = run(folder, {"render", "run/trace.json", "-o", "layer", "--layer", "0"});
  CHECK(layer.code == 0);
  CHECK(slurp(folder / "layer/index.html").find("): layer 0, ") != std::string::npos);
  check_rejected(folder, {"render", "run/trace.json", "-o", "x", "--layer", "999"});
  check_rejected(folder, {"render", "run/trace.json", "-o", "x", "--layer", "b0"});

  const LrbRep rep = build_lrb(bowl(24, 8));
  const auto last = RegionId(rep.region_count() - 1);
  CHECK(run::region_text(rep, std::vector{last}, " of B")
            .starts_with("region " + std::to_string(last) + " of B: layer "));
  CHECK(run::region_text(rep, std::vector{RegionId(0), RegionId(1)}, "")
            .starts_with("2 regions (0, 1): layer"));
}

TEST_CASE("a view direction is rejected for 2D bodies") {
  const Folder folder;
  write_mesh(star(5), folder / "star.obj");
  write_mesh(without_faces(star(5), {0}), folder / "open.obj");
  for (const std::vector<std::string>& camera :
       {std::vector<std::string>{"--from", "1,1,1"}, {"--up", "y"}, {"--projection", "orthographic"}}) {
    const auto with = [&](const std::vector<std::string>& words) {
      CHECK(check_rejected(folder, joined(words, camera)).err.find("are always drawn from above") !=
            std::string::npos);
    };
    with({"inspect", "star.obj", "--render", "-o", "x.png"});
    with({"inspect", "open.obj", "--draw", "x.png"});
    with({"figure", "star.obj", "-o", "x.svg"});
  }
  CHECK(run(folder, {"inspect", "star.obj", "--render", "-o", "x.png", "--zoom", "2", "--look-at", "0,0,0"})
            .code == 0);
}

}  // namespace lrb::test
