#include <cmath>
#include <numbers>

#include "engine/core/steady_math.hpp"
#include "scenarios/bodies/generators/bodies.hpp"

namespace lrb::generators {
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
    profile.emplace_back(radius * steady::sin(angle), height - radius * steady::cos(angle));
  }
}

/// Turns a profile around the z axis. The solid lies on the left of the profile's direction, seen with the
/// axis on the left and z up; the first and the last point are put on the axis.
Mesh lathe(const Profile& profile, int segments) {
  Mesh mesh;
  const int rows = static_cast<int>(profile.size());
  mesh.vertices.emplace_back(0, 0, profile.front().y());
  for (int row = 1; row + 1 < rows; ++row) {
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (row % 2)) / segments;
      mesh.vertices.emplace_back(profile[row].x() * steady::cos(angle), profile[row].x() * steady::sin(angle),
                                 profile[row].y());
    }
  }
  mesh.vertices.emplace_back(0, 0, profile.back().y());
  const auto id = [&](int row, int i) {
    return static_cast<VertexId>(1 + (row - 1) * segments + i % segments);
  };
  const auto last = static_cast<VertexId>(mesh.vertices.size() - 1);
  for (int i = 0; i < segments; ++i) add_triangle(mesh, 0, id(1, i + 1), id(1, i));
  for (int row = 1; row + 2 < rows; ++row) {
    const int odd = row % 2;  // every other ring is turned by half a segment
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

}  // namespace lrb::generators
