// What a body's pose costs when it is no rotation: the query of spot (or what is named) and a sphere, with a
// map in the pose, as a ratio to the query of the mesh that has the map in its vertices, under a rotation.
//   pose_bench [MESH]      MESH: [spot.obj of the shared meshes]; without one a bumpy sphere takes its place
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;

namespace {

using Eigen::Matrix3d;

struct Map {
  const char* name;
  Matrix3d r;
};

std::vector<Map> maps() {
  // Turned off the axes, as maps are that somebody composed.
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

struct Query {
  const LrbRep *a, *b;
  Pose pose_a, pose_b;
  QueryContext* context;

  CollideResult ask() const {
    NullProbe probe;
    return collide(*a, pose_a, *b, pose_b, CollideRequest{}, *context, probe);
  }
  double seconds(int times) const {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < times; ++i) ask();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / times;
  }
};

struct Sums {
  double seconds[2] = {}, node_pairs[2] = {};
  std::size_t pairs = 0;
};

/// Both queries in turn; of each the best of some rounds.
void compare(const Query& mapped, const Query& baked, Sums& sums) {
  constexpr int kRounds = 12;
  const CollideResult of_mapped = mapped.ask(), of_baked = baked.ask();
  sums.node_pairs[0] += static_cast<double>(of_baked.counters.node_pairs);
  sums.node_pairs[1] += static_cast<double>(of_mapped.counters.node_pairs);
  sums.pairs += of_mapped.pairs.size();
  const int times = of_baked.counters.node_pairs > 200 ? 1 : 20;
  double best[2] = {1e9, 1e9};
  for (int i = 0; i < kRounds; ++i) {
    best[0] = std::min(best[0], baked.seconds(times));
    best[1] = std::min(best[1], mapped.seconds(times));
  }
  for (int k = 0; k < 2; ++k) sums.seconds[k] += best[k];
}

/// Queries of the mesh under the map against those of the mesh made by it.
Sums measure(const Mesh& mesh, const Mesh& other, const Matrix3d& map, double share) {
  constexpr int kPoses = 8;
  Mesh made = mesh;
  for (auto& x : made.vertices) x = map * x;
  const LrbRep a = build_lrb(other), b = build_lrb(mesh), baked = LrbRep::without_regions(made, true, false);
  QueryContext contexts[2];
  shapes::RandomEngine random(1);
  Sums sums;
  for (int i = 0; i < kPoses; ++i) {
    const Matrix3d turn = shapes::random_rotation(random);
    const Pose p = shapes::random_pose(random, a, baked, share);
    const Pose pose_a{turn, {0, 0, 0}}, pose_b{turn * p.r, turn * p.t};
    compare({&a, &b, pose_a, {pose_b.r * map, pose_b.t}, &contexts[0]},
            {&a, &baked, pose_a, pose_b, &contexts[1]}, sums);
  }
  return sums;
}

int run(int argc, char** argv) {
  const auto spot = test::shared_meshes() / "spot.obj";
  Mesh mesh = shapes::bumpy_sphere(4, 1);
  std::string name = "bumpy sphere";
  if (argc > 1 || std::filesystem::exists(spot)) {
    name = argc > 1 ? argv[1] : "spot.obj";
    mesh = read_mesh(argc > 1 ? std::string(argv[1]) : spot.string());
  }
  const Mesh ball = shapes::uv_sphere(60, 53, 0.8);
  std::printf(
      "%s (%zu faces) under a map, and a sphere (%zu faces); ratios to the mapped mesh under a rotation\n",
      name.c_str(), mesh.face_count(), ball.face_count());
  std::printf("| map            | where   | pairs  | mesh us  | pose us  | ratio | node pairs |\n");
  struct Where {
    const char* name;
    double share;
  };
  for (const Where& where : {Where{"deep", 0.3}, Where{"shallow", 0.5}, Where{"apart", 1.05}})
    for (const Map& map : maps()) {
      const Sums s = measure(mesh, ball, map.r, where.share);
      std::printf("| %-14s | %-7s | %6zu | %8.2f | %8.2f | %5.2f | %10.2f |\n", map.name, where.name, s.pairs,
                  1e6 * s.seconds[0] / 8, 1e6 * s.seconds[1] / 8, s.seconds[1] / s.seconds[0],
                  s.node_pairs[1] / s.node_pairs[0]);
    }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pose_bench: %s\n", error.what());
    return 2;
  }
}
