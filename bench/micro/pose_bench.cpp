// The cost of a pose that is not a rotation: queries of a sphere and the body with a map in its pose,
// compared with the body with the map applied to its vertices, under a rotation.
#include <memory>

#include "bench/methods/triangles.hpp"
#include "bench/micro/poses.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/workspace.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

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
  add(s, name, [&s, r = map.r, share = where.depth, in_pose](benchmark::State& state) {
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

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}
