// Queries of a body and a copy of itself, each kind by subject:
//
//   queries_bench --benchmark_filter=/coarse/     also: coherent, distance, clash, batch, pose
//
// `lrbscope bench` and `lrbscope chart` compare queries with other methods and engines.
#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "bench/methods/triangles.hpp"
#include "bench/micro/subjects.hpp"
#include "bench/speed/make_sets.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

/// A pose class: `depth` diagonals beyond first contact; negative: separate.
struct Depth {
  const char* name;
  double depth;
};

/// Returns `count` poses of the copy, each reached along a random direction with a random rotation. Made
/// once.
const std::vector<Pose>& poses_at(const Subject& subject, double depth, int count = 16) {
  static std::map<std::tuple<const Subject*, double, int>, std::vector<Pose>> known;
  std::vector<Pose>& poses = known[{&subject, depth, count}];
  if (poses.empty()) {
    bench::Approaches approaches(subject.body, subject.body, subject.diagonal, 1);
    for (int i = 0; i < count; ++i) poses.push_back(approaches.next(depth).pose);
  }
  return poses;
}

/// Returns `steps` poses: each moves by `length` diagonals and rotates about the body's centre, half of the
/// step each, in a constant direction that changes when the copy would leave its surroundings or, if
/// `separate`, intersect.
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

/// Returns a path from each of `count` poses; the copy stays separate if the poses are.
std::vector<std::vector<Pose>> paths_from(const Subject& s, double depth, int count, double length,
                                          int steps) {
  std::vector<std::vector<Pose>> paths;
  for (const Pose& start : poses_at(s, depth, count))
    paths.push_back(path_from(s, start, length, steps, depth < 0));
  return paths;
}

