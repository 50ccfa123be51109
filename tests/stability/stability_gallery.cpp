// Pictures to look at, not a test: stability_gallery FOLDER writes a worst case of every family, with answers
// that are wrong on purpose, and the page and charts of a grid that no method made.

#include <cstdio>

#include "bench/stability/stability_report.hpp"
#include "bench/stability/worst_case.hpp"
#include "scenarios/io/files.hpp"
#include "tests/stability/made_up_grid.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

using namespace lrb;
using namespace lrb::stability;

namespace {

/// Every third pair missed, and a pair of neighbours in excess.
std::vector<SimplexPair> spoilt(const std::vector<SimplexPair>& pairs, const cases::Case& c) {
  std::vector<SimplexPair> out;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (i % 3 != 1) out.push_back(pairs[i]);
  if (!pairs.empty())
    out.push_back({SimplexId((pairs[0].a + 1) % c.a->real_simplex_count()),
                   SimplexId((pairs[0].b + 1) % c.b->real_simplex_count())});
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: stability_gallery FOLDER\n"), 2;
  const std::string folder = argv[1];
  make_folder(folder + "/worst");
  const Grid grid = made_up_grid();
  render::Rasterizer rasterizer;
  ReportOptions options;
  options.pictures.resize(grid.cells.size());
  options.command = [](const Record& r) {
    return "lrbscope stability --family " + r.family + " --method " + r.method + " --difficulty " +
           std::to_string(r.difficulty) + " --case " + std::to_string(r.case_index) + " --seed " +
           std::to_string(r.seed);
  };
  std::size_t f = 0;
  std::vector<render::Panel> sheet;
  for (const cases::Family& family : cases::all_families()) {
    for (const int difficulty : {2, 10}) {
      const cases::Case c = cases::make_case(family, 1, difficulty, 3);
      const std::string file =
          "worst/" + std::string(family.name) + "-" + std::to_string(difficulty) + ".png";
      try {
        const BruteForceResult right = brute_force(*c.a, c.pose_a, *c.b, c.pose_b);
        draw_worst_case(c, right.pairs, spoilt(right.pairs, c),
                        {std::string(family.name) + " \u00d7 made up",
                         "wrong on purpose",
                         {{"difficulty", std::to_string(difficulty) + " of 10"},
                          {"relation", to_string(right.relation)}}},
                        folder + "/" + file, rasterizer);
        if (difficulty == 10) sheet.push_back({render::read_png(folder + "/" + file).image, ""});
        for (std::size_t m = 0; m < grid.methods.size(); ++m)
          options.pictures[f * grid.methods.size() + m] = file;
      } catch (const std::exception& e) {
        std::printf("%s %d: %s\n", family.name, difficulty, e.what());
      }
    }
    if (++f % 6 == 0 || f == grid.families.size()) {
      render::MontageOptions layout;
      layout.columns = 2;
      render::write_png(render::montage(sheet, layout), folder + "/sheet-" + std::to_string(f) + ".png");
      sheet.clear();
    }
  }
  options.links = {{"records.jsonl", "every answer, one line each"}};
  const report::Document page = write_stability_report(grid, folder, options);
  for (const std::vector<std::string>& lines : {page.written(), page.notes()})
    for (const std::string& line : lines) std::printf("%s\n", line.c_str());
}
