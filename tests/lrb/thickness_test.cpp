// Proven deviations of lids from the body, against dense sampling and exact distances.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "bench/stability/rational_oracles.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/lrb_shapes.hpp"
#include "tests/support/shared_meshes.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/point_distance.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {
namespace {

using namespace shapes;
using Eigen::Vector3d;

double size_of(const LrbRep& rep) {
  return box_of(rep).sizes().maxCoeff();
}

std::vector<Points> lids_of(const LrbRep& rep, RegionId r) {
  std::vector<Points> out;
  for (const FaceId f : rep.lids(r))
    for (std::size_t i = 0; i < Mesh::simplices_of(rep.face(f).size(), rep.dim()); ++i)
      out.push_back(simplex_points(rep, Pose{}, SimplexId(rep.first_simplex(f) + i)));
  return out;
}

/// Returns the largest distance from the surface that is found on a region's lids, at points no further apart
/// than a `parts`th of a lid's side, nor than a hundredth of the body's.
double sampled_thickness(const LrbRep& rep, RegionId r, int parts) {
  std::vector<Vector3d> points;
  for (const Points& t : lids_of(rep, r)) {
    double side = 0;
    for (std::size_t k = 0; k < t.size(); ++k) side = std::max(side, (t[(k + 1) % t.size()] - t[k]).norm());
    const int n = std::max(parts, static_cast<int>(100 * side / size_of(rep)));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= (t.size() == 3 ? n - i : 0); ++j) {
        points.emplace_back(t[0] + (t[1] - t[0]) * i / n);
        if (t.size() == 3) points.back() += (t[2] - t[0]) * j / n;
      }
  }
  double most = 0;
  for (const PointDistance& d : point_distances(rep, {}, points, {.side = false}))
    most = std::max(most, d.lower);
  return most;
}

/// For each region the largest value among it and all that it hides.
std::vector<double> with_hidden(const LrbRep& rep, std::vector<double> value) {
  for (bool grown = true; grown;) {
    grown = false;
    for (FaceId f = 0; f < rep.face_count(); ++f) {
      const CellId in = rep.inner_cell(f), out = rep.outer_cell(f);
      if (!is_region(in) || !is_region(out) || value[out] >= value[in]) continue;
      value[out] = value[in];
      grown = true;
    }
  }
  return value;
}

/// Bounds against samples: none is below, nine in ten are within `kNear`, and so is every wrapper that keeps
/// closed what a tolerance allows.
void check_bounds(const LrbRep& rep, int parts) {
  constexpr double kNear = 1.25;
  const std::vector<double> proved = region_thickness(rep);
  REQUIRE(proved.size() == rep.region_count());
  std::vector<double> sampled(rep.region_count());
  std::size_t far = 0;
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    sampled[r] = sampled_thickness(rep, r, parts);
    CAPTURE(r);
    REQUIRE(proved[r] >= sampled[r] * (1 - 1e-9));
    far += proved[r] > kNear * sampled[r] + 1e-6 * size_of(rep);
  }
  CHECK(10 * far <= rep.region_count());
  const std::vector<double> needed = with_hidden(rep, proved), found = with_hidden(rep, sampled);
  for (const double share : {0.002, 0.005, 0.01, 0.02, 0.05, 0.1}) {
    double bound = 0, distance = 0;
    for (RegionId r = 0; r < rep.region_count(); ++r) {
      if (needed[r] > share * size_of(rep)) continue;
      bound = std::max(bound, needed[r]);
      distance = std::max(distance, found[r]);
    }
    CAPTURE(share);
    CHECK(bound <= kNear * distance + 1e-6 * size_of(rep));
  }
}

/// Points of lids that are exact combinations of their corners, and exact distances from the nearest real
/// face. (If rounding names another one, its distance is larger, which asks for more.)
void check_exactly(const LrbRep& rep, RandomEngine& random) {
  const std::vector<double> proved = region_thickness(rep);
  for (RegionId r = 0; r < rep.region_count(); ++r)
    for (const Points& lid : lids_of(rep, r)) {
      const int a = static_cast<int>(random() % 9), b = static_cast<int>(random() % (9 - a));
      const oracle::Rational weights[3] = {oracle::Rational(a) / 8,
                                           oracle::Rational(lid.size() == 3 ? b : 8 - a) / 8,
                                           oracle::Rational(lid.size() == 3 ? 8 - a - b : 0) / 8};
      oracle::RationalPoint p = {0, 0, 0};
      for (std::size_t k = 0; k < lid.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i)
          p[i] += weights[k] * oracle::Rational(lid[k][static_cast<int>(i)]);
      const Vector3d about(p[0].convert_to<double>(), p[1].convert_to<double>(), p[2].convert_to<double>());
      const SimplexId nearest = point_distances(rep, {}, {&about, 1}, {.side = false})[0].closest.simplex;
      CAPTURE(r);
      REQUIRE(oracle::closest_points({p}, oracle::rational(simplex_points(rep, {}, nearest))).distance_sq <=
              oracle::square(proved[r]));
    }
}