/// Runs `ask` at every pose in each iteration, after one round that is not measured. The counter `pose` is
/// the time of one pose.
template <class Ask>
void at_all_poses(benchmark::State& state, std::span<const Pose> poses, const Ask& ask) {
  for (const Pose& pose : poses) ask(pose);
  for (auto _ : state)
    for (const Pose& pose : poses) ask(pose);
  state.counters["pose"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(poses.size()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Returns the mean of a number over poses.
template <class Number>
double mean(std::span<const Pose> poses, const Number& number) {
  double sum = 0;
  for (const Pose& pose : poses) sum += static_cast<double>(number(pose));
  return sum / static_cast<double>(poses.size());
}

// Coarse queries with tolerances and time limits, and exact ones at the same poses. Tolerances and error
// bounds are shares of the longest side of the body's box.
namespace coarse {

constexpr Depth kDepths[] = {{"separate 0.5 %", -0.005},
                             {"touching", 0},
                             {"barely 0.1 %", 0.001},
                             {"shallow 1 %", 0.01},
                             {"deep 10 %", 0.1}};

void add_request(const Subject& s, const Depth& depth, const std::string& what,
                 const CollideRequest& request) {
  add(s, "coarse/" + std::string(depth.name) + "/" + what,
      [&s, at = depth.depth, request](benchmark::State& state) {
        const std::vector<Pose>& poses = poses_at(s, at);
        s.body.rep().levels();
        Workspace workspace;
        const auto ask = [&](const Pose& p) -> const CollideResult& {
          return collide(s.body, {}, s.body, p, request, workspace).value();
        };
        at_all_poses(state, poses, ask);
        state.counters["pairs"] = mean(poses, [&](const Pose& p) { return ask(p).pairs.size(); });
        state.counters["known"] =
            mean(poses, [&](const Pose& p) { return ask(p).relation != Relation::unresolved; });
        state.counters["finished"] = mean(poses, [&](const Pose& p) { return ask(p).finished; });
        state.counters["error_bound"] =
            mean(poses, [&](const Pose& p) { return ask(p).error_bound / s.size; });
      });
}

void add_all(const Subject& s) {
  for (const Depth& depth : kDepths) {
    add_request(s, depth, "exact", {});
    for (const double share : {0.01, 0.02}) {
      CollideRequest request;
      request.tolerance = share * s.size;
      add_request(s, depth, "tolerance " + io::number_text(share), request);
    }
    CollideRequest request;
    request.max_tests = ~std::uint64_t{0};
    add_request(s, depth, "limits never reached", request);
  }
  for (double limit = 8; limit <= 512; limit *= 2) {
    CollideRequest request;
    request.max_time = 1e-6 * limit;
    add_request(s, kDepths[4], io::number_text(limit) + " us", request);
  }
}

}  // namespace coarse

// Coherent queries compared with queries from scratch, by step length, for bodies that are separate, touch
// and penetrate deeply.
namespace coherent {

constexpr Depth kDepths[] = {{"separate 0.5 %", -0.005}, {"touching 0.2 %", 0.002}, {"deep 10 %", 0.1}};
constexpr double kSteps[] = {0.0001, 0.0003, 0.001, 0.003, 0.01};  // of the diagonal
constexpr int kPaths = 5, kPoses = 100;

void add_all(const Subject& s) {
  for (const Depth& d : kDepths)
    for (const double step : kSteps) {
      const std::string name = std::string(d.name) + "/step " + io::number_text(100 * step) + " %/";
      add(s, "coherent/" + name + "from scratch", [&s, depth = d.depth, step](benchmark::State& state) {
        Workspace workspace;
        const auto paths = paths_from(s, depth, kPaths, step, kPoses);
        for (auto _ : state)
          for (const auto& path : paths)
            for (const Pose& p : path)
              benchmark::DoNotOptimize(collide(s.body, {}, s.body, p, {}, workspace)->pairs.size());
      })->Unit(benchmark::kMillisecond);
      add(s, "coherent/" + name + "coherent", [&s, depth = d.depth, step](benchmark::State& state) {
        const auto paths = paths_from(s, depth, kPaths, step, kPoses);
        CoherentQuery::Statistics seen;
        for (auto _ : state)
          for (const auto& path : paths) {
            CoherentQuery coherent(s.body, s.body);
            for (const Pose& p : path) benchmark::DoNotOptimize(coherent.collide({}, p).pairs.size());
            seen = coherent.statistics();
          }
        state.counters["from_cache"] = static_cast<double>(seen.from_cache);
        state.counters["caches_made"] = static_cast<double>(seen.caches_made);
        state.counters["from_scratch"] = static_cast<double>(seen.from_scratch);
      })->Unit(benchmark::kMillisecond);
    }
}

}  // namespace coherent

// Distances by gap: from scratch, only whether it is at most slightly more than the gap, and along a path of
// small steps, from scratch and coherently.
namespace distances {

constexpr double kGaps[] = {0.001, 0.01, 0.1, 1};  // of the diagonal, along the direction of approach
constexpr double kStep = 0.001;                    // of the diagonal
constexpr int kPaths = 8, kPoses = 50;

void add_distance(const Subject& s, const std::string& what, double gap, const DistanceRequest& request) {
  add(s, "distance/" + what, [&s, gap, request](benchmark::State& state) {
    const std::vector<Pose>& poses = poses_at(s, -gap);
    Workspace workspace;
    const auto ask = [&](const Pose& p) {
      return distance(s.body, {}, s.body, p, request, workspace).value();
    };
    at_all_poses(state, poses, ask);
    state.counters["steps"] = mean(poses, [&](const Pose& p) { return ask(p).counters.steps; });
    state.counters["floats"] = mean(poses, [&](const Pose& p) { return ask(p).counters.pairs_in_floats; });
    state.counters["doubles"] = mean(poses, [&](const Pose& p) { return ask(p).counters.pairs_in_doubles; });
    state.counters["exact"] = mean(poses, [&](const Pose& p) { return ask(p).counters.pairs_exact; });
  });
}

/// along(path): queries every pose of a path in order.
template <class Along>
void add_paths(const Subject& s, const std::string& what, double gap, const Along& along) {
  add(s, "distance/" + what, [&s, gap, along](benchmark::State& state) {
    const auto paths = paths_from(s, -gap, kPaths, kStep, kPoses);
    for (auto _ : state)
      for (const std::vector<Pose>& path : paths) along(path);
  })->Unit(benchmark::kMillisecond);
}

void add_all(const Subject& s) {
  for (const double gap : kGaps) {
    const std::string name = "gap " + io::number_text(100 * gap) + " %/";
    add_distance(s, name + "distance", gap, {});
    DistanceRequest within;
    within.within = 1.05 * gap * s.diagonal;
    add_distance(s, name + "within", gap, within);
    add_paths(s, name + "path from scratch", gap, [&s](const std::vector<Pose>& path) {
      Workspace workspace;
      for (const Pose& p : path)
        benchmark::DoNotOptimize(distance(s.body, {}, s.body, p, {}, workspace)->upper);
    });
    add_paths(s, name + "path coherent", gap, [&s](const std::vector<Pose>& path) {
      CoherentDistance coherent(s.body, s.body);
      for (const Pose& p : path) benchmark::DoNotOptimize(coherent.distance({}, p).upper);
    });
  }
}

}  // namespace distances

// Penetration depths of non-convex bodies: running time, and ratio of the lower bound to the upper one.
namespace clashes {

constexpr Depth kDepths[] = {{"1 %", 0.01}, {"5 %", 0.05}, {"20 %", 0.2}};

void add_all(const Subject& s) {
  for (const Depth& d : kDepths)
    add(s, std::string("clash/") + d.name, [&s, depth = d.depth](benchmark::State& state) {
      const std::vector<Pose>& poses = poses_at(s, depth, 8);
      ClashRequest request;
      request.volume = false;
      double least = 1;
      const auto tightness = [&](const Pose& p) {
        const ClashResult r = clash(s.body, {}, s.body, p, request);
        const double share = r.depth && r.depth->upper > 0 ? r.depth->lower / r.depth->upper : 1;
        least = std::min(least, share);
        return share;
      };
      at_all_poses(state, poses, tightness);
      state.counters["lower/upper"] = mean(poses, tightness);
      state.counters["least"] = least;
    })->Unit(benchmark::kMillisecond);
}

}  // namespace clashes

// Batches on one thread and on several. "independent" runs one batch per thread that share only the bodies,
// an upper bound for a batch divided among threads: compare its time per thread. CPU is the processor time of
// all threads.
namespace batches {

constexpr int kPoses = 4000;

/// Made once; threads call it at the same time.
const std::vector<Pose>& poses_of(const Subject& s) {
  static std::map<const Subject*, std::vector<Pose>> known;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  std::vector<Pose>& poses = known[&s];
  if (poses.empty()) {
    shapes::RandomEngine random(1);
    for (int i = 0; i < kPoses; ++i)
      poses.push_back(shapes::random_pose(random, s.body, s.body, shapes::uniform(random, 0.3, 1.1)));
  }
  return poses;
}

/// ask(batch, poses, answers): queries all poses.
template <class Answers, class Ask>
void add_batch(const Subject& s, const std::string& what, const Ask& ask) {
  const auto measure = [&s, ask](benchmark::State& state, unsigned threads) {
    s.body.rep().levels();
    Batch batch(threads);
    Answers answers;
    const std::vector<Pose>& poses = poses_of(s);
    for (auto _ : state) ask(batch, poses, answers);
  };
  const auto many = std::max(2u, std::thread::hardware_concurrency());
  const auto add_one = [&](const std::string& how, unsigned threads) {
    return add(s, "batch/" + what + "/" + how,
               [measure, threads](benchmark::State& state) { measure(state, threads); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MeasureProcessCPUTime();
  };
  add_one("1 thread", 1);
  add_one(std::to_string(many) + " threads", many);
  add_one("independent", 1)->Threads(static_cast<int>(many));
}

void add_all(const Subject& s) {
  CollideRequest any, contacts, coarse;
  any.mode = Mode::any_pair;
  contacts.contacts = true;
  coarse.tolerance = 0.02 * s.size;
  const auto collides = [&s](const CollideRequest& request) {
    return [&s, request](Batch& batch, const std::vector<Pose>& poses, CollideAnswers& answers) {
      batch.collide(s.body, {}, s.body, poses, request, answers);
    };
  };
  add_batch<CollideAnswers>(s, "any pair", collides(any));
  add_batch<CollideAnswers>(s, "all pairs", collides({}));
  add_batch<CollideAnswers>(s, "contacts", collides(contacts));
  add_batch<CollideAnswers>(s, "tolerance", collides(coarse));
  add_batch<CollideAnswers>(s, "pairs of bodies",
                            [&s](Batch& batch, const std::vector<Pose>& poses, CollideAnswers& answers) {
                              std::vector<PosedPair> pairs;
                              for (const Pose& p : poses)
                                pairs.push_back({&s.body.rep(), {}, &s.body.rep(), p});
                              batch.collide(pairs, {}, answers);
                            });
  add_batch<DistanceAnswers>(s, "distances",
                             [&s](Batch& batch, const std::vector<Pose>& poses, DistanceAnswers& answers) {
                               batch.distance(s.body, {}, s.body, poses, {}, answers);
                             });
}

}  // namespace batches

// The cost of a pose that is not a rotation: queries of a sphere and the body with a map in its pose,
// compared with the body with the map applied to its vertices, under a rotation.
namespace maps {

using Eigen::Matrix3d;

struct Map {
  const char* name;
  Matrix3d r;
};

std::vector<Map> maps() {
  // Rotated off the axes, like maps that are products of others.
  const Matrix3d turn = Pose::rotation({1, 2, 3}, 1).r;
  const auto diagonal = [&](double x, double y, double z) -> Matrix3d {
    return turn * Eigen::Vector3d(x, y, z).asDiagonal() * turn.transpose();
  };
  Matrix3d shear = Matrix3d::Identity();
  shear(0, 1) = 0.5;
  return {{"1", diagonal(1, 1, 1)},
          {"1.01", diagonal(1.01, 1.01, 1.01)},
          {"1.1", diagonal(1.1, 1.1, 1.1)},
          {"1.5", diagonal(1.5, 1.5, 1.5)},
          {"10", diagonal(10, 10, 10)},
          {"0.1", diagonal(0.1, 0.1, 0.1)},
          {"1, 2, 0.5", diagonal(1, 2, 0.5)},
          {"shear 0.5", shear},
          {"mirrored", diagonal(1, -1, 1)},
          {"1, 1, 0.1", diagonal(1, 1, 0.1)},
          {"1, 1, 0.01", diagonal(1, 1, 0.01)},
          {"flat (rank 2)", diagonal(1, 1, 0)}};
}

constexpr Depth kWhere[] = {
    {"deep", 0.3}, {"shallow", 0.5}, {"separate", 1.05}};  // shares as in random_pose()

void add_query(const Subject& s, const Map& map, const Depth& where, bool in_pose) {
  const std::string name =
      std::string(where.name) + "/" + map.name + (in_pose ? "/in the pose" : "/in the mesh");
  add(s, "pose/" + name, [&s, r = map.r, share = where.depth, in_pose](benchmark::State& state) {
    static const Body ball = Body::from(shapes::uv_sphere(60, 53, 0.4)).value();
    const double size = s.size;
    Mesh mesh = methods::real_mesh(s.body);
    for (Eigen::Vector3d& x : mesh.vertices) x = r * x / size;
    const LrbRep baked = LrbRep::without_regions(mesh, true, false);
    shapes::RandomEngine random(1);
    std::vector<Pose> poses(8);
    for (Pose& p : poses) {
      p = shapes::random_pose(random, ball, baked, share);
      if (in_pose) p.r = p.r * r / size;
    }
    const LrbRep& b = in_pose ? s.body.rep() : baked;
    const Pose pose_a{Pose::rotation({3, 1, 2}, 2).r, {0, 0, 0}};
    Workspace workspace;
    const auto ask = [&](const Pose& p) -> const CollideResult& {
      return collide(ball, pose_a, b, {pose_a.r * p.r, pose_a.r * p.t}, {}, workspace).value();
    };
    at_all_poses(state, poses, ask);
    state.counters["pairs"] = mean(poses, [&](const Pose& p) { return ask(p).pairs.size(); });
    state.counters["node_pairs"] = mean(poses, [&](const Pose& p) { return ask(p).counters.node_pairs; });
  });
}

void add_all(const Subject& s) {
  for (const Depth& where : kWhere)
    for (const Map& map : maps())
      for (const bool in_pose : {false, true}) add_query(s, map, where, in_pose);
}

}  // namespace maps

}  // namespace

int main(int argc, char** argv) {
  return micro::run(argc, argv, [](const Subject& s) {
    coarse::add_all(s);
    coherent::add_all(s);
    distances::add_all(s);
    clashes::add_all(s);
    batches::add_all(s);
    maps::add_all(s);
  });
}
