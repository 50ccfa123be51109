// The triangles of polygons: on a grid of integers, against areas and winding numbers in integers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <lrbscope/mesh.hpp>

namespace lrb::test {
namespace {

struct P {
  std::int64_t x, y;
  bool operator==(const P&) const = default;
};
using Outline = std::vector<P>;

std::int64_t doubled_area(P a, P b, P c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
int sign(std::int64_t x) {
  return (x > 0) - (x < 0);
}

std::int64_t doubled_area(const Outline& o) {
  std::int64_t sum = 0;
  for (std::size_t i = 1; i + 1 < o.size(); ++i) sum += doubled_area(o[0], o[i], o[i + 1]);
  return sum;
}

/// Returns how often the outline winds around a point that is on none of its lines.
int winding(const Outline& o, P p) {
  int turns = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    const P a = o[i], b = o[(i + 1) % o.size()];
    if ((a.y <= p.y) != (b.y <= p.y) && sign(doubled_area(a, b, p)) == (a.y <= p.y ? 1 : -1))
      turns += a.y <= p.y ? 1 : -1;
  }
  return turns;
}

bool is_between(P a, P b, P p) {
  return doubled_area(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool meet(P a, P b, P c, P d) {
  if (is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b)) return true;
  return sign(doubled_area(a, b, c)) * sign(doubled_area(a, b, d)) < 0 &&
         sign(doubled_area(c, d, a)) * sign(doubled_area(c, d, b)) < 0;
}

/// The coordinates times this and a little more: samples are on no line through two corners.
constexpr std::int64_t kFine = 1 << 20;

/// The positions of an outline in a plane of some slope.
std::vector<Eigen::Vector3d> positions(const Outline& o, int plane) {
  std::vector<Eigen::Vector3d> out;
  for (const P p : o) {
    const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    out.push_back(plane == 0   ? Eigen::Vector3d(x, y, 5)
                  : plane == 1 ? Eigen::Vector3d(7, x, y)
                  : plane == 2 ? Eigen::Vector3d(y, x, 2 * x - 3 * y)
                               : Eigen::Vector3d(0x1p-500 * x, 0x1p-500 * y, 0));
  }
  return out;
}

/// Checks the triangles of an outline. `simple`: each point is covered 0 or 1 times, so they must cover it.
void check_cut(Outline o, bool simple, std::mt19937_64& random) {
  const bool turned = random() % 2 == 0;
  if (turned) std::reverse(o.begin(), o.end());
  std::rotate(o.begin(), o.begin() + static_cast<std::ptrdiff_t>(random() % o.size()), o.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const int plane = static_cast<int>(random() % 4);
  const PolygonCut cut = cut_polygon(positions(o, plane), triangles);
  REQUIRE(triangles.size() == o.size() - 2);
  if (simple) REQUIRE(cut != PolygonCut::folded);
  if (cut == PolygonCut::folded) return;
  // The same orientation for all, and the area of the outline.
  std::int64_t sum = 0;
  int side = 0;
  bool same_side = true;
  for (const auto& [i, j, k] : triangles) {
    const std::int64_t area = doubled_area(o[i], o[j], o[k]);
    sum += area;
    if (area != 0 && side == 0) side = sign(area);
    same_side &= area == 0 || sign(area) == side;
  }
  CHECK(same_side);
  CHECK(sum == doubled_area(o));
  // Samples: points beside corners.
  for (P& p : o) p = {p.x * kFine, p.y * kFine};
  for (int i = 0; i < 40; ++i) {
    const P near = o[random() % o.size()];
    const std::int64_t reach = 3 * kFine;
    const P p{near.x + 1 + static_cast<std::int64_t>(random() % (2 * reach)) - reach,
              near.y + 1 + static_cast<std::int64_t>(random() % (2 * reach)) - reach};
    int covered = 0;
    bool on_line = false;
    for (const auto& t : triangles) {
      const Outline triangle{o[t[0]], o[t[1]], o[t[2]]};
      for (int k = 0; k < 3; ++k) on_line |= is_between(triangle[k], triangle[(k + 1) % 3], p);
      covered += winding(triangle, p);
    }
    if (!on_line) CHECK(covered == winding(o, p));
  }
}

/// A random outline through random points of a grid, whose crossing sides were exchanged until none was left.
/// Points that repeat others, or are inside others' sides, are left out.
Outline random_simple(std::size_t n, std::int64_t grid, std::mt19937_64& random) {
  while (true) {
    Outline o;
    for (std::size_t i = 0; i < n; ++i) {
      const P p{static_cast<std::int64_t>(random() % grid), static_cast<std::int64_t>(random() % grid)};
      if (std::find(o.begin(), o.end(), p) == o.end()) o.push_back(p);
    }
    const std::size_t m = o.size();
    if (m < 3) continue;
    for (int round = 0; round < 500; ++round) {
      bool any = false;
      for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = i + 1; j < m; ++j) {
          const P a = o[i], b = o[(i + 1) % m], c = o[j], d = o[(j + 1) % m];
          const bool neighbours = j == i + 1 || (i == 0 && j == m - 1);
          // Neighbours may share their corner only.
          const bool crossed = neighbours ? (j == i + 1 ? is_between(a, b, d) || is_between(c, d, a)
                                                        : is_between(a, b, c) || is_between(c, d, b))
                                          : meet(a, b, c, d);
          if (!crossed) continue;
          any = true;
          std::reverse(o.begin() + static_cast<std::ptrdiff_t>(i + 1),
                       o.begin() + static_cast<std::ptrdiff_t>(j + 1));
        }
      if (!any) return o;
    }
  }
}

/// Joins a hole to a counter-clockwise outline by an edge that meets nothing else, and none of the holes.
void add_hole(Outline& o, Outline hole, const std::vector<Outline>& holes) {
  for (std::size_t i = 0; i < o.size(); ++i)
    for (std::size_t j = 0; j < hole.size(); ++j) {
      const P a = o[i], b = hole[j];
      const auto blocked = [&](const Outline& other) {
        for (std::size_t k = 0; k < other.size(); ++k) {
          const P c = other[k], d = other[(k + 1) % other.size()];
          if (c == a || c == b || d == a || d == b ? is_between(a, b, c == a || c == b ? d : c)
                                                   : meet(a, b, c, d))
            return true;
        }
        return false;
      };
      // Only from corners that are once in the outline: elsewhere the order around the corner matters.
      if (std::count(o.begin(), o.end(), a) > 1 || blocked(o) ||
          std::any_of(holes.begin(), holes.end(), blocked))
        continue;
      std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(j), hole.end());
      hole.push_back(hole.front());
      hole.push_back(a);
      o.insert(o.begin() + static_cast<std::ptrdiff_t>(i + 1), hole.begin(), hole.end());
      return;
    }
  FAIL("no place for a bridge");
}

}  // namespace

TEST_CASE("triangles of random simple polygons cover them, on few lines and on many") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t grid = i % 3 == 0 ? 4 : i % 3 == 1 ? 7 : 1000;
    check_cut(random_simple(3 + random() % 14, grid, random), true, random);
  }
}