/// Balls, CAD-like bodies, polygons, several pieces, voids, bodies that cross themselves; in 2D, too.
std::vector<Mesh> all_kinds() {
  return {icosphere(3),
          bumpy_sphere(3, 1, 0.4),
          bowl(24, 10),
          torus(32, 16),
          quad_torus(24, 12),
          comb(6),
          voxels(
              8, 8, 3, [](int x, int, int z) { return z == 0 || x % 3 == 0; }, true),
          revolve({{0, -1}, {1, -1}, {0.2, 0}, {1, 1}, {0, 1}}, 32),
          several({icosphere(3), translated(torus(16, 8), {0, 4, 1})}),
          several({icosphere(3, 3), turned_inside_out(icosphere(3, 2)),
                   translated(icosphere(2, 0.5), {0.7, 0, 0})}),
          several({icosphere(3), translated(icosphere(3), {1, 0.1, 0})}),
          gear(40),
          ring_2d(120),
          comb_2d(12),
          several({circle(40, 3), turned_inside_out(circle(30, 2)), star(5)})};
}

TEST_CASE("the thickness of a region bounds its lids' deviation tightly" * doctest::test_suite("long")) {
  for (const Mesh& mesh : all_kinds()) {
    for (const bool lean : {false, true}) {
      CAPTURE(mesh.name);
      CAPTURE(mesh.face_count());
      CAPTURE(lean);
      BuildOptions options;
      options.lean = lean;
      check_bounds(build_lrb(mesh, options), mesh.dim == 3 ? 16 : 64);
    }
  }
}

TEST_CASE("the thickness bound is valid for tiny and huge bodies, and far from the origin") {
  for (const double scale : {1e-30, 1e-9, 1e9, 1e30}) {
    CAPTURE(scale);
    const LrbRep rep = build_lrb(scaled(bumpy_sphere(2, 7, 0.3), scale));
    const std::vector<double> proved = region_thickness(rep);
    const std::vector<double> one = region_thickness(build_lrb(bumpy_sphere(2, 7, 0.3)));
    REQUIRE(proved.size() == rep.region_count());
    for (const double t : proved) CHECK((std::isfinite(t) && t >= 0));
    CHECK(*std::max_element(proved.begin(), proved.end()) <= 2 * scale);
    CHECK(!one.empty());
  }
  check_bounds(build_lrb(translated(bumpy_sphere(3, 7), {1e4, -1e4, 1e4})), 12);
}

TEST_CASE("no point of a lid is exactly further from the real faces than the thickness") {
  RandomEngine random(5);
  for (const Mesh& mesh : {bumpy_sphere(1, 3, 0.4), bowl(8, 4), comb(3), quad_torus(8, 5), gear(14),
                           several({icosphere(1), translated(icosphere(1), {1, 0.1, 0})})}) {
    CAPTURE(mesh.name);
    check_exactly(build_lrb(mesh), random);
  }
  check_exactly(LrbRep(toy::notched_plate()), random);
}

TEST_CASE("a flat lid over coplanar faces has thickness 0") {
  // A board with a thousand faces on each side: lids over them lie in their plane but for the builder's
  // margin. The other regions go round its edges.
  const Mesh board = voxels(24, 24, 1, [](int, int, int) { return true; });
  const LrbRep rep = build_lrb(board);
  const std::vector<double> proved = region_thickness(rep);
  std::size_t flat = 0;
  for (const double t : proved) flat += t < 1e-4;
  CHECK(3 * flat > proved.size());
}

TEST_CASE("a region on the body has thickness exactly 0, but not if its lid covers more than its floor") {
  BuildOptions options;
  options.merge_planes = true;
  const LrbRep rep = build_lrb(shapes::box(), options);
  CHECK(region_thickness(rep) == std::vector<double>(6, 0.0));
  // In another program's file: the corner of a lid is moved in its plane, so that the region is open.
  LrbData data = rep.data();
  const auto corners = data.face(rep.lids(0)[0]);
  data.vertices.emplace_back(2 * data.vertices[corners[0]] - data.vertices[corners[2]]);
  data.face_vertices[data.face_offsets[rep.lids(0)[0]]] = VertexId(data.vertices.size() - 1);
  CHECK(region_thickness(LrbRep(data))[0] > 1);
}

TEST_CASE("thickness does not depend on the number of threads") {
  const LrbRep rep = build_lrb(bumpy_sphere(4, 3));
  const std::vector<double> one = region_thickness(rep, 1);
  for (const unsigned threads : {2U, 5U}) CHECK(region_thickness(rep, threads) == one);
}

TEST_CASE("real models: the thickness bound is valid and tight" * doctest::test_suite("shared meshes")) {
  const auto folder = shared_meshes();
  for (const char* name : {"spot", "homer", "fandisk", "cheburashka", "rocker-arm"}) {
    CAPTURE(name);
    check_bounds(build_lrb(read_mesh((folder / (std::string(name) + ".obj")).string())), 8);
  }
}

}  // namespace
}  // namespace lrb::test
