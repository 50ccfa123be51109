// Measures how CPU time and memory grow with the size of the input (and of the answer), family by family, as
// fitted powers, and exits with 1 if one grows faster than it may:
//   scaling [--share] [--only TEXT]...
// --share: the small sizes alone, and 0.35 more allowed for a busy machine, as the test suite runs it.
// --only: families whose line has this text.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/paper/series.hpp"
#include "tests/support/counted_new.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::scaling {
namespace {

using Sizes = std::vector<std::uint32_t>;

/// The sizes that most families are measured at.
const Sizes kShare = {1000, 2000, 4000, 8000}, kMore = {16000, 32000, 64000};

/// One input with its measured operation.
struct Task {
  double size = 0;             ///< what time and memory are fitted against: of the input, and of the answer
  std::function<void()> work;  ///< may be called several times
};

struct Family {
  std::string input, work;           ///< name in the table: "drum", "query"
  std::string unit;                  ///< unit of the size: "corners"
  std::vector<std::uint32_t> share;  ///< sizes for the test suite: a second or two together
  std::vector<std::uint32_t> more;   ///< further sizes, larger, for the whole run
  std::function<Task(std::uint32_t size)> make;
  double max_time = 1.35;  ///< allowed powers; n log n is 1.1 to 1.15 at these sizes
  double max_memory = 1.2;
};

// From a mesh to a body and to an answer: the check, with the search for self-intersections; building; the
// proof; one query of two bodies from their faces alone, as `query` asks it. What grows is the input (the
// query's tree is made, too) and the answer: time is fitted against the larger of the two.

using namespace hard;

LrbRep bare(const Mesh& mesh) {
  const CheckedMesh checked = check(mesh);
  return LrbRep::without_regions(checked.mesh(), checked.report().bounds_solid, false);
}

/// In contact, a little aslant.
Pose aslant() {
  return Pose::rotation({1, 2, 3}, 0.3, {0.3, 0.2, 0.4});
}

/// Does some work with a mesh of that size: of the input's corners, or of the answer's pairs if there are
/// more.
Task task_of(const std::string& work, const Mesh& made, const Pose& pose) {
  const auto mesh = std::make_shared<Mesh>(made);
  const auto corners = static_cast<double>(made.face_vertices.size());
  if (work == "check") return {corners, [=] { check_mesh(*mesh); }};
  if (work == "build") {
    const auto checked = std::make_shared<CheckedMesh>(check(made));
    return {corners, [=] { build_lrb(*checked); }};
  }
  if (work == "proof") {
    const auto rep = std::make_shared<LrbRep>(build_lrb(made));
    return {corners, [=] { validate(*rep); }};
  }
  if (work == "query") {
    const auto ask = [=] {
      const LrbRep a = bare(*mesh), b = bare(*mesh);
      return collide(a, Pose{}, b, pose, CollideRequest{}).pairs.size();
    };
    return {std::max(corners, static_cast<double>(ask())), ask};
  }
  const auto body = std::make_shared<LrbRep>(bare(made));
  const CollideRequest request{.contacts = work == "contacts"};
  const auto ask = [=] { return collide(*body, Pose{}, *body, pose, request).pairs.size(); };
  return {static_cast<double>(ask()), ask};
}

struct Input {
  std::string name;
  std::function<Mesh(std::uint32_t)> make;
  std::vector<const char*> works = {"check", "build", "proof", "query"};
  Sizes share = kShare, more = kMore;
  Pose pose = aslant();
  double max_time = 1.35, max_memory = 1.2;
};

Mesh two_drums(std::uint32_t n) {
  return shapes::several({drum(n), shapes::translated(drum(n), {0, 0, 1})});
}

const std::vector<Input> kInputs = {
    {"rock", rock, {"check", "build", "proof", "query"}, {2, 3, 4}, {5, 6}},
    {"drum", drum},
    // A concave face is the fan from its first corner, which goes beyond its rim: of n quads at its sides
    // each meets a share of n triangles of the fan, so that what meets grows as n^2. That a pair of faces
    // needs one of them alone leaves n^1.7. Beyond 16,000 corners the query has more pairs than are kept.
    {"drum with concave ends", cog, {"check"}, kShare, kMore, aslant(), 1.8},
    {"drum with concave ends", cog, {"query"}, kShare, {16000}},
    // Without the proof, which counts the pairs of triangles that meet: in the fans of a box whose corners in
    // the middle of sides give triangles without area, and at the common end of two drums, n^2 do.
    {"box of many corners", fine_box, {"check", "build", "query"}},
    {"two drums, end to end", two_drums, {"check", "build"}},
    {"cone", cone},
    {"bipyramid", bipyramid},
    {"crown", crown},
    {"fan disk", fan_disk, {"check", "query"}},
    {"frustum", frustum},
    // Balls in balls need the tree of turned boxes from about a hundred on, and five times the memory with
    // it: a step, which looks like a power. Only the outermost reach into each other.
    {"nested balls",
     nested,
     {"check", "build", "proof", "query"},
     {16, 32, 64},
     {128, 256},
     Pose::translation({1.9, 0, 0}),
     1.35,
     1.5},
    {"pieces", pieces, {"check", "build", "proof", "query"}, {3, 6, 12, 24}, {48, 96}},
    {"tiles", tiles, {"check", "build", "proof", "query"}, {16, 32, 64}, {128}},
    {"rock, in one place", rock, {"pairs", "contacts"}, {2, 3, 4}, {5}, Pose{}},
    {"tiles, on each other", tiles, {"pairs", "contacts"}, {8, 16, 32}, {64}, Pose::translation({0, 0, 1})},
    {"drum, through its side", drum, {"pairs", "contacts"}, kShare, kMore, Pose::translation({0.5, 0, 0.5})}};

// One query of two bodies under poses other than rotations: it grows with the answer and the nearby faces,
// as under a rotation. Where boxes culled nothing it would grow with the product of both bodies' faces.

/// The pose that puts the maps of two balls of radius 1 across each other.
Pose across(const Eigen::Matrix3d& map) {
  Pose pose;
  pose.r = map * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  pose.t = map * Eigen::Vector3d(0.5, 0.4, 0.3);
  return pose;
}

/// The query alone, of balls of about n faces each.
Task ask(std::uint32_t n, const Eigen::Matrix3d& map_a, const Eigen::Matrix3d& map_b) {
  const auto stacks = static_cast<int>(std::sqrt(n / 2.0));
  const auto body =
      std::make_shared<LrbRep>(LrbRep::without_regions(shapes::uv_sphere(stacks, stacks + 1), true, false));
  const auto context = std::make_shared<QueryContext>();
  const Pose a{map_a, {0, 0, 0}}, b = across(map_b);
  const auto work = [=] {
    NullProbe probe;
    return collide(*body, a, *body, b, CollideRequest{}, *context, probe).pairs.size();
  };
  return {static_cast<double>(n + work()), work};
}

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

Eigen::Matrix3d shear() {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 1) = 0.5;
  return m;
}

