#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

#include "engine/core/random.hpp"
#include "engine/core/steady_math.hpp"
#include "scenarios/bodies/generators/bodies.hpp"

namespace lrb::generators {
namespace {

/// Cuts the edges of an icosahedron into `frequency` parts and puts the vertices at radius(direction): a
/// star-shaped surface for any positive radius, so that it cannot meet itself.
class StarSurface {
 public:
  StarSurface(int frequency, const std::function<double(const Eigen::Vector3d&)>& radius)
      : n_(frequency), radius_(radius) {
    const double g = std::numbers::phi;
    const double corner[12][3] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    const int face[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                             {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                             {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                             {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const auto& f : face) add_face(corner[f[0]], corner[f[1]], corner[f[2]]);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  void add_face(const double a[3], const double b[3], const double c[3]) {
    const Eigen::Vector3d p(a[0], a[1], a[2]), q(b[0], b[1], b[2]), r(c[0], c[1], c[2]);
    const auto id = [&](int i, int j) {  // i steps towards q, j towards r
      return vertex(((n_ - i - j) * p + i * q + j * r) / n_);
    };
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; i + j < n_; ++j) {
        // Called one after the other, because id() numbers new vertices and compilers evaluate arguments in
        // different orders.
        const VertexId up = id(i, j + 1), along = id(i + 1, j), here = id(i, j);
        add_triangle(mesh_, here, along, up);
        if (i + j + 1 >= n_) continue;
        const VertexId across = id(i + 1, j + 1);
        add_triangle(mesh_, along, across, up);
      }
    }
  }

  /// Returns a vertex on an edge, which faces share; finds it again by its place on the icosahedron, rounded.
  VertexId vertex(const Eigen::Vector3d& on_icosahedron) {
    constexpr double kGrid = 1 << 24;  // far finer than the distance of two vertices, far coarser than
                                       // rounding
    const auto key = [&](int i) { return std::llround(on_icosahedron[i] * kGrid); };
    const auto [it, is_new] =
        ids_.try_emplace({key(0), key(1), key(2)}, static_cast<VertexId>(mesh_.vertices.size()));
    if (is_new) {
      const Eigen::Vector3d direction = on_icosahedron.normalized();
      mesh_.vertices.push_back(radius_(direction) * direction);
    }
    return it->second;
  }

  int n_;
  const std::function<double(const Eigen::Vector3d&)>& radius_;
  Mesh mesh_;
  std::map<std::array<long long, 3>, VertexId> ids_;
};

struct Wave {
  Eigen::Vector3d direction;
  double phase, height;
};

struct Crater {
  Eigen::Vector3d direction;
  double cos_rim, depth;
};

Eigen::Vector3d random_direction(Random& random) {
  const double z = random.in(-1, 1), angle = random.in(0, 2 * std::numbers::pi), s = std::sqrt(1 - z * z);
  return {s * steady::cos(angle), s * steady::sin(angle), z};
}

/// Returns the height of a crater's profile at the cosine of the angle from its middle: a bowl inside a soft
/// raised rim.
double crater_height(const Crater& c, double cosine) {
  const double t =
      (1 - cosine) / (1 - c.cos_rim);  // 0 in the middle, 1 on the rim, about the square of the angle
  if (t >= 2) return 0;
  const double rim = 0.25 * c.depth * steady::exp(-8 * (t - 1) * (t - 1));
  return rim - (t < 1 ? c.depth * (1 - t) * (1 - t) * (1 + 2 * t) : 0);
}

}  // namespace

Mesh rock(const GeneratorValues& v, std::uint64_t seed) {
  Random random(seed);
  const double bumps = v.at("bumps");
  std::vector<Wave> waves;
  double height = bumps;
  for (int octave = 0; octave < 4; ++octave) {
    const double frequency = 1.7 * std::exp2(octave);
    for (int i = 0; i < 6; ++i)
      waves.push_back({random_direction(random) * frequency, random.in(0, 2 * std::numbers::pi), height / 3});
    height *= 0.45;
  }
  std::vector<Crater> craters;
  for (int i = 0; i < static_cast<int>(v.at("craters")); ++i) {
    const double angle = random.in(0.15, 0.5);
    craters.push_back({random_direction(random), steady::cos(angle), 0.28 * angle});
  }
  const double radius = v.at("radius");
  const std::function<double(const Eigen::Vector3d&)> at = [&](const Eigen::Vector3d& d) {
    double r = 1;
    for (const Wave& w : waves) r += w.height * steady::cos(w.direction.dot(d) + w.phase);
    for (const Crater& c : craters) r += crater_height(c, c.direction.dot(d));
    return radius * std::max(r, 0.2);
  };
  return StarSurface(static_cast<int>(v.at("frequency")), at).take();
}

Mesh ball(const GeneratorValues& v, std::uint64_t) {
  const double radius = v.at("radius");
  const std::function<double(const Eigen::Vector3d&)> at = [&](const Eigen::Vector3d&) { return radius; };
  return StarSurface(static_cast<int>(v.at("frequency")), at).take();
}

}  // namespace lrb::generators
