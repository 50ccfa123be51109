#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <Eigen/Geometry>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::generators {
namespace {

/// Returns the distance of a gear's outline from its axis, at a fraction of a tooth's pitch: steep flanks,
/// flat tops and feet.
double tooth_radius(double pitch_fraction, double depth) {
  const double s = deterministic::cos(2 * std::numbers::pi * pitch_fraction);
  return 1 + 0.5 * depth * std::clamp(2.2 * s, -1.0, 1.0);
}

std::vector<Eigen::Vector2d> outline(const GeneratorValues& v) {
  const int teeth = static_cast<int>(v.at("teeth")), points = static_cast<int>(v.at("points"));
  std::vector<Eigen::Vector2d> out;
  for (int i = 0; i < teeth * points; ++i) {
    const double angle = 2 * std::numbers::pi * i / (teeth * points);
    const double r = v.at("radius") * tooth_radius((i % points + 0.5) / points, v.at("depth"));
    out.emplace_back(r * deterministic::cos(angle), r * deterministic::sin(angle));
  }
  return out;
}

}  // namespace

/// Makes a tube of rectangular section around the axis: a loop of rings (bore, top, teeth, bottom), each with
/// one point for each point of the outline. It is star-shaped seen from the axis, and therefore free of
/// self-intersections.
Mesh gear(const GeneratorValues& v, std::uint64_t) {
  const std::vector<Eigen::Vector2d> teeth = outline(v);
  const int n = static_cast<int>(teeth.size()), rings = static_cast<int>(v.at("rings"));
  const double bore = v.at("bore") * v.at("radius"), half = v.at("thickness") * v.at("radius") / 2;
  const int deep = std::max(1, rings / 2);  // rows of faces across the thickness

  std::vector<std::pair<double, double>> loop;  // (fraction from bore to teeth, height)
  for (int i = 0; i < rings; ++i) loop.emplace_back(1.0 * i / rings, -half);
  for (int i = 0; i < deep; ++i) loop.emplace_back(1, -half + 2 * half * i / deep);
  for (int i = 0; i < rings; ++i) loop.emplace_back(1 - 1.0 * i / rings, half);
  for (int i = 0; i < deep; ++i) loop.emplace_back(0, half - 2 * half * i / deep);

  Mesh mesh;
  for (const auto& [out, z] : loop) {
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector2d inner = bore * teeth[i].normalized();
      const Eigen::Vector2d p = inner + out * (teeth[i] - inner);
      mesh.vertices.emplace_back(p.x(), p.y(), z);
    }
  }
  const int rows = static_cast<int>(loop.size());
  const auto id = [&](int row, int i) { return static_cast<VertexId>((row % rows) * n + i % n); };
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < n; ++i) {
      add_triangle(mesh, id(row, i), id(row, i + 1), id(row + 1, i + 1));
      add_triangle(mesh, id(row, i), id(row + 1, i + 1), id(row + 1, i));
    }
  }
  return mesh;
}

Mesh cog2d(const GeneratorValues& v, std::uint64_t) {
  return shapes::polygon(outline(v));
}

namespace {

/// Adds a bay to each edge, in its middle third, as in an inverted Koch curve. The bay's apex is displaced
/// slightly, so that no two bays are equal. Depths below a third of an edge keep bays within the triangle of
/// their edge.
std::vector<Eigen::Vector2d> with_bays(const std::vector<Eigen::Vector2d>& outline, double depth,
                                       Random& random) {
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i], b = outline[(i + 1) % outline.size()], along = b - a;
    const Eigen::Vector2d inward(-along.y(), along.x());  // the solid is on the left
    out.push_back(a);
    out.push_back(a + along * random.in(0.30, 0.38));
    // In separate statements, because compilers evaluate operands in different orders.
    const double reach = random.in(0.7, 1.0), mid_share = random.in(0.44, 0.56);
    out.push_back(a + along * mid_share + inward * depth * reach);
    out.push_back(a + along * random.in(0.62, 0.70));
  }
  return out;
}

}  // namespace