const std::vector<Family>& families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> out;
    for (const Input& x : kInputs)
      for (const std::string work : x.works)
        out.push_back({x.name, work, work == "pairs" || work == "contacts" ? "pairs" : "corners", x.share,
                       x.more, [&x, work](std::uint32_t n) { return task_of(work, x.make(n), x.pose); },
                       x.max_time, x.max_memory});
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    const struct {
      const char* name;
      Eigen::Matrix3d a, b;
    } maps[] = {{"scaled by 1.01", one, 1.01 * one},
                {"scaled by 1.5", one, 1.5 * one},
                {"both scaled by 1e-150", 1e-150 * one, 1e-150 * one},
                {"stretched", one, diagonal(1, 2, 0.5)},
                {"sheared", shear(), one},
                {"mirrored", diagonal(-1, 1, 1), one},
                {"thin", diagonal(1, 1, 0.001), one},
                {"flat", one, diagonal(1, 1, 0)}};
    for (const auto& map : maps)
      out.push_back({map.name,
                     "query at a pose",
                     "faces and pairs",
                     {4000, 16000, 64000},
                     {256000, 1024000},
                     [a = map.a, b = map.b](std::uint32_t n) { return ask(n, a, b); }});
    std::sort(out.begin(), out.end(), [](const Family& x, const Family& y) {
      return x.input != y.input ? x.input < y.input : x.work < y.work;
    });
    return out;
  }();
  return all;
}

double cpu_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Cost {
  double size, seconds, bytes;
};