TEST_CASE("triangles of polygons with bridges to holes cover them") {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1500; ++i) {
    // Holes in the cells of a board, and an outline around it with teeth.
    const std::int64_t cells = 1 + static_cast<std::int64_t>(random() % 3), cell = i % 2 == 0 ? 4 : 40;
    const std::int64_t size = cells * cell;
    Outline o;
    const auto tooth = [&] { return static_cast<std::int64_t>(random() % 3); };
    for (std::int64_t k = 0; k < cells; ++k) o.push_back({k * cell, -1 - tooth()});
    for (std::int64_t k = 0; k < cells; ++k) o.push_back({size + 1 + tooth(), k * cell});
    for (std::int64_t k = 0; k < cells; ++k) o.push_back({size - k * cell, size + 1 + tooth()});
    for (std::int64_t k = 0; k < cells; ++k) o.push_back({-1 - tooth(), size - k * cell});
    std::vector<Outline> holes;
    for (std::int64_t x = 0; x < cells; ++x)
      for (std::int64_t y = 0; y < cells; ++y) {
        if (random() % 4 == 0) continue;
        Outline hole = random_simple(3 + random() % 5, cell, random);
        if (doubled_area(hole) == 0) continue;
        if (doubled_area(hole) > 0) std::reverse(hole.begin(), hole.end());
        for (P& p : hole) p = {p.x + x * cell, p.y + y * cell};
        holes.push_back(hole);
      }
    for (const Outline& hole : holes) add_hole(o, hole, holes);
    check_cut(o, true, random);
  }
}

TEST_CASE("triangles of any closed walk cover it as often as it winds, or are its fan") {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    Outline o;
    for (std::size_t n = 3 + random() % 8; o.size() < n;)
      o.push_back({static_cast<std::int64_t>(random() % 4), static_cast<std::int64_t>(random() % 4)});
    check_cut(o, false, random);
  }
}

