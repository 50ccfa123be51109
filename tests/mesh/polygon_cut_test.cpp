// The triangles of polygons on a grid of integers, in planes of any slope.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "tests/support/polygon_triangles.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::polygons {
namespace {

using Int = std::int64_t;
struct P {
  Int x, y;
  bool operator==(const P&) const = default;
};
using Outline = std::vector<P>;

Int doubled_area(P a, P b, P c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
int side(P a, P b, P c) {
  const Int area = doubled_area(a, b, c);
  return (area > 0) - (area < 0);
}

Int doubled_area(const Outline& o) {
  Int sum = 0;
  for (std::size_t i = 1; i + 1 < o.size(); ++i) sum += doubled_area(o[0], o[i], o[i + 1]);
  return sum;
}

bool is_between(P a, P b, P p) {
  return side(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool meet(P a, P b, P c, P d) {
  if (is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b)) return true;
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// Returns true if sides share no points but the corners of neighbours.
bool is_simple(const Outline& o) {
  const std::size_t n = o.size();
  for (std::size_t i = 0; i < n; ++i) {
    const P a = o[i], b = o[(i + 1) % n], c = o[(i + 2) % n];
    if (is_between(a, b, c) || is_between(b, c, a)) return false;
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(a, b, o[j], o[(j + 1) % n])) return false;
  }
  return true;
}

Outline random_walk(std::size_t n, Int grid, std::mt19937_64& random) {
  Outline o(n);
  for (P& p : o) p = {static_cast<Int>(random() % grid), static_cast<Int>(random() % grid)};
  return o;
}

/// Returns a corner, and then a walk to a hole, around it clockwise, and back: over the bridge to its first
/// corner, counter-clockwise as seen from there.
Outline with_hole(P at, Outline hole) {
  if (doubled_area(hole) > 0) std::reverse(hole.begin(), hole.end());
  const auto first = std::min_element(hole.begin(), hole.end(), [&](P p, P q) {
    return side(at, p, q) != 0 ? side(at, p, q) > 0 : std::abs(p.x - at.x) + p.y < std::abs(q.x - at.x) + q.y;
  });
  std::rotate(hole.begin(), first, hole.end());
  hole.push_back(hole.front());
  hole.push_back(at);
  hole.insert(hole.begin(), at);
  return hole;
}

/// The positions of an outline in a plane of some slope.
std::vector<Eigen::Vector3d> positions(const Outline& o, int plane) {
  std::vector<Eigen::Vector3d> out;
  for (const P p : o) {
    const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    const Eigen::Vector3d planes[] = {
        {x, y, 5}, {7, x, y}, {y, x, 2 * x - 3 * y}, {0x1p-500 * x, 0x1p-500 * y, 0}};
    out.push_back(planes[plane]);
  }
  return out;
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Checks the triangles of an outline. `whole`: there are triangles that cover it.
void check_cut(Outline o, bool whole, std::mt19937_64& random) {
  if (random() % 2 == 0) std::reverse(o.begin(), o.end());
  std::rotate(o.begin(), o.begin() + static_cast<std::ptrdiff_t>(random() % o.size()), o.end());
  const std::vector<Eigen::Vector3d> x = positions(o, static_cast<int>(random() % 4));
  Triangles triangles;
  CHECK(test::fault_of_triangles(x) == nullptr);
  if (whole) REQUIRE(cut_polygon(x, triangles) != PolygonCut::folded);
}

}  // namespace

TEST_CASE("triangles of closed walks cover them as often as they wind, and all simple polygons") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 40000; ++i) {
    const Outline o = random_walk(3 + random() % 7, i % 2 == 0 ? 4 : i % 3 == 0 ? 7 : 1000, random);
    check_cut(o, is_simple(o), random);
  }
}

TEST_CASE("triangles of polygons with bridges to two holes cover them") {
  std::mt19937_64 random(2);
  for (int i = 0; i < 3000; ++i) {
    Outline o;
    for (const Int x : {0, 12}) {
      Outline hole;
      do hole = random_walk(3 + random() % 4, i % 2 == 0 ? 4 : 6, random);
      while (!is_simple(hole));
      for (P& p : hole) p = {p.x + (x == 0 ? 1 : 7), p.y + 2};
      for (const P& p : with_hole({x, 0}, hole)) o.push_back(p);
    }
    for (const P& p : {P{14, 9}, P{6, 8}, P{-2, 9}}) o.push_back(p);
    check_cut(o, true, random);
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
    for (int i = 0; i < 50; ++i) check_cut(o, true, random);
  // As they are, with the number of their triangles without area.
  const std::vector<std::pair<Outline, int>> others = {
      {{{0, 6}, {1, 2}, {1, 1}, {3, 4}, {5, 6}}, 0},                  // a corner on a diagonal
      {{{2, 3}, {0, 0}, {1, 1}, {0, 0}}, 2},                          // no area
      {{{4, 3}, {2, 1}, {3, 1}, {4, 4}, {3, 2}, {4, 1}}, 1},          // an edge that enters an ear at its end
      {{{4, 0}, {5, 2}, {3, 3}, {1, 3}, {4, 2}, {5, 0}, {4, 3}}, 1},  // ears that are none later
      {{{1, 4}, {1, 5}, {2, 2}, {1, 0}, {1, 5}, {3, 5}, {0, 1}, {0, 4}, {3, 3}, {1, 2}, {0, 1}}, 3}};
  for (const auto& [outline, flat] : others) {
    Triangles triangles;
    CHECK(cut_polygon(positions(outline, 0), triangles) == PolygonCut::ears);
    int found = 0;
    for (const auto& t : triangles) found += doubled_area(outline[t[0]], outline[t[1]], outline[t[2]]) == 0;
    CHECK(found == flat);
  }
}

TEST_CASE(
    "polygons that their fan covers, as it does all convex ones, and those that nothing covers are fans") {
  Triangles triangles;
  const auto check = [&](const std::vector<Eigen::Vector3d>& x, PolygonCut expected) {
    CHECK(cut_polygon(x, triangles) == expected);
    bool is_fan = true;
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
      is_fan &= triangles[i] == std::array<std::uint32_t, 3>{0, i + 1, i + 2};
    CHECK(is_fan == (expected != PolygonCut::ears));
  };
  for (const Outline& o : std::vector<Outline>{{{0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4}},
                                               {{1, 1}, {0, 4}, {0, 0}, {4, 0}}})  // seen from its dent
    for (int plane = 0; plane < 4; ++plane) check(positions(o, plane), PolygonCut::fan);
  check({{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {0, 4, 1}}, PolygonCut::fan);
  // A dart, folded by a fiftieth and a fifth of its size.
  check({{0, 4, 0}, {0, 0, 0.1}, {4, 0, 0}, {1, 1, 0.1}}, PolygonCut::ears);
  check({{0, 4, 0}, {0, 0, 1}, {4, 0, 0}, {1, 1, 1}}, PolygonCut::folded);
  check(positions({{0, 2}, {-1, -2}, {2, 1}, {-2, 1}, {1, -2}}, 0), PolygonCut::folded);  // a pentagram
}

}  // namespace lrb::polygons
