#include "tests/bench/sweep_motions.hpp"

#include <cmath>
#include <numbers>

#include "engine/motion/contact_search.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using shapes::RandomEngine;
using shapes::uniform;

constexpr double kPi = std::numbers::pi;
constexpr TimeSpan kNever{2, 2};

LrbRep body(const Mesh& mesh, bool closed = true) {
  return LrbRep::without_regions(mesh, closed, false);
}

Mesh sheet(double half) {
  Mesh m;
  m.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  m.add_face(std::array<VertexId, 3>{0, 1, 2});
  m.add_face(std::array<VertexId, 3>{0, 2, 3});
  return m;
}

double size_of(const LrbRep& rep) {
  return shapes::box_of(rep).diagonal().norm();
}

SweptMotion straight(const Pose& start, const Vector3d& end) {
  return {Motion::linear(start, end), true, {start, {start.r, end}}, {}};
}

/// Turns about the origin of B, which moves straight.
SweptMotion turning(const Pose& start, const Vector3d& turn, const Vector3d& way) {
  SweptMotion m{Motion::turning(start, turn, start.t, way), false, {start}, {}};
  const int pieces = 1 + static_cast<int>(turn.norm() / (0.9 * kPi));
  for (int i = 1; i <= pieces; ++i) m.stations.push_back(m.motion.at(static_cast<double>(i) / pieces));
  return m;
}

/// Past the middle of A, at up to `aside` of the bodies' size, turned by up to `turn`.
SweptMotion past(RandomEngine& random, double size, double aside, double turn) {
  const Vector3d way = shapes::random_direction(random);
  const Vector3d off = uniform(random, 0, aside) * size * shapes::random_direction(random);
  const Pose start{shapes::random_rotation(random), off - size * way};
  if (turn == 0) return straight(start, off + size * way);
  return turning(start, uniform(random, 0, turn) * shapes::random_direction(random), 2 * size * way);
}

SweptFamily meshes(const std::string& name, const std::string& what, const Mesh& mesh, int count,
                   double turn) {
  SweptFamily f{name, what, body(mesh), body(mesh), {}};
  RandomEngine random(11);
  for (int i = 0; i < count; ++i) f.motions.push_back(past(random, size_of(f.a), 0.7, turn));
  return f;
}

/// Returns the lowest corner of a body after a rotation.
Vector3d lowest_corner(const LrbRep& rep, const Matrix3d& r) {
  Vector3d lowest = r * rep.vertices()[0];
  for (const Vector3d& v : rep.vertices())
    if ((r * v).z() < lowest.z()) lowest = r * v;
  return lowest;
}

/// B falls on A's top, z = top, with a corner ahead, at `speed` of the bodies' size a motion, or aside of it.
SweptMotion fall(RandomEngine& random, const SweptFamily& f, double top, double half, double speed) {
  Pose start;
  start.r = shapes::random_rotation(random);
  const Vector3d corner = lowest_corner(f.b, start.r);
  const double height = speed * uniform(random, 0.1, 0.9);
  const bool aside = random() % 4 == 0;
  start.t = Vector3d(uniform(random, -half, half), uniform(random, -half, half), top + height) - corner;
  if (aside) start.t.x() += 2 * half + 2 * size_of(f.b);
  SweptMotion m = straight(start, start.t - Vector3d(0, 0, speed));
  const double time = height / speed;
  m.known = aside ? kNever : TimeSpan{time * (1 - 1e-12), time * (1 + 1e-12)};
  return m;
}

SweptFamily boxes(int count) {
  SweptFamily f{"boxes",
                "corner on face, or past it",
                body(shapes::box({-1, -1, -1}, {1, 1, 1})),
                body(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})),
                {}};
  RandomEngine random(12);
  for (int i = 0; i < count; ++i) f.motions.push_back(fall(random, f, 1, 0.1, 4));
  return f;
}

SweptFamily sheets(int count) {
  SweptFamily f{"sheets",
                "two triangles each, at 10 to 10,000 times their size a motion",
                body(sheet(1), false),
                body(sheet(0.5), false),
                {}};
  RandomEngine random(13);
  for (int i = 0; i < count; ++i)
    f.motions.push_back(fall(random, f, 0, 0.1, std::pow(10, uniform(random, 1, 4))));
  return f;
}

