// stability_page FOLDER: writes FOLDER/index.html, the page of a grid that no method made, for measure.sh.

#include <cstdio>

#include "bench/stability/stability_report.hpp"
#include "tests/stability/made_up_grid.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

using namespace lrb;
using namespace lrb::stability;

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: stability_page FOLDER\n"), 2;
  const std::string folder = argv[1];
  const Grid grid = made_up_grid();
  make_folder(folder);
  render::write_png(render::Image(64, 40, render::palette::kBlue), folder + "/worst.png");
  ReportOptions options;
  options.pictures.resize(grid.cells.size());
  options.pictures[1] = "worst.png";
  options.command = [](const Record& r) { return "lrbscope stability --family " + r.family; };
  stability_page(grid, folder, options).write(folder);
}