Mesh island(const GeneratorValues& v, std::uint64_t seed) {
  Random random(seed);
  // The coarse outline: wide capes and one deep gulf, so that it is not convex even before detail is added.
  const double cape[][2] = {
      {1.00, 0.04}, {0.93, 0.10}, {0.98, 0.24}, {0.90, 0.37}, {0.38, 0.47},
      {0.95, 0.58}, {1.00, 0.70}, {0.45, 0.80}, {1.00, 0.91}};  // radius, share of a full turn
  std::vector<Eigen::Vector2d> outline;
  for (const auto& c : cape) {
    const double angle = 2 * std::numbers::pi * c[1];
    outline.emplace_back(v.at("radius") * c[0] * deterministic::cos(angle),
                         v.at("radius") * c[0] * deterministic::sin(angle));
  }
  for (int level = 0; level < static_cast<int>(v.at("levels")); ++level)
    outline = with_bays(outline, v.at("depth"), random);
  return shapes::polygon(outline);
}

namespace {

/// The centre line of a torus knot, by t in [0, 1).
struct KnotLine {
  double p, q, radius, swing;
  Eigen::Vector3d operator()(double t) const {
    const double u = 2 * std::numbers::pi * t;
    const double r = radius * (1 + swing * deterministic::cos(q * u));
    return {r * deterministic::cos(p * u), r * deterministic::sin(p * u),
            radius * swing * deterministic::sin(q * u)};
  }
};

}  // namespace

Mesh knot(const GeneratorValues& v, std::uint64_t) {
  const KnotLine line{v.at("p"), v.at("q"), v.at("radius"), v.at("swing")};
  const int n = static_cast<int>(v.at("segments")), sides = static_cast<int>(v.at("sides"));
  const double tube = v.at("tube") * line.radius;

  // Frames are transported without twist, then rotated evenly so that the last equals the first.
  std::vector<Eigen::Vector3d> tangent(n), side(n + 1);
  for (int i = 0; i < n; ++i) tangent[i] = (line((i + 0.5) / n) - line((i - 0.5) / n)).normalized();
  side[0] = tangent[0].unitOrthogonal();
  for (int i = 0; i < n; ++i)
    side[i + 1] = deterministic::turn_between(tangent[i], tangent[(i + 1) % n]) * side[i];
  const double gap = deterministic::atan2(side[n].cross(side[0]).dot(tangent[0]), side[n].dot(side[0]));

  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d s = deterministic::rotation(tangent[i], gap * i / n) * side[i];
    const Eigen::Vector3d w = tangent[i].cross(s);
    for (int j = 0; j < sides; ++j) {
      const double angle = 2 * std::numbers::pi * j / sides;
      mesh.vertices.push_back(line(static_cast<double>(i) / n) +
                              tube * (deterministic::cos(angle) * s + deterministic::sin(angle) * w));
    }
  }
  const auto id = [&](int i, int j) { return static_cast<VertexId>((i % n) * sides + j % sides); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < sides; ++j) {
      add_triangle(mesh, id(i, j), id(i + 1, j + 1), id(i + 1, j));
      add_triangle(mesh, id(i, j), id(i, j + 1), id(i + 1, j + 1));
    }
  }
  return mesh;
}

