// Coherent queries against queries from scratch: how much faster, by length of step, for bodies that are
// apart, touch and lie deep in each other. Without arguments: bodies generated here, and those of
// ../shared/meshes.
//
//   coherent_bench [A B]... [--steps N] [--walks N] [--room SHARE]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/bench/timing.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;
using bench::median;
using shapes::RandomEngine;

namespace {

struct PoseClass {
  const char* name;
  double depth;  ///< how far B goes beyond first contact, in diagonals; negative: apart
};
constexpr PoseClass kClasses[] = {{"apart 0.5 %", -0.005}, {"touching 0.2 %", 0.002}, {"deep 10 %", 0.1}};
constexpr double kSteps[] = {0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1};
constexpr int kWarm = 8;  ///< steps before the clock runs: memory is there, and the query has seen the motion

struct Bench {
  const LrbRep &a, &b;
  double diagonal;
  double
      room;  ///< B wanders no further than this from where it began, in diagonals, or a step if that is more
  QueryContext context;
  NullProbe probe;

  bool meets(const Pose& p) {
    CollideRequest first;
    first.mode = Mode::first_pair;
    return !collide(a, Pose{}, b, p, first, context, probe).pairs.empty();
  }

  Pose start(RandomEngine& random, double depth) {
    while (true) {
      Pose p;
      p.r = shapes::random_rotation(random);
      const Eigen::Vector3d d = shapes::random_direction(random);
      double s = 2 * diagonal, step = 0.005 * diagonal;
      for (p.t = s * d; s > -2 * diagonal && !meets(p); p.t = s * d) s -= step;
      if (s <= -2 * diagonal) continue;
      for (int i = 0; i < 30; ++i) {
        step /= 2;
        p.t = (s + step) * d;
        if (meets(p)) s += step;
      }
      p.t = (s - depth * diagonal) * d;
      return p;
    }
  }

  /// Steps of one length each: half of it a turn about B's middle, half a shift; in one direction for some
  /// steps.
  std::vector<Pose> walk(RandomEngine& random, const Pose& from, double length, int steps, bool apart) {
    const Eigen::Vector3d middle = shapes::box_of(b).center();
    const double radius = shapes::box_of(b).diagonal().norm() / 2, most = std::max(room * diagonal, length);
    std::vector<Pose> out = {from};
    Eigen::Vector3d way = shapes::random_direction(random), axis = shapes::random_direction(random);
    for (int tries = 0; static_cast<int>(out.size()) < steps && tries < 100 * steps; ++tries) {
      const Pose& last = out.back();
      const Pose turn = Pose::rotation(axis, 0.5 * length / radius);
      Pose next;
      next.r = turn.r * last.r;
      next.t = last.r * middle + last.t - next.r * middle + 0.5 * length * way;
      const double off = ((next.r * middle + next.t) - (from.r * middle + from.t)).norm() +
                         (next.r - from.r).norm() * radius / 1.5;
      if (off > most + length || (apart && meets(next))) {
        way = shapes::random_direction(random);
        axis = shapes::random_direction(random);
        continue;
      }
      out.push_back(next);
    }
    return out;
  }
};

template <class F>
double seconds(F&& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return bench::seconds_since(begin);
}

int run(const std::string& name, const LrbRep& a, const LrbRep& b, int steps, int walks, double room) {
  const double diagonal = std::max(shapes::box_of(a).diagonal().norm(), shapes::box_of(b).diagonal().norm());
  Bench bench{a, b, diagonal, room, {}, {}};
  std::printf("%s: %u x %u faces; from scratch / coherent, the median of %d walks of %d steps\n",
              name.c_str(), a.real_face_count(), b.real_face_count(), walks, steps);
  int differences = 0;
  for (const PoseClass& c : kClasses)
    for (const double step : kSteps) {
      RandomEngine random(1);
      std::vector<double> ratios, scratch_us;
      CoherentQuery::Statistics sum;
      double pairs = 0;
      for (int w = 0; w < walks; ++w) {
        const std::vector<Pose> poses =
            bench.walk(random, bench.start(random, c.depth), step * diagonal, steps + kWarm, c.depth < 0);
        const std::span<const Pose> timed = std::span(poses).subspan(kWarm);
        double best_scratch = 1e300, best_coherent = 1e300;
        for (int repeat = 0; repeat < 5; ++repeat) {
          std::uint64_t of_scratch = 0, of_coherent = 0;
          best_scratch =
              std::min(best_scratch, seconds([&] {
                         for (const Pose& p : timed) {
                           const CollideResult r = collide(a, Pose{}, b, p, {}, bench.context, bench.probe);
                           of_scratch += r.pairs.size() + static_cast<std::uint64_t>(r.relation) * 1000003;
                         }
                       }));
          CoherentQuery coherent(a, b);
          for (int i = 0; i < kWarm; ++i) coherent.collide(Pose{}, poses[static_cast<std::size_t>(i)]);
          best_coherent = std::min(best_coherent, seconds([&] {
                                     for (const Pose& p : timed) {
                                       const CollideResult& r = coherent.collide(Pose{}, p);
                                       of_coherent +=
                                           r.pairs.size() + static_cast<std::uint64_t>(r.relation) * 1000003;
                                     }
                                   }));
          differences += of_scratch != of_coherent;
          if (repeat > 0) continue;
          pairs += static_cast<double>(of_scratch % 1000003) / static_cast<double>(timed.size());
          sum.from_cache += coherent.statistics().from_cache;
          sum.caches_made += coherent.statistics().caches_made;
          sum.from_scratch += coherent.statistics().from_scratch;
        }
        ratios.push_back(best_scratch / best_coherent);
        scratch_us.push_back(1e6 * best_scratch / static_cast<double>(timed.size()));
      }
      std::printf(
          "  %-15s step %5.2f %%  %8.2f us %6.0f pairs  %6.2fx   (%llu from lists, %llu lists, %llu "
          "scratch)\n",
          c.name, 100 * step, median(scratch_us), pairs / walks, median(ratios),
          static_cast<unsigned long long>(sum.from_cache), static_cast<unsigned long long>(sum.caches_made),
          static_cast<unsigned long long>(sum.from_scratch));
      std::fflush(stdout);
    }
  return differences;
}

}  // namespace

