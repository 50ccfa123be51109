// Prints, for each mesh given (or all of LRB_MESHES), what its LRB-rep costs:
//   build_bench [-k INTERIOR] [-r REPEATS] [--threads N] [--validate] MESH...
// or how building and loading grow with size, on each mesh (or the generated rock) at resolutions of it:
//   build_bench --growth [-r REPEATS] [--validate] [--subdivide N] [--resolutions N] [MESH|rock]...

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "engine/build/build.hpp"
#include "engine/build/closing.hpp"
#include "engine/build/convex_hull.hpp"
#include "engine/error.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "engine/lrb/validate.hpp"
#include "engine/mesh/mesh_io.hpp"
#include "scenarios/generators/generators.hpp"
#include "scenarios/series/power_fit.hpp"
#include "scenarios/series/resolutions.hpp"

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

double cpu_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The least of some repeats: what other processes do only ever adds to it.
template <class Work>
double least_cpu_seconds(int repeats, const Work& work) {
  double least = 0;
  for (int i = 0; i < repeats; ++i) {
    const double begin = cpu_seconds();
    work();
    const double taken = cpu_seconds() - begin;
    if (i == 0 || taken < least) least = taken;
  }
  return least;
}

/// Most memory that this process ever held, in bytes.
double peak_bytes() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  constexpr double kKibi = 1024;
  return kKibi * static_cast<double>(use.ru_maxrss);
}

void print_growth(const Mesh& mesh, const lrb::ResolutionOptions& resolutions,
                  const lrb::BuildOptions& options, int repeats, bool validating) {
  std::printf(
      "%s\n| faces | build: CPU s | us a face | total/real | outer faces | load: CPU ms | .lrb MB | "
      "LRB-rep MB | peak MB |\n",
      mesh.name.c_str());
  const std::string file =
      std::filesystem::temp_directory_path() / ("build_bench." + std::to_string(getpid()));
  std::vector<double> faces, seconds;
  std::vector<Mesh> series = lrb::resolutions(mesh, resolutions);
  std::reverse(series.begin(), series.end());  // the peak is that of the largest so far
  for (const Mesh& m : series) {
    faces.push_back(static_cast<double>(m.face_count()));
    seconds.push_back(least_cpu_seconds(repeats, [&] { build_lrb(m, options); }));
    const lrb::LrbRep rep = build_lrb(m, options);
    save_lrb(rep, file);
    constexpr int kLoads = 5;
    const double load = least_cpu_seconds(kLoads, [&] { lrb::load_lrb(file); });
    constexpr double kMega = 1e6;
    std::printf("| %.0f | %.3f | %.2f | %.3f | %zu | %.1f | %.1f | %.1f | %.0f |", faces.back(),
                seconds.back(), kMega * seconds.back() / faces.back(),
                static_cast<double>(rep.face_count()) / rep.real_face_count(), rep.outermost_faces().size(),
                1e3 * load, static_cast<double>(std::filesystem::file_size(file)) / kMega,
                static_cast<double>(rep.memory_bytes()) / kMega, peak_bytes() / kMega);
    if (validating) {
      const lrb::ValidateReport v = validate(rep);
      std::printf(" %s |", v.valid ? "valid" : v.violations.front().c_str());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  std::filesystem::remove(file);
  if (faces.size() < 2) return;
  const lrb::PowerFit fit = lrb::fit_power(faces, seconds);
  std::printf("build time grows as n^%.3f +- %.3f\n", fit.exponent, fit.error);
}

Mesh growth_mesh(const std::string& path) {
  if (path != "rock") return lrb::read_mesh(path);
  Mesh rock = lrb::generate("rock", {{"frequency", 316}});  // 1,997,120 faces
  rock.name = path;
  return rock;
}

}  // namespace

int main(int argc, char** argv) try {
  lrb::BuildOptions options;
  int repeats = 3;
  bool validating = false, growth = false;
  lrb::ResolutionOptions resolutions;
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    if (arg == "-k" && i + 1 < argc)
      options.patch_interior = static_cast<std::uint32_t>(std::strtoul(argv[++i], nullptr, 10));
    else if (arg == "--threads" && i + 1 < argc)
      options.threads = static_cast<unsigned>(std::strtoul(argv[++i], nullptr, 10));
    else if (arg == "-r" && i + 1 < argc)
      repeats = std::max(1, std::atoi(argv[++i]));
    else if (arg == "--growth")
      growth = true;
    else if (arg == "--subdivide" && i + 1 < argc)
      resolutions.subdivisions = static_cast<std::uint32_t>(std::strtoul(argv[++i], nullptr, 10));
    else if (arg == "--resolutions" && i + 1 < argc)
      resolutions.most = static_cast<std::uint32_t>(std::strtoul(argv[++i], nullptr, 10));
    else if (arg == "--validate")
      validating = true;
    else
      paths.push_back(arg);
  }
  if (growth) {
    if (paths.empty()) paths = {"rock"};
    for (const std::string& path : paths)
      print_growth(growth_mesh(path), resolutions, options, repeats, validating);
    return 0;
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