namespace {

/// A profile in the half-plane (distance from the axis, height), from a point on the axis to another one.
using Profile = std::vector<Eigen::Vector2d>;

/// Adds `rows` even steps from the profile's end to a point.
void line_to(Profile& profile, const Eigen::Vector2d& end, int rows) {
  const Eigen::Vector2d begin = profile.back();
  for (int i = 1; i <= rows; ++i) profile.push_back(begin + (end - begin) * i / rows);
}

/// Adds `rows` even steps on a circle around (0, height), between two angles from the axis pointing down.
void arc(Profile& profile, double radius, double height, double from, double to, int rows) {
  for (int i = profile.empty() ? 0 : 1; i <= rows; ++i) {
    const double angle = from + (to - from) * i / rows;
    profile.emplace_back(radius * deterministic::sin(angle), height - radius * deterministic::cos(angle));
  }
}

/// Rotates a profile around the z axis. The solid is on the left of the profile's direction, seen with the
/// axis on the left and z up; the first and the last point are put on the axis.
Mesh lathe(const Profile& profile, int segments) {
  Mesh mesh;
  const int rows = static_cast<int>(profile.size());
  mesh.vertices.emplace_back(0, 0, profile.front().y());
  for (int row = 1; row + 1 < rows; ++row) {
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (row % 2)) / segments;
      mesh.vertices.emplace_back(profile[row].x() * deterministic::cos(angle),
                                 profile[row].x() * deterministic::sin(angle), profile[row].y());
    }
  }
  mesh.vertices.emplace_back(0, 0, profile.back().y());
  const auto id = [&](int row, int i) {
    return static_cast<VertexId>(1 + (row - 1) * segments + i % segments);
  };
  const auto last = static_cast<VertexId>(mesh.vertices.size() - 1);
  for (int i = 0; i < segments; ++i) add_triangle(mesh, 0, id(1, i + 1), id(1, i));
  for (int row = 1; row + 2 < rows; ++row) {
    const int odd = row % 2;  // every other ring is rotated by half a segment
    for (int i = 0; i < segments; ++i) {
      const VertexId a = id(row, i), b = id(row, i + 1), c = id(row + 1, i + odd), d = id(row + 1, i + 1);
      if (odd) {
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, a, c, id(row + 1, i));
      } else {
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, b, d, c);
      }
    }
  }
  for (int i = 0; i < segments; ++i) add_triangle(mesh, last, id(rows - 2, i), id(rows - 2, i + 1));
  return mesh;
}

constexpr double kQuarter = std::numbers::pi / 2;

}  // namespace

Mesh bowl(const GeneratorValues& v, std::uint64_t) {
  const double radius = v.at("radius"), inner = radius * (1 - v.at("wall"));
  const int rows = static_cast<int>(v.at("rows"));
  Profile profile;
  arc(profile, radius, 0, 0, kQuarter, rows);
  line_to(profile, {inner, 0}, 2);
  arc(profile, inner, 0, kQuarter, 0, rows);
  return lathe(profile, static_cast<int>(v.at("segments")));
}

Mesh stick(const GeneratorValues& v, std::uint64_t) {
  const double radius = v.at("radius"), half = std::max(v.at("length") / 2 - radius, 0.1 * radius);
  constexpr int kDomeRows = 4;
  Profile profile;
  arc(profile, radius, -half, 0, kQuarter, kDomeRows);
  line_to(profile, {radius, half}, static_cast<int>(v.at("rows")));
  arc(profile, radius, half, kQuarter, 2 * kQuarter, kDomeRows);
  return lathe(profile, static_cast<int>(v.at("segments")));
}

Mesh pot(const GeneratorValues& v, std::uint64_t) {
  const double r = v.at("radius"), half = v.at("height") * r / 2, wall = v.at("wall") * r,
               mouth = v.at("mouth") * r;
  const int rows = static_cast<int>(v.at("rows"));
  Profile profile = {{0, -half}};
  line_to(profile, {r, -half}, rows);
  line_to(profile, {r, half}, rows);
  line_to(profile, {mouth, half}, rows);
  line_to(profile, {mouth, half - wall}, 2);
  line_to(profile, {r - wall, half - wall}, rows);
  line_to(profile, {r - wall, wall - half}, rows);
  line_to(profile, {0, wall - half}, rows);
  return lathe(profile, static_cast<int>(v.at("segments")));
}

namespace {

/// Subdivides the edges of an icosahedron into `frequency` parts and puts the vertices at radius(direction):
/// star-shaped for any positive radius, and therefore free of self-intersections.
class StarSurface {
 public:
  StarSurface(int frequency, const std::function<double(const Eigen::Vector3d&)>& radius)
      : n_(frequency), radius_(radius) {
    const Mesh solid = shapes::icosahedron();
    for (FaceId f = 0; f < solid.face_count(); ++f) {
      const auto corner = [&](int i) { return solid.vertices[solid.face(f)[i]]; };
      add_face(corner(0), corner(1), corner(2));
    }
  }
  Mesh take() { return std::move(mesh_); }

