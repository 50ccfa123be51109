#include "engine/exact/locate.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "tests/support/contact_oracle.hpp"
#include "tests/support/random_simplices.hpp"

using namespace lrb;
using exact::RationalPoint;
using exact::RayHit;
using Corners = oracle::Points<oracle::cpp_rational>;
using Vec = std::array<double, 3>;
using Triangle = std::array<const double*, 3>;

namespace {

/// 1 inside, 0 outside, -1 on the boundary of the simplex (tetrahedron or triangle, maybe flat).
int where(const Corners& corners, const oracle::Point<oracle::cpp_rational>& x) {
  const unsigned all = (1u << corners.size()) - 1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (oracle::holds(corners, all & ~(1u << i), x)) return -1;
  }
  return oracle::holds(corners, all, x) ? 1 : 0;
}

/// The same by the parity of the ray's crossings with the sides of the simplex.
template <class P>
int where_by_ray(const std::array<Vec, 4>& p, const P& x, std::size_t dim) {
  int crossings = 0;
  for (std::size_t opposite = 0; opposite <= dim; ++opposite) {
    const double* side[3];
    for (std::size_t i = 0, n = 0; i <= dim; ++i)
      if (i != opposite) side[n++] = p[i].data();
    const RayHit hit = dim == 3 ? exact::ray_crosses(x, side) : exact::ray_crosses_2d(x, side);
    if (hit == RayHit::on_face) return -1;
    crossings += hit == RayHit::crosses;
  }
  return crossings % 2;
}

Corners rational_corners(const std::array<Vec, 4>& p, std::size_t dim) {
  Corners r;
  for (std::size_t i = 0; i <= dim; ++i) r.push_back(oracle::to_rational_point(p[i].data(), dim));
  return r;
}

/// A rational point that is likely to be in the simplex, on its faces, or level with its corners.
struct Mixture {
  RationalPoint engine;
  oracle::Point<oracle::cpp_rational> exact;
};

Mixture random_mixture(test::Rng& rng, const std::array<Vec, 4>& p, int dim) {
  std::vector<RationalPoint> points;
  std::vector<double> weights;
  oracle::Point<oracle::cpp_rational> sum(static_cast<std::size_t>(dim));
  double total = 0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(dim); ++i) {
    const double w = test::random_int(rng, 0, 3);
    points.emplace_back(p[i].data(), dim);
    weights.push_back(w);
    total += w;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k)
      sum[k] += oracle::cpp_rational(w) * p[i][k];
  }
  if (total == 0) return {points[0], oracle::to_rational_point(p[0].data(), static_cast<std::size_t>(dim))};
  for (auto& s : sum) s /= oracle::cpp_rational(total);
  return {RationalPoint::combination(points, weights), sum};
}

void fill(test::Rng& rng, std::array<Vec, 4>& p, bool nudged) {
  for (auto& v : p) {
    for (double& x : v)
      x = nudged ? test::nudge(rng, test::random_int(rng, 0, 3)) : test::random_int(rng, 0, 3);
  }
}

}  // namespace

TEST_CASE("the parity of the moved ray is right for tetrahedra and triangles in the plane, flat ones too") {
  test::Rng rng(41);
  for (const std::size_t dim : {std::size_t{3}, std::size_t{2}}) {
    int wrong = 0, inside = 0, on = 0;
    for (int i = 0; i < test::effort(1500); ++i) {
      std::array<Vec, 4> p;
      fill(rng, p, i % 3 == 0);
      Vec x;
      for (double& c : x) c = test::random_int(rng, 0, 6) * 0.5;
      const int expected = where(rational_corners(p, dim), oracle::to_rational_point(x.data(), dim));
      wrong += where_by_ray(p, static_cast<const double*>(x.data()), dim) != expected;
      wrong += where_by_ray(p, RationalPoint(x.data(), static_cast<int>(dim)), dim) != expected;
      inside += expected == 1;
      on += expected == -1;
      const Mixture m = random_mixture(rng, p, static_cast<int>(dim));
      wrong += where_by_ray(p, m.engine, dim) != where(rational_corners(p, dim), m.exact);
    }
    CHECK(wrong == 0);
    CHECK(inside > 0);
    CHECK(on > 0);
  }
}

