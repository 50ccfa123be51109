// Prints, for each mesh given (or all of LRB_MESHES), what its LRB-rep costs:
//   build_bench [-k INTERIOR] [-r REPEATS] [--validate] MESH...

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/build/build.hpp"
#include "engine/build/closing.hpp"
#include "engine/build/convex_hull.hpp"
#include "engine/error.hpp"
#include "engine/lrb/validate.hpp"
#include "engine/mesh/mesh_io.hpp"

namespace {

using lrb::Mesh;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double hull_volume(const Mesh& mesh) {
  Mesh hull;
  hull.vertices = mesh.vertices;
  for (const auto& t : lrb::convex_hull(mesh.vertices)) hull.add_face(t);
  return volume_of(hull);
}

void report(const std::string& path, const lrb::BuildOptions& options, int repeats, bool validating) {
  Mesh mesh = lrb::read_mesh(path);
  std::vector<double> times;
  for (int i = 1; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    build_lrb(mesh, options);
    times.push_back(seconds_since(start));
  }
  const auto start = std::chrono::steady_clock::now();
  const lrb::LrbRep rep = build_lrb(mesh, options);
  times.push_back(seconds_since(start));
  std::sort(times.begin(), times.end());
  double lids = 0, floor = 0;
  for (lrb::RegionId r = 0; r < rep.region_count(); ++r) {
    lids += static_cast<double>(rep.lids(r).size());
    floor += static_cast<double>(rep.floor(r).size());
  }
  const double regions = std::max(1u, rep.region_count());
  const std::vector<lrb::FaceId> outer(rep.outermost_faces().begin(), rep.outermost_faces().end());
  std::printf("| %s | %u | %.3f | %.3f | %zu | %.2f | %u | %u | %.0f/%.0f |",
              std::filesystem::path(path).stem().c_str(), rep.real_face_count(), times[times.size() / 2],
              static_cast<double>(rep.face_count()) / rep.real_face_count(), outer.size(),
              enclosed_volume(rep, outer) / hull_volume(mesh), rep.region_count(), rep.layer_count(),
              floor / regions, lids / regions);
  if (validating) {
    const lrb::ValidateReport v = validate(rep);
    std::printf(" %s |", v.valid ? "valid" : v.violations.front().c_str());
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
  lrb::BuildOptions options;
  int repeats = 3;
  bool validating = false;
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "-k" && i + 1 < argc)
      options.patch_interior = static_cast<std::uint32_t>(std::strtoul(argv[++i], nullptr, 10));
    else if (arg == "-r" && i + 1 < argc)
      repeats = std::max(1, std::atoi(argv[++i]));
    else if (arg == "--validate")
      validating = true;
    else
      paths.push_back(arg);
  }
  if (const char* folder = std::getenv("LRB_MESHES"); paths.empty() && folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".obj") paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
  }
  if (paths.empty()) {
    std::fprintf(stderr, "build_bench: no meshes; name some, or a folder of OBJ files in LRB_MESHES\n");
    return 2;
  }
  std::printf(
      "| mesh | faces | build s | total/real | outer faces | outer/hull volume | regions | layers | "
      "floor/lids |\n");
  for (const std::string& path : paths) report(path, options, repeats, validating);
} catch (const lrb::InputError& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