 private:
  void add_face(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
    const auto id = [&](int i, int j) {  // i steps towards q, j towards r
      return vertex(((n_ - i - j) * p + i * q + j * r) / n_);
    };
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; i + j < n_; ++j) {
        // In separate statements, because id() numbers new vertices and compilers evaluate arguments in
        // different orders.
        const VertexId up = id(i, j + 1), along = id(i + 1, j), current = id(i, j);
        add_triangle(mesh_, current, along, up);
        if (i + j + 1 >= n_) continue;
        const VertexId across = id(i + 1, j + 1);
        add_triangle(mesh_, along, across, up);
      }
    }
  }

  /// Returns a vertex on an edge shared by faces, identified by its rounded position on the icosahedron.
  VertexId vertex(const Eigen::Vector3d& on_icosahedron) {
    // Far finer than the distance of two vertices, far coarser than rounding.
    constexpr double kGrid = 1 << 24;
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
  return {s * deterministic::cos(angle), s * deterministic::sin(angle), z};
}

/// Returns the height of a crater's profile at the cosine of the angle from its centre: a bowl inside a soft
/// raised rim.
double crater_height(const Crater& c, double cosine) {
  const double t =
      (1 - cosine) / (1 - c.cos_rim);  // 0 at the centre, 1 on the rim, about the square of the angle
  if (t >= 2) return 0;
  const double rim = 0.25 * c.depth * deterministic::exp(-8 * (t - 1) * (t - 1));
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
    craters.push_back({random_direction(random), deterministic::cos(angle), 0.28 * angle});
  }
  const double radius = v.at("radius");
  const std::function<double(const Eigen::Vector3d&)> at = [&](const Eigen::Vector3d& d) {
    double r = 1;
    for (const Wave& w : waves) r += w.height * deterministic::cos(w.direction.dot(d) + w.phase);
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

std::vector<Interlocked> interlocked(int fine) {
  const auto mapped = [](Mesh mesh, const auto& move) {
    for (Eigen::Vector3d& v : mesh.vertices) v = move(v);
    return mesh;
  };
  const auto stretched = [&](const Mesh& mesh, const Eigen::Vector3d& by) {
    return mapped(mesh, [&](const Eigen::Vector3d& v) { return v.cwiseProduct(by); });
  };
  // Waves in the radii about the z axis, which move up as one turns.
  const auto threaded = [&](const Mesh& mesh) {
    return mapped(mesh, [](Eigen::Vector3d v) {
      const double radius = std::hypot(v.x(), v.y()), turn = std::atan2(v.y(), v.x());
      if (radius > 0.5) v.head<2>() *= 1 + 0.05 * deterministic::sin(turn + 5 * v.z()) / radius;
      return v;
    });
  };
  // The z axis becomes an arc.
  const auto bent = [&](const Mesh& mesh) {
    return mapped(mesh, [](const Eigen::Vector3d& v) {
      constexpr double kRadius = 4;
      const double r = kRadius + v.x(), angle = v.z() / kRadius;
      return Eigen::Vector3d{r * deterministic::cos(angle) - kRadius, v.y(), r * deterministic::sin(angle)};
    });
  };
  const Mesh ring = shapes::torus(18 * fine, 8 * fine, 1, 0.2),
             tube = stretched(shapes::torus(18 * fine, 10 * fine, 1.3, 0.25), {1, 1, 4}),
             shaft = stretched(shapes::uv_sphere(18 * fine, 8 * fine), {0.9, 0.9, 1.5});
  // A chain of four links, of which A has every second one.
  const auto two_links = [&](double at) {
    return shapes::several(
        {shapes::translated(ring, {at, 0, 0}), shapes::translated(ring, {at + 2.6, 0, 0})});
  };
  const Eigen::Matrix3d upright = deterministic::rotation(Eigen::Vector3d::UnitX(), 1.6);
  return {{"rings", ring, ring, {upright, {1, 0.03, 0.02}}},
          {"chain", two_links(0), two_links(1.3), {upright, {0, 0.02, 0.01}}},
          {"shaft", tube, shaft, Pose::translation({0.01, 0.02, 0.1})},
          {"thread", threaded(tube), threaded(shaft), Pose::translation({0, 0.02, 0.05})},
          {"cable", bent(stretched(tube, {1, 1, 3})), bent(stretched(shaft, {1, 1, 3})),
           Pose::translation({0.01, 0, 0.02})}};
}

}  // namespace lrb::generators
