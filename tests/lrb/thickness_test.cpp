// Proven deviations of lids from the body, against dense sampling and exact distances.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/lrb_shapes.hpp"
#include "tests/support/shared_meshes.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::test {
namespace {

using namespace shapes;
using boost::multiprecision::cpp_rational;
using Eigen::Vector3d;

/// The real faces in a grid, to find the nearest of many. Shares no code with the engine.
class Surface {
 public:
  explicit Surface(const LrbRep& rep) {
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      simplices_.push_back(simplex_points(rep, Pose{}, s));
      Eigen::AlignedBox3d own;
      for (const Vector3d& x : simplices_.back()) own.extend(x);
      balls_.push_back({own.center(), own.diagonal().norm() / 2});
      box_.extend(own);
    }
    cells_per_side_ =
        std::clamp(static_cast<int>(std::cbrt(static_cast<double>(simplices_.size()) / 2)), 2, 40);
    cell_ = (box_.sizes() / cells_per_side_).cwiseMax(size() * 1e-9);
    cells_.resize(cells_per_side_ * cells_per_side_ * cells_per_side_);
    for (std::uint32_t s = 0; s < simplices_.size(); ++s) {
      Eigen::AlignedBox3d own;
      for (const Vector3d& x : simplices_[s]) own.extend(x);
      const Eigen::Vector3i low = cell_of(own.min()), high = cell_of(own.max());
      for (int i = low.x(); i <= high.x(); ++i)
        for (int j = low.y(); j <= high.y(); ++j)
          for (int k = low.z(); k <= high.z(); ++k) cells_[number({i, j, k})].push_back(s);
    }
  }

  double size() const { return box_.sizes().maxCoeff(); }

  double distance(const Vector3d& p) const { return distance_to(p, nearest(p)); }

  /// Looks at cells in rings round p's own until none that is left can be nearer.
  const Points& nearest(const Vector3d& p) const {
    const Eigen::Vector3i at = cell_of(p);
    double best = INFINITY;
    std::uint32_t found = 0;
    for (int ring = 0; ring < cells_per_side_; ++ring) {
      if (best <= (ring - 1) * smallest_side()) break;
      for (int i = at.x() - ring; i <= at.x() + ring; ++i)
        for (int j = at.y() - ring; j <= at.y() + ring; ++j)
          for (int k = at.z() - ring; k <= at.z() + ring; ++k) {
            const Eigen::Vector3i c(i, j, k);
            if ((c - at).cwiseAbs().maxCoeff() != ring) continue;
            if (c.minCoeff() < 0 || c.maxCoeff() >= cells_per_side_) continue;
            for (const std::uint32_t s : cells_[number(c)]) {
              if ((p - balls_[s].centre).norm() - balls_[s].radius >= best) continue;
              const double d = distance_to(p, simplices_[s]);
              if (d < best) best = d, found = s;
            }
          }
    }
    return simplices_[found];
  }

 private:
  struct Ball {
    Vector3d centre;
    double radius;
  };

  static double distance_to(const Vector3d& p, const Points& s) {
    return s.size() == 3 ? point_triangle(p, s) : point_segment(p, s[0], s[1]);
  }
  double smallest_side() const {
    double least = INFINITY;
    for (int k = 0; k < 3; ++k)
      if (box_.sizes()[k] > 0) least = std::min(least, cell_[k]);
    return least;
  }
  Eigen::Vector3i cell_of(const Vector3d& p) const {
    Eigen::Vector3i out;
    for (int k = 0; k < 3; ++k)
      out[k] = std::clamp(static_cast<int>((p[k] - box_.min()[k]) / cell_[k]), 0, cells_per_side_ - 1);
    return out;
  }
  std::size_t number(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.x()) * cells_per_side_ + c.y()) * cells_per_side_ + c.z();
  }

  std::vector<Points> simplices_;
  std::vector<Ball> balls_;  ///< round the simplices
  Eigen::AlignedBox3d box_;
  int cells_per_side_;
  Vector3d cell_;
  std::vector<std::vector<std::uint32_t>> cells_;
};

std::vector<Points> lids_of(const LrbRep& rep, RegionId r) {
  std::vector<Points> out;
  for (const FaceId f : rep.lids(r))
    for (std::size_t i = 0; i < Mesh::simplices_of(rep.face(f).size(), rep.dim()); ++i)
      out.push_back(simplex_points(rep, Pose{}, SimplexId(rep.first_simplex(f) + i)));
  return out;
}