int main(int argc, char** argv) {
  int steps = 100, walks = 7;
  double room = 1;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (!std::strcmp(argv[i], "--steps") && i + 1 < argc)
      steps = std::atoi(argv[++i]);
    else if (!std::strcmp(argv[i], "--walks") && i + 1 < argc)
      walks = std::atoi(argv[++i]);
    else if (!std::strcmp(argv[i], "--room") && i + 1 < argc)
      room = std::atof(argv[++i]);
    else
      files.emplace_back(argv[i]);
  }
  if (files.size() % 2 != 0 || steps < 2 || walks < 1) {
    std::fprintf(stderr, "usage: coherent_bench [A B]... [--steps N] [--walks N] [--room SHARE]\n");
    return 2;
  }
  int differences = 0;
  if (files.empty()) {
    const LrbRep rock = build_lrb(shapes::bumpy_sphere(5, 3, 0.2)), ring = build_lrb(shapes::torus(100, 50));
    differences += run("rock x ring, generated", rock, ring, steps, walks, room);
    const std::filesystem::path meshes = test::shared_meshes();
    if (meshes.empty()) std::printf("no ../shared/meshes, no LRB_MESHES: that was all\n");
    for (const char* name : {"spot.obj", "rocker-arm.obj", "nefertiti.obj"})
      if (std::filesystem::exists(meshes / name))
        files.insert(files.end(), {(meshes / name).string(), (meshes / name).string()});
  }
  for (std::size_t i = 0; i < files.size(); i += 2) {
    const LrbRep a = build_lrb(read_mesh(files[i])), b = build_lrb(read_mesh(files[i + 1]));
    differences += run(std::filesystem::path(files[i]).filename().string() + " x " +
                           std::filesystem::path(files[i + 1]).filename().string(),
                       a, b, steps, walks, room);
  }
  std::printf("%d differences\n", differences);
  return differences == 0 ? 0 : 1;
}