TEST_CASE("a rational point is the point of its rational coordinates") {
  const Vec a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
  const RationalPoint third =
      RationalPoint::combination(std::vector<RationalPoint>{RationalPoint(a.data()), RationalPoint(b.data())},
                                 std::vector<double>{2, 1});
  CHECK(third.rounded() == Eigen::Vector3d(1.0 / 3, 0, 0));
  CHECK(exact::orient3d(a.data(), b.data(), c.data(), third) == 0);
  CHECK(exact::orient3d(a.data(), c.data(), d.data(), third) == 1);
  CHECK(exact::orient2d(a.data(), b.data(), third) == 0);
  CHECK(exact::orient2d(c.data(), a.data(), third) == 1);
  const RationalPoint half = RationalPoint::midpoint(RationalPoint(c.data()), RationalPoint(d.data()));
  CHECK(half.rounded() == Eigen::Vector3d(0, 0.5, 0.5));
}

namespace {

/// Sides of a point on all planes of the other triangles: constant in a cell if each cuts the whole triangle.
std::vector<int> signs(const std::vector<std::array<Vec, 3>>& planes, const RationalPoint& x) {
  std::vector<int> r;
  for (const auto& t : planes) r.push_back(exact::orient3d(t[0].data(), t[1].data(), t[2].data(), x));
  return r;
}

std::vector<Triangle> pointers(const std::vector<std::array<Vec, 3>>& triangles) {
  std::vector<Triangle> r;
  for (const auto& t : triangles) r.push_back({t[0].data(), t[1].data(), t[2].data()});
  return r;
}

bool strictly_in(const Triangle& tri, const RationalPoint& x) {
  // In its plane, and not on its boundary: an apex off the plane makes tetrahedra of it.
  const std::array<Vec, 3> corner{Vec{tri[0][0], tri[0][1], tri[0][2]}, Vec{tri[1][0], tri[1][1], tri[1][2]},
                                  Vec{tri[2][0], tri[2][1], tri[2][2]}};
  const Vec apex{17, 23, 31};
  const int side = exact::orient3d(tri[0], tri[1], tri[2], apex.data());
  if (exact::orient3d(tri[0], tri[1], tri[2], x) != 0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (exact::orient3d(corner[i].data(), corner[(i + 1) % 3].data(), apex.data(), x) != -side) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("every cell of a cut triangle has a sample strictly inside") {
  test::Rng rng(43);
  for (int i = 0; i < test::effort(60); ++i) {
    const Vec a{0, 0, 0}, b{4, test::random_int(rng, -1, 1) * 1.0, 1},
        c{1, 4, test::random_int(rng, 0, 2) * 1.0};
    const Triangle tri{a.data(), b.data(), c.data()};
    std::vector<std::array<Vec, 3>> others(static_cast<std::size_t>(test::random_int(rng, 0, 6)));
    for (auto& t : others) {
      // Through two points near the triangle, steep and far larger than it.
      const double x = test::random_int(rng, 0, 4), y = test::random_int(rng, 0, 4);
      const double dx = test::random_int(rng, -2, 2), dy = dx == 0 ? 1 : test::random_int(rng, -2, 2);
      t = {Vec{x - 1000 * dx, y - 1000 * dy, -3000}, Vec{x + 1000 * dx, y + 1000 * dy, -3000},
           Vec{x, y + test::random_int(rng, -2, 2), 9000}};
    }
    const auto samples = exact::sample_cells(tri.data(), pointers(others), 1000);
    REQUIRE(samples);
    std::set<std::vector<int>> found;
    for (const RationalPoint& s : *samples) {
      CHECK(strictly_in(tri, s));
      const auto sign = signs(others, s);
      CHECK(std::find(sign.begin(), sign.end(), 0) == sign.end());
      found.insert(sign);
    }
    CHECK(found.size() == samples->size());  // cells cut right through are convex: none is sampled twice
    std::vector<RationalPoint> corners{RationalPoint(a.data()), RationalPoint(b.data()),
                                       RationalPoint(c.data())};
    for (int j = 0; j < 200; ++j) {
      const std::vector<double> w{1 + test::random_unit(rng) * 9, 1 + test::random_unit(rng) * 9,
                                  test::random_unit(rng)};
      const auto sign = signs(others, RationalPoint::combination(corners, w));
      if (std::find(sign.begin(), sign.end(), 0) == sign.end()) CHECK(found.count(sign) == 1);
    }
  }
}

TEST_CASE("cells without an edge of the triangle and cells under coplanar triangles are sampled") {
  const Vec a{0, 0, 0}, b{8, 0, 0}, c{0, 8, 0};
  const Triangle tri{a.data(), b.data(), c.data()};
  // The sides of a tetrahedron that pokes through the triangle, and its base that does not reach it.
  const std::vector<Vec> p{{1, 1, -1}, {5, 1, -1}, {1, 5, -1}, {2, 2, 3}};
  std::vector<std::array<Vec, 3>> others{
      {p[0], p[1], p[3]}, {p[1], p[2], p[3]}, {p[2], p[0], p[3]}, {p[0], p[1], p[2]}};
  const auto in_tetrahedron = [&](const RationalPoint& x) {
    int crossings = 0;
    for (const Triangle& t : pointers(others))
      crossings += exact::ray_crosses(x, t.data()) == RayHit::crosses;
    return crossings % 2 == 1;
  };
  const auto samples = exact::sample_cells(tri.data(), pointers(others), 100);
  REQUIRE(samples);
  CHECK(std::count_if(samples->begin(), samples->end(), in_tetrahedron) == 1);
  CHECK(std::count_if(samples->begin(), samples->end(), in_tetrahedron) < static_cast<int>(samples->size()));
  CHECK_FALSE(exact::sample_cells(tri.data(), pointers(others), 1));

  const std::vector<std::array<Vec, 3>> flat{{Vec{1, 1, 0}, Vec{3, 1, 0}, Vec{1, 3, 0}}};
  const auto cells = exact::sample_cells(tri.data(), pointers(flat), 100);
  REQUIRE(cells);
  const auto covered = [&](const RationalPoint& x) {
    return exact::ray_crosses(x, pointers(flat)[0].data()) == RayHit::on_face;
  };
  CHECK(std::count_if(cells->begin(), cells->end(), covered) == 1);
  CHECK(std::count_if(cells->begin(), cells->end(), covered) < static_cast<int>(cells->size()));
}

TEST_CASE("cells of a segment lie between its cuts") {
  const double s[2] = {0, 0}, e[2] = {8, 4};
  const double* const seg[2] = {s, e};
  const double p[6][2] = {{1, 1}, {1, 0}, {4, 2}, {6, 3}, {8, 0}, {9, 0}};
  const std::vector<std::array<const double*, 2>> others{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}};
  const auto samples = exact::sample_cells_2d(seg, others, 10);
  REQUIRE(samples);
  REQUIRE(samples->size() == 4);  // cuts at x = 1, 4, 6
  CHECK((*samples)[0].rounded() == Eigen::Vector3d(0.5, 0.25, 0));
  CHECK((*samples)[1].rounded() == Eigen::Vector3d(2.5, 1.25, 0));
  CHECK((*samples)[2].rounded() == Eigen::Vector3d(5, 2.5, 0));
  CHECK((*samples)[3].rounded() == Eigen::Vector3d(7, 3.5, 0));
  CHECK_FALSE(exact::sample_cells_2d(seg, others, 3));
}
