#include "bench/micro/poses.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <map>
#include <tuple>

#include "bench/speed/make_sets.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::micro {

namespace fs = std::filesystem;

namespace {

Subject subject_of(std::string name, Body body) {
  const Eigen::AlignedBox3d box = shapes::box_of(body);
  return {std::move(name), std::move(body), box.diagonal().norm(), box.sizes().maxCoeff()};
}

}  // namespace

int run(int argc, char** argv, void (*add)(const Subject&)) try {
  benchmark::Initialize(&argc, argv);
  std::vector<fs::path> files(argv + 1, argv + argc);
  static std::deque<Subject> subjects;  // benchmarks keep references
  if (files.empty()) {
    add(subjects.emplace_back(subject_of("rock", Body::from(shapes::bumpy_sphere(5, 7)).value())));
    if (const char* folder = std::getenv("LRB_MESHES"))
      for (const char* name : {"spot.obj", "rocker-arm.obj", "nefertiti.obj"})
        if (fs::exists(fs::path(folder) / name)) files.push_back(fs::path(folder) / name);
  }
  for (const fs::path& file : files)
    add(subjects.emplace_back(subject_of(file.stem(), Body::load(file).value())));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
} catch (const InputError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

const std::vector<Pose>& poses_at(const Subject& subject, double depth, int count) {
  static std::map<std::tuple<const Subject*, double, int>, std::vector<Pose>> known;
  std::vector<Pose>& poses = known[{&subject, depth, count}];
  if (poses.empty()) {
    bench::Approaches approaches(subject.body, subject.body, subject.diagonal, 1);
    for (int i = 0; i < count; ++i) poses.push_back(approaches.next(depth).pose);
  }
  return poses;
}

std::vector<Pose> path_from(const Subject& subject, const Pose& start, double length, int steps,
                            bool separate) {
  constexpr double kRoom = 1;  // maximum distance of the copy from its start, in diagonals
  shapes::RandomEngine random(1);
  Workspace workspace;
  CollideRequest any;
  any.mode = Mode::any_pair;
  const Eigen::Vector3d centre = shapes::box_of(subject.body).center();
  std::vector<Pose> path = {start};
  Eigen::Vector3d direction = shapes::random_direction(random), axis = shapes::random_direction(random);
  for (int tries = 0; static_cast<int>(path.size()) < steps && tries < 100 * steps; ++tries) {
    const Pose& last = path.back();
    Pose next;
    next.r = Pose::rotation(axis, length).r * last.r;  // half of the step: a radius is half a diagonal
    next.t = last.apply(centre) - next.r * centre + 0.5 * length * subject.diagonal * direction;
    const bool leaves =
        (next.apply(centre) - start.apply(centre)).norm() > std::max(kRoom, 2 * length) * subject.diagonal;
    if (leaves ||
        (separate && !collide(subject.body, {}, subject.body, next, any, workspace)->pairs.empty())) {
      direction = shapes::random_direction(random);
      axis = shapes::random_direction(random);
    } else {
      path.push_back(next);
    }
  }
  return path;
}

}  // namespace lrb::micro
