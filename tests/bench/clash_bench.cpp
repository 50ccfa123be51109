// Depths of bodies that are not convex: how narrow, and how long they take. Each body against itself, B
// turned at random and moved towards A until it is as deep as the row says, in shares of the diagonal beyond
// first contact. Times are of the processor.
//
//   clash_bench [--poses N] [MESH...]
//
// Without meshes: spot, homer and cheburashka of LRB_MESHES, and shapes of ours.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include "engine/clash/clash_parts.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/bench/approaches.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;

namespace {

constexpr double kDepths[] = {0.01, 0.05, 0.2};  // of the diagonal

double processor_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void run(const LrbRep& rep, const char* name, int poses) {
  const double diagonal = shapes::box_of(rep).diagonal().norm();
  const std::vector<bench::Approach> approaches = bench::approaches(rep, rep, diagonal, poses);
  for (const double depth : kDepths) {
    double share = 0, least = 1, sum = 0, most = 0;
    for (const bench::Approach& approach : approaches) {
      ClashRequest request;
      request.volume = false;
      const double start = processor_ms();
      const ClashResult r = clash(rep, Pose{}, rep, approach.beyond(depth * diagonal), request);
      const double ms = processor_ms() - start;
      const double now = r.depth && r.depth->upper > 0 ? r.depth->lower / r.depth->upper : 1;
      share += now;
      least = std::min(least, now);
      sum += ms;
      most = std::max(most, ms);
    }
    std::printf(
        "%-12s %6u faces %3.0f %%: lower end %5.1f %% of the upper one, at least %5.1f %%; %6.1f ms, at most %6.1f\n",
        name, rep.real_simplex_count(), 100 * depth, 100 * share / poses, 100 * least, sum / poses, most);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int poses = 8;
  std::vector<std::string> meshes;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--poses") && i + 1 < argc)
      poses = std::max(1, std::atoi(argv[++i]));
    else
      meshes.emplace_back(argv[i]);
  }
  if (meshes.empty()) {
    run(LrbRep::without_regions(shapes::bumpy_sphere(3, 7, 0.3), true, false), "bumpy", poses);
    run(LrbRep::without_regions(shapes::torus(40, 24), true, false), "torus", poses);
    for (const char* name : {"spot", "homer", "cheburashka"})
      meshes.push_back((test::shared_meshes() / (std::string(name) + ".obj")).string());
  }
  for (const std::string& path : meshes)
    run(build_lrb(read_mesh(path)), std::filesystem::path(path).stem().string().c_str(), poses);
}
