// resting SCENE STEPS [FOLDER]: a solver on top of lrb::contact_manifolds(). SCENE: box (at rest on 20,604
// faces), ring (falls over a peg) or gears (A drives B). Writes a.obj, b.obj and poses of B relative to A to
// FOLDER. Sequential impulses with warm starting: Catto, "Iterative Dynamics with Temporal Coherence", 2005.
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include <lrbscope/body.hpp>
#include <lrbscope/workspace.hpp>

using Eigen::Vector3d;
using lrb::Body, lrb::Mesh, lrb::Pose;
constexpr double kStep = 1.0 / 240, kMargin = 0.02, kSlop = 0.001, kPush = 0.2, kFriction = 0.5;
constexpr double kTurn = 2 * std::numbers::pi;
/// A surface of n rows of m vertices: closed to a ring, or with a fan at both ends.
Mesh surface(int m, int n, bool is_ring, const auto& at) {
  Mesh mesh;
  const auto id = [&](int i, int j) { return lrb::VertexId((j % n) * m + i % m); };
  const auto add = [&](std::initializer_list<lrb::VertexId> f) { mesh.add_face({f.begin(), f.size()}); };
  for (int k = 0; k < m * n; ++k) mesh.vertices.push_back(at(k % m, k / m));
  for (int j = 0; j < n - !is_ring; ++j)
    for (int i = 0; i < m; ++i) {
      add({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      add({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  for (int end = 0; !is_ring && end < 2; ++end) {
    const lrb::VertexId centre(mesh.vertices.size());
    mesh.vertices.push_back(Vector3d::Zero());
    for (int i = 0, j = end * (n - 1); i < m; ++i) {
      mesh.vertices[centre] += mesh.vertices[id(i, j)] / m;
      end == 0 ? add({centre, id(i + 1, j), id(i, j)}) : add({centre, id(i, j), id(i + 1, j)});
    }
  }
  return mesh;
}

Vector3d around(double radius, double turn, double z) {
  return {radius * std::cos(kTurn * turn), radius * std::sin(kTurn * turn), z};
}

/// A profile (radius, height) that runs counter-clockwise, revolved about z.
Mesh revolved(const std::vector<Eigen::Vector2d>& profile, int slices) {
  return surface(slices, static_cast<int>(profile.size()), true,
                 [&](int i, int j) { return around(profile[j].x(), 1.0 * i / slices, profile[j].y()); });
}

Mesh gear(int teeth) {
  return surface(4 * teeth, 2, false, [=](int i, int j) {
    const double side[] = {0.14, 0.42, 0.58, 0.86};  // of a tooth: root, tip, tip, root
    return around(0.1 * teeth + (i % 4 % 3 == 0 ? -0.13 : 0.1), (i / 4 + side[i % 4]) / teeth, 0.2 * j);
  });
}

/// Hills of 100 rows of 102 x 2 triangles on a round plate; the last row is below its rim.
Mesh hills() {
  return surface(102, 101, false, [](int i, int j) {
    const Vector3d p = around(j == 0 ? 3 : 0.03 * (101 - j), i / 102.0, j == 0 ? -0.5 : 0);
    return Vector3d(p.x(), p.y(), p.z() + (j > 1 ? 0.04 * std::sin(7 * p.x()) * std::cos(5 * p.y()) : 0));
  });
}

struct Moving {                                         // B; A only turns about z
  Vector3d x, inverse_inertia, v{0, 0, 0}, w{0, 0, 0};  // inverse_inertia: in B's frame
  Eigen::Quaterniond q{1, 0, 0, 0};
  double inverse_mass = 1;
};

int main(int argc, char** argv) try {
  const std::string scene = argc < 3 ? "" : argv[1];
  if (scene != "box" && scene != "ring" && scene != "gears")
    throw lrb::InputError("usage: resting box|ring|gears STEPS [FOLDER]");
  const int steps = std::atoi(argv[2]);
  Mesh mesh[2];
  Moving b;
  double turning = 0, drift = 0, deepest = 0, turned = 0;  // turning: of A, radians per second
  if (scene == "box") {
    mesh[0] = hills();
    mesh[1] = surface(4, 2, false, [&](int i, int j) { return around(std::sqrt(0.5), i / 4.0, j - 0.5); });
    b = {.x = {0.3, 0.2, 0.7}, .inverse_inertia = {6, 6, 6}};
  } else if (scene == "ring") {
    mesh[0] = revolved({{0.05, -0.2}, {1.2, -0.2}, {1.2, 0}, {0.3, 0}, {0.25, 1}, {0.05, 1}}, 48);
    mesh[1] = revolved({{0.4, -0.1}, {0.7, -0.1}, {0.7, 0.1}, {0.4, 0.1}}, 48);
    b = {.x = {0.1, 0.05, 1.3}, .inverse_inertia = {6, 6, 3}, .q = {60.0 / 61, 11.0 / 61, 0, 0}};
  } else {
    mesh[0] = gear(12), mesh[1] = gear(18), turning = 1;
    b = {.x = {3.01, 0, 0}, .inverse_inertia = {0, 0, 1}, .inverse_mass = 0};
    b.q = Eigen::AngleAxisd(kTurn / 36, Vector3d::UnitZ());
  }
  const Body of_a = Body::from(mesh[0]).value(), of_b = Body::from(mesh[1]).value();
  const std::string folder = argc > 3 ? std::string(argv[3]) + "/" : "";
  for (int i = 0; argc > 3 && i < 2; ++i) lrb::write_mesh(mesh[i], folder + "ab"[i] + ".obj");
  std::ofstream poses(argc > 3 ? folder + "poses.txt" : "");
  lrb::Workspace workspace;
  const lrb::ManifoldResult* now = nullptr;
  std::map<std::uint64_t, std::array<double, 3>> impulses;  // by point id: along the normal, across it
  Moving rested = b;
  for (int step = 0; step < steps; ++step) {
    const Pose pose_a = Pose::rotation({0, 0, 1}, kStep * step * turning);
    const Pose pose_b = lrb::pose_of(b.q, b.x);
    now = &lrb::contact_manifolds(of_a, pose_a, of_b, pose_b, {.margin = kMargin}, workspace, now).value();
    if (step % 8 == 0) {
      const Eigen::Matrix3d r = pose_a.r.transpose() * pose_b.r;
      for (int k = 0; k < 3; ++k)
        poses << r.row(k) << " " << pose_a.r.col(k).dot(pose_b.t) << (k < 2 ? " " : "\n");
    }
    b.v.z() -= kStep * 9.81 * b.inverse_mass;
    if (turning != 0) b.w *= 1 - kStep;  // a load
    const Eigen::Matrix3d inertia = pose_b.r * b.inverse_inertia.asDiagonal() * pose_b.r.transpose();
    auto before = std::exchange(impulses, {});
    for (int round = 0; round < 30; ++round)
      for (const lrb::ContactManifold& m : now->manifolds)
        for (const lrb::ManifoldPoint& p : m.points) {
          std::array<double, 3>& sum = impulses[p.id];
          const Vector3d arm = p.point[1] - b.x, along = m.normal.unitOrthogonal();
          const Vector3d axes[] = {m.normal, along, m.normal.cross(along)};
          for (const int k : {1, 2, 0}) {  // friction, then the normal
            const Vector3d lever = arm.cross(axes[k]);
            const double mass = b.inverse_mass + lever.dot(inertia * lever);
            if (!(mass > 1e-12)) continue;
            double speed = axes[k].dot(b.v + b.w.cross(arm) - turning * Vector3d::UnitZ().cross(p.point[0]));
            // A gap may close within the step; a depth beyond the slop opens by a fraction of it.
            if (k == 0) speed -= (p.depth < 0 ? p.depth : kPush * std::max(0.0, p.depth - kSlop)) / kStep;
            const double old = sum[k], limit = kFriction * sum[0];
            sum[k] = old - speed / mass;
            sum[k] = k == 0 ? std::max(0.0, sum[k]) : std::clamp(sum[k], -limit, limit);
            if (round == 0) sum[k] = before[p.id][k];  // warm start
            b.v += (sum[k] - old) * b.inverse_mass * axes[k];
            b.w += (sum[k] - old) * (inertia * lever);
          }
        }
    b.x += kStep * b.v;
    b.q = (Eigen::AngleAxisd(kStep * b.w.norm(), b.w.stableNormalized()) * b.q).normalized();
    turned += kStep * b.w.z();
    for (const lrb::ContactManifold& m : now->manifolds) deepest = std::max(deepest, m.points[0].depth);
    if (step <= steps / 10) rested = b;
    drift = std::max(drift, (b.x - rested.x).norm() + b.q.angularDistance(rested.q));
  }
  std::cout << of_a.rep().real_face_count() << " faces, " << steps << " steps, " << now->manifolds.size()
            << " manifolds\ndepth at most " << deepest << "\ndrift " << drift << " since step " << steps / 10
            << "\nB turns at " << turned / (kStep * steps) << " rad/s on average\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
