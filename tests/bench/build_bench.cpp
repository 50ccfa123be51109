// Prints, for each mesh given (or all of LRB_MESHES), what its LRB-rep costs, built lean and to fit, and how
// many faces its wrappers have at tolerances, as shares of its largest side:
//   build_bench [-k INTERIOR] [-r REPEATS] [--threads N] [--validate] MESH...
// or how building and loading grow with size, on each mesh (or the generated rock) at resolutions of it:
//   build_bench --growth [-r REPEATS] [--threads N] [--validate] [--subdivide N] [--resolutions N]
//   [MESH|rock]...

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <malloc.h>
#include <unistd.h>

#include "engine/construct/closing.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/resolutions.hpp"
#include "scenarios/paper/series.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/validate.hpp>

namespace {

using lrb::Mesh;

double hull_volume(const Mesh& mesh) {
  Mesh hull;
  hull.vertices = mesh.vertices;
  for (const auto& t : lrb::convex_hull(mesh.vertices))
    hull.add_face(std::array{lrb::VertexId(t[0]), lrb::VertexId(t[1]), lrb::VertexId(t[2])});
  return lrb::construct::volume_of(hull);
}

double cpu_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wall_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The least of some repeats: what other processes do only ever adds to it.
struct Times {
  double cpu, wall;
};

template <class Work>
Times least_times(int repeats, const Work& work) {
  Times least{};
  for (int i = 0; i < repeats; ++i) {
    const double cpu = cpu_seconds(), wall = wall_seconds();
    work();
    const Times t{cpu_seconds() - cpu, wall_seconds() - wall};
    least = i == 0 ? t : Times{std::min(least.cpu, t.cpu), std::min(least.wall, t.wall)};
  }
  return least;
}

/// How a mesh is built, lean and to fit, its levels, and what comes of it.
void report(const std::string& path, const lrb::BuildOptions& options, int repeats, bool validating) {
  const Mesh mesh = lrb::read_mesh(path);
  lrb::BuildOptions lean = options;
  lean.lean = true;
  const double lean_seconds = least_times(repeats, [&] { build_lrb(mesh, lean); }).cpu;
  std::optional<lrb::LrbRep> rep;
  const double seconds = least_times(repeats, [&] { rep = build_lrb(mesh, options); }).cpu;
  const double levels = least_times(1, [&] { rep->levels(options.threads); }).cpu;
  const std::vector<lrb::FaceId> outer(rep->outermost_faces().begin(), rep->outermost_faces().end());
  std::printf("| %s | %u | %.3f | %.3f | %.2f | %.3f |", std::filesystem::path(path).stem().c_str(),
              rep->real_face_count(), lean_seconds, seconds, seconds / lean_seconds, levels);
  constexpr double kShares[] = {0.005, 0.01, 0.02};
  for (const lrb::bodies::LevelFigures& l : lrb::bodies::level_figures(*rep, kShares, options.threads))
    std::printf(" %u |", l.faces);
  std::printf(" %.3f | %zu | %.2f | %u | %u |",
              static_cast<double>(rep->face_count()) / rep->real_face_count(), outer.size(),
              enclosed_volume(*rep, outer) / hull_volume(mesh), rep->region_count(), rep->layer_count());
  if (validating) {
    const lrb::ValidateReport v = validate(*rep);
    std::printf(" %s |", v.valid ? "valid" : v.violations.front().c_str());
  }
  std::printf("\n");
  std::fflush(stdout);
}

/// What Linux says of this process's memory in bytes: "VmRSS:", "VmHWM:" (the most of the former so far).
double memory_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  constexpr double kKibi = 1024;
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key)) return kKibi * std::strtod(line.c_str() + key.size(), nullptr);
  return 0;
}

/// The most memory that some work takes beyond what is held before it. Linux alone can forget an old peak;
/// elsewhere it is 0.
template <class Work>
double peak_bytes_of(const Work& work) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  const double before = memory_bytes("VmRSS:");
  work();
  return memory_bytes("VmHWM:") - before;
}

void print_growth(const Mesh& mesh, const lrb::resolutions::ResolutionOptions& resolutions,
                  const lrb::BuildOptions& options, int repeats, bool validating) {
  std::printf(
      "%s\n| faces | build: CPU s | us a face | build: wall s | peak MB | bytes a face | LRB-rep MB | bytes "
      "a "
      "face | total/real | outer faces | load: CPU ms | .lrb MB |\n",
      mesh.name.c_str());
  const std::string file =
      std::filesystem::temp_directory_path() / ("build_bench." + std::to_string(getpid()));
  std::vector<double> faces, seconds;
  std::vector<Mesh> series = lrb::resolutions::resolutions(mesh, resolutions);
  std::reverse(series.begin(), series.end());  // the least first: soon something to see
  for (const Mesh& m : series) {
    const auto n = static_cast<double>(m.face_count());
    std::optional<lrb::LrbRep> rep;
    Times build{};
    const double peak = peak_bytes_of([&] { build = least_times(1, [&] { rep = build_lrb(m, options); }); });
    if (repeats > 1) {
      const Times more = least_times(repeats - 1, [&] { build_lrb(m, options); });
      build = {std::min(build.cpu, more.cpu), std::min(build.wall, more.wall)};
    }
    faces.push_back(n);
    seconds.push_back(build.cpu);
    save_lrb(*rep, file);
    constexpr int kLoads = 5;
    const double load = least_times(kLoads, [&] { lrb::load_lrb(file); }).cpu;
    constexpr double kMega = 1e6;
    const auto held = static_cast<double>(rep->memory_bytes());
    std::printf("| %.0f | %.3f | %.2f | %.3f | %.0f | %.0f | %.1f | %.0f | %.3f | %zu | %.1f | %.1f |", n,
                build.cpu, kMega * build.cpu / n, build.wall, peak / kMega, peak / n, held / kMega, held / n,
                static_cast<double>(rep->face_count()) / n, rep->outermost_faces().size(), 1e3 * load,
                static_cast<double>(std::filesystem::file_size(file)) / kMega);
    if (validating) {
      const lrb::ValidateReport v = validate(*rep);
      std::printf(" %s |", v.valid ? "valid" : v.violations.front().c_str());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  std::filesystem::remove(file);
  if (faces.size() < 2) return;
  const lrb::resolutions::PowerFit fit = lrb::resolutions::fit_power(faces, seconds);
  std::printf("build time (CPU) grows as n^%.3f +- %.3f\n", fit.exponent, fit.error);
}

Mesh growth_mesh(const std::string& path) {
  if (path != "rock") return lrb::read_mesh(path);
  Mesh rock = lrb::generators::generate("rock", {{"frequency", 316}});  // 1,997,120 faces
  rock.name = path;
  return rock;
}

}  // namespace

int main(int argc, char** argv) try {
  lrb::BuildOptions options;
  int repeats = 3;
  bool validating = false, growth = false;
  lrb::resolutions::ResolutionOptions resolutions;
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
      "| mesh | faces | lean: CPU s | CPU s | times lean | levels: CPU s | faces at 0.005 | 0.01 | 0.02 | total/real | "
      "outer faces | outer/hull volume | regions | layers |\n");
  for (const std::string& path : paths) report(path, options, repeats, validating);
} catch (const lrb::InputError& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