/// The least of some repeats: what other processes do only ever adds to it.
Cost measure(const Task& task) {
  constexpr double kEnough = 0.1;  // seconds
  constexpr int kLeast = 2, kMax = 20;
  Cost cost{task.size, 0, 0};
  double total = 0;
  for (int i = 0; i < kLeast || (i < kMax && total < kEnough); ++i) {
    const test::PeakMemory memory;
    const double begin = cpu_seconds();
    task.work();
    const double seconds = cpu_seconds() - begin;
    total += seconds;
    cost.bytes = static_cast<double>(memory.bytes());
    cost.seconds = i == 0 ? seconds : std::min(cost.seconds, seconds);
    if (seconds > 10 * kEnough) break;
  }
  return cost;
}

/// Powers of time and of memory. Too little to be measured does not grow.
struct Growth {
  double time, memory;
};

Growth fit(const std::vector<Cost>& costs) {
  constexpr double kMinSeconds = 20e-6, kMinBytes = 4096;
  std::vector<double> size, seconds, bytes;
  for (const Cost& c : costs) {
    size.push_back(c.size);
    seconds.push_back(std::max(c.seconds, kMinSeconds));
    bytes.push_back(std::max(c.bytes, kMinBytes));
  }
  return {resolutions::fit_power(size, seconds).exponent, resolutions::fit_power(size, bytes).exponent};
}

/// True if nothing grows faster than it may.
bool run(const Family& family, bool share) {
  std::vector<std::uint32_t> sizes = family.share;
  // Small sizes on a busy machine: quadratic growth is detected, growth slightly above n log n only in the
  // full run.
  constexpr double kShareSlack = 0.35;
  const double max_time = family.max_time + (share ? kShareSlack : 0);
  if (!share) sizes.insert(sizes.end(), family.more.begin(), family.more.end());
  Growth growth{};
  std::vector<Cost> costs;
  for (int attempt = 0; attempt < 2; ++attempt) {  // a slow moment of the machine is no cliff
    std::vector<Cost> now;
    for (const std::uint32_t size : sizes) now.push_back(measure(family.make(size)));
    for (std::size_t i = 0; i < costs.size(); ++i)
      now[i].seconds = std::min(now[i].seconds, costs[i].seconds);
    costs = std::move(now);
    growth = fit(costs);
    if (growth.time <= max_time && growth.memory <= family.max_memory) break;
  }
  const bool ok = growth.time <= max_time && growth.memory <= family.max_memory;
  std::printf(
      "| %-24s | %-14s | %-8s | %10.0f | %10.0f | %10.3f | %9.2f | %5.2f | %5.2f | %5.2f | %5.2f | %s |\n",
      family.input.c_str(), family.work.c_str(), family.unit.c_str(), costs.front().size, costs.back().size,
      1e3 * costs.back().seconds, costs.back().bytes / 1e6, growth.time, max_time, growth.memory,
      family.max_memory, ok ? "ok" : "CLIFF");
  if (!ok)
    for (const Cost& c : costs)
      std::printf("|   size %.0f: %.3f ms, %.2f MB\n", c.size, 1e3 * c.seconds, c.bytes / 1e6);
  std::fflush(stdout);
  return ok;
}

int run_all(int argc, char** argv) {
  bool share = false;
  std::vector<std::string> only;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--share") == 0) {
      share = true;
    } else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
      only.emplace_back(argv[++i]);
    } else {
      std::fprintf(stderr, "usage: scaling [--share] [--only TEXT]...\n");
      return 2;
    }
  }
  std::printf(
      "| input                    | work           | size in  | from       | to         | ms there   | MB there  "
      "| time  | most  | mem.  | most  |    |\n");
  bool ok = true;
  std::size_t measured = 0;
  for (const Family& family : families()) {
    const std::string line = family.input + " " + family.work + " " + family.unit;
    const auto wanted = [&](const std::string& text) { return line.find(text) != std::string::npos; };
    if (!only.empty() && std::none_of(only.begin(), only.end(), wanted)) continue;
    ok = run(family, share) && ok;
    ++measured;
  }
  if (measured == 0) {
    std::fprintf(stderr, "scaling: no family has this text in its name\n");
    return 2;
  }
  return ok ? 0 : 1;
}

}  // namespace
}  // namespace lrb::scaling

int main(int argc, char** argv) {
  try {
    return lrb::scaling::run_all(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scaling: %s\n", error.what());
    return 2;
  }
}