/// Returns the largest distance from the surface that is found on a region's lids, at points no further apart
/// than a `parts`th of a lid's side, nor than a hundredth of the body's.
double sampled_thickness(const LrbRep& rep, RegionId r, const Surface& surface, int parts) {
  double most = 0;
  for (const Points& t : lids_of(rep, r)) {
    double side = 0;
    for (std::size_t k = 0; k < t.size(); ++k) side = std::max(side, (t[(k + 1) % t.size()] - t[k]).norm());
    const int n = std::max(parts, static_cast<int>(100 * side / surface.size()));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= (t.size() == 3 ? n - i : 0); ++j) {
        Vector3d p = t[0] + (t[1] - t[0]) * i / n;
        if (t.size() == 3) p += (t[2] - t[0]) * j / n;
        most = std::max(most, surface.distance(p));
      }
  }
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
  const Surface surface(rep);
  const std::vector<double> proved = region_thickness(rep);
  REQUIRE(proved.size() == rep.region_count());
  std::vector<double> sampled(rep.region_count());
  std::size_t far = 0;
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    sampled[r] = sampled_thickness(rep, r, surface, parts);
    CAPTURE(r);
    REQUIRE(proved[r] >= sampled[r] * (1 - 1e-9));
    far += proved[r] > kNear * sampled[r] + 1e-6 * surface.size();
  }
  CHECK(10 * far <= rep.region_count());
  const std::vector<double> needed = with_hidden(rep, proved), found = with_hidden(rep, sampled);
  for (const double share : {0.002, 0.005, 0.01, 0.02, 0.05, 0.1}) {
    double bound = 0, distance = 0;
    for (RegionId r = 0; r < rep.region_count(); ++r) {
      if (needed[r] > share * surface.size()) continue;
      bound = std::max(bound, needed[r]);
      distance = std::max(distance, found[r]);
    }
    CAPTURE(share);
    CHECK(bound <= kNear * distance + 1e-6 * surface.size());
  }
}

cpp_rational exact(double x) {
  return cpp_rational(x);
}

using Rational3 = std::array<cpp_rational, 3>;

Rational3 exact(const Vector3d& v) {
  return {exact(v.x()), exact(v.y()), exact(v.z())};
}
Rational3 operator-(const Rational3& a, const Rational3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
cpp_rational dot(const Rational3& a, const Rational3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

cpp_rational square_to_segment(const Rational3& p, const Rational3& a, const Rational3& b) {
  const Rational3 d = b - a, w = p - a;
  const cpp_rational length = dot(d, d);
  cpp_rational t = length == 0 ? cpp_rational(0) : dot(w, d) / length;
  if (t < 0) t = 0;
  if (t > 1) t = 1;
  const Rational3 rest = {w[0] - t * d[0], w[1] - t * d[1], w[2] - t * d[2]};
  return dot(rest, rest);
}

cpp_rational square_to(const Rational3& p, const Points& s) {
  const Rational3 a = exact(s[0]), b = exact(s[1]);
  if (s.size() == 2) return square_to_segment(p, a, b);
  const Rational3 c = exact(s[2]), u = b - a, v = c - a, w = p - a;
  const cpp_rational uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const cpp_rational det = uu * vv - uv * uv;
  if (det != 0) {
    const cpp_rational x = (wu * vv - wv * uv) / det, y = (wv * uu - wu * uv) / det;
    if (x >= 0 && y >= 0 && x + y <= 1) {
      const Rational3 rest = {w[0] - x * u[0] - y * v[0], w[1] - x * u[1] - y * v[1],
                              w[2] - x * u[2] - y * v[2]};
      return dot(rest, rest);
    }
  }
  return std::min({square_to_segment(p, a, b), square_to_segment(p, b, c), square_to_segment(p, c, a)});
}

/// Points of lids that are exact combinations of their corners, and exact distances from the nearest real
/// face. (If rounding names another one, its distance is larger, which asks for more.)
void check_exactly(const LrbRep& rep, RandomEngine& random) {
  const Surface surface(rep);
  const std::vector<double> proved = region_thickness(rep);
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    for (const Points& lid : lids_of(rep, r)) {
      const int a = static_cast<int>(random() % 9), b = static_cast<int>(random() % (9 - a));
      const cpp_rational weights[3] = {cpp_rational(a) / 8, cpp_rational(lid.size() == 3 ? b : 8 - a) / 8,
                                       cpp_rational(lid.size() == 3 ? 8 - a - b : 0) / 8};
      Rational3 p = {0, 0, 0};
      for (std::size_t k = 0; k < lid.size(); ++k) {
        const Rational3 x = exact(lid[k]);
        for (int i = 0; i < 3; ++i) p[i] += weights[k] * x[i];
      }
      const Vector3d near(p[0].convert_to<double>(), p[1].convert_to<double>(), p[2].convert_to<double>());
      const cpp_rational least = square_to(p, surface.nearest(near));
      CAPTURE(r);
      REQUIRE(least <= exact(proved[r]) * exact(proved[r]));
    }
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