SweptFamily balls(int count) {
  const Mesh ball = shapes::icosphere(4);
  const double inner = 0.998;  // all points of the mesh are further than this from the middle
  SweptFamily f{"balls", "5,120 faces, towards each other and turning", body(ball), body(ball), {}};
  RandomEngine random(14);
  for (int i = 0; i < count; ++i) {
    const Vector3d d = shapes::random_direction(random);
    SweptMotion m = turning({shapes::random_rotation(random), 6 * d},
                            uniform(random, 0, 2.8) * shapes::random_direction(random), -12 * d);
    m.known = TimeSpan{4.0 / 12, (6 - 2 * inner) / 12};
    f.motions.push_back(std::move(m));
  }
  return f;
}

/// A blade that goes round, and meets the knife, none of which is lower, at y = height, or stays beside it.
SweptFamily spins(int count) {
  SweptFamily f{"spins",
                "a blade of 1 to 1000 turns a motion, and a knife",
                body(shapes::translated(shapes::tetrahedron(0.5), {0.5, 0.5, 0})),
                body(shapes::box({0, -0.25, -1}, {1, 0, 1})),
                {}};
  RandomEngine random(15);
  for (int i = 0; i < count; ++i) {
    const double turns = std::pow(10, uniform(random, 0, 3));
    // From some angle below the x axis: the blade's end comes to y = 0.5 after that angle and a sixth of pi.
    const double below = uniform(random, 0, 0.9 * kPi);
    const bool beside = i % 4 == 3;
    Pose start;
    start.r = steady::rotation(Vector3d::UnitZ(), -below);
    if (beside) start.t = Vector3d(-0.6, -0.6, 0);
    SweptMotion m = turning(start, {0, 0, 2 * kPi * turns}, {0, 0, 0});
    const double time = (below + kPi / 6) / (2 * kPi * turns);
    m.known = beside ? kNever : TimeSpan{time * (1 - 1e-12), time * (1 + 1e-12)};
    f.motions.push_back(std::move(m));
  }
  return f;
}

/// Past A's side by 10^-6 to 10^-2 of its size, or deeper than that by as much.
SweptFamily grazes(int count) {
  SweptFamily f{"grazes",
                "bumpy bodies, past each other by 1e-6 to 1e-2 of their size, or as much too near",
                body(shapes::bumpy_sphere(3, 7, 0.3)),
                body(shapes::bumpy_sphere(3, 8, 0.3)),
                {}};
  RandomEngine random(16);
  FirstContactContext context;
  const double size = 2 * size_of(f.a);
  for (int i = 0; i < count; ++i) {
    const Vector3d way = shapes::random_direction(random);
    const Vector3d aside = shapes::random_direction(random).cross(way).normalized();
    const Matrix3d r = shapes::random_rotation(random);
    const auto beside = [&](double x) {
      return straight({r, x * aside - size * way}, x * aside + size * way);
    };
    double hits = 0, misses = size;
    for (int k = 0; k < 30; ++k) {
      const double x = (hits + misses) / 2;
      const FirstContactResult found =
          first_contact(f.a, Motion::still({}), f.b, beside(x).motion, {}, context);
      (found.outcome == MotionOutcome::never ? misses : hits) = x;
    }
    const double off = std::pow(10, uniform(random, -6, -2)) * size;
    f.motions.push_back(beside(misses + (i % 2 == 0 ? off : -off)));
  }
  return f;
}

}  // namespace

std::vector<SweptFamily> swept_families(int count, const std::string& mesh) {
  std::vector<SweptFamily> list;
  if (!mesh.empty()) {
    const Mesh m = read_mesh(mesh);
    const std::string faces = std::to_string(m.face_count()) + " faces";
    list.push_back(meshes("mesh, straight", faces + ", past itself", m, count, 0));
    list.push_back(
        meshes("mesh, turning", faces + ", past itself, turning by up to 160 degrees", m, count, 2.8));
  }
  list.push_back(boxes(count));
  list.push_back(sheets(count));
  list.push_back(balls(count));
  list.push_back(spins(count));
  list.push_back(grazes(count));
  return list;
}

}  // namespace lrb::bench