TEST_CASE("outlines that touch themselves") {
  std::mt19937_64 random(4);
  const std::vector<Outline> outlines = {
      {{0, 0}, {-2, 2}, {-2, -2}, {0, 0}, {2, -2}, {3, 1}},                      // two triangles at a corner
      {{0, 0}, {6, 0}, {6, 6}, {3, 0}, {0, 6}},                                  // a corner inside a side
      {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 4}, {4, 4}, {4, 2}},          // a hole at a corner
      {{0, 0}, {6, 0}, {6, 6}, {3, 6}, {3, 3}, {3, 6}, {0, 6}},                  // a slit
      {{0, 0}, {6, 0}, {6, 6}, {3, 6}, {3, 9}, {3, 6}, {0, 6}},                  // a spike
      {{0, 0}, {6, 0}, {6, 6}, {3, 6}, {2, 4}, {4, 4}, {3, 6}, {0, 6}},          // a hole at a side
      {{0, 0}, {3, 0}, {3, 0}, {6, 0}, {6, 6}, {3, 1}, {3, 1}, {3, 1}, {0, 6}},  // repeated corners
  };
  for (const Outline& o : outlines)
    for (int i = 0; i < 50; ++i) {
      CAPTURE(o.size());
      check_cut(o, true, random);
    }
}

TEST_CASE("convex polygons, and those that their fan covers, are fans") {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto is_fan = [&] {
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
      if (triangles[i] != std::array<std::uint32_t, 3>{0, i + 1, i + 2}) return false;
    return true;
  };
  const std::vector<Outline> outlines = {
      {{0, 0}, {4, 0}, {4, 4}, {0, 4}},
      {{0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4}},
      {{1, 1}, {0, 4}, {0, 0}, {4, 0}},  // concave, seen from its first corner
      {{0, 0}, {9, 0}, {5, 4}, {4, 9}}};
  for (const Outline& o : outlines)
    for (int plane = 0; plane < 4; ++plane) {
      CHECK(cut_polygon(positions(o, plane), triangles) == PolygonCut::fan);
      CHECK(is_fan());
    }
  // Not planar: by the shape seen along its normal.
  CHECK(cut_polygon(std::vector<Eigen::Vector3d>{{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {0, 4, 1}}, triangles) ==
        PolygonCut::fan);
  CHECK(is_fan());
  // A dart, folded a little and much.
  std::vector<Eigen::Vector3d> dart = {{4, 0, 0}, {1, 1, 0.1}, {0, 4, 0}, {0, 0, 0.1}};
  std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  CHECK(cut_polygon(dart, triangles) == PolygonCut::fan);
  std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  CHECK(cut_polygon(dart, triangles) == PolygonCut::ears);
  CHECK(!is_fan());
  for (Eigen::Vector3d& x : dart) x.z() *= 30;
  CHECK(cut_polygon(dart, triangles) == PolygonCut::folded);
  CHECK(is_fan());
  // Crossed.
  CHECK(cut_polygon(positions({{0, 2}, {-1, -2}, {2, 1}, {-2, 1}, {1, -2}}, 0), triangles) ==
        PolygonCut::folded);
  CHECK(is_fan());
}

TEST_CASE("polygons of 200,000 corners take no quadratic time") {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  constexpr int kCorners = 200'000;
  constexpr double kLast = kCorners - 1;
  const auto check = [&](std::vector<Eigen::Vector3d> x, PolygonCut expected) {
    CHECK(cut_polygon(x, triangles) == expected);
    double cut = 0, fan = 0;
    for (const auto& [i, j, k] : triangles) cut += std::abs((x[j] - x[i]).cross(x[k] - x[i]).z());
    for (std::size_t i = 1; i + 1 < x.size(); ++i) fan += (x[i] - x[0]).cross(x[i + 1] - x[0]).z();
    if (expected == PolygonCut::ears) CHECK(cut == doctest::Approx(std::abs(fan)).epsilon(1e-6));
  };
  // A comb, a spiral and a star.
  std::vector<Eigen::Vector3d> comb, spiral, star, point;
  for (int i = 0; i < kCorners; ++i) comb.push_back({double(i), i % 2 == 0 ? 0.0 : 100.0, 0});
  comb.push_back({kLast, -1, 0});
  comb.push_back({0, -1, 0});
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < kCorners / 2; ++k) {
      const int i = side == 0 ? k : kCorners / 2 - 1 - k;
      const double angle = i * 0.01, radius = 10 + angle + 2 * side;
      spiral.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners, radius = i % 2 == 0 ? 1 : 2;
    star.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  // Many triangles with one corner in common: touching at one place, which is the worst case.
  for (int i = 0; i + 2 < kCorners; i += 3) {
    const double angle = 2 * std::numbers::pi * i / kCorners, next = angle + std::numbers::pi / kCorners;
    point.push_back({0, 0, 0});
    point.push_back({std::cos(angle), std::sin(angle), 0});
    point.push_back({std::cos(next), std::sin(next), 0});
  }
  check(comb, PolygonCut::ears);
  check(spiral, PolygonCut::ears);
  check(star, PolygonCut::ears);
  cut_polygon(point, triangles);
  CHECK(triangles.size() == point.size() - 2);
}

}  // namespace lrb::test
