#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <boost/multiprecision/cpp_int.hpp>
#include <doctest/doctest.h>

#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "tests/support/contact_oracle.hpp"
#include "tests/support/random_simplices.hpp"
#include <lrbscope/contact.hpp>

using namespace lrb;
using exact::ContactCorner;
using exact::Feature;
using exact::PairContact;
using lrb::test::Kind;
using Simplex = oracle::Points<oracle::cpp_rational>;

namespace {

/// A feature as a bit set of corners.
unsigned corners_of(const Feature& f, std::size_t n) {
  if (f.dim == 0) return 1u << f.index;
  if (f.dim == 1) return 1u << f.index | 1u << ((f.index + 1u) % n);
  return (1u << n) - 1;
}

/// Least dimension: a face with fewer corners must not hold the point.
bool is_least_feature(const Simplex& s, const Feature& f, const oracle::Point<oracle::cpp_rational>& x) {
  const unsigned face = corners_of(f, s.size());
  if (!oracle::holds(s, face, x)) return false;
  for (unsigned other = 1; other < (1u << s.size()); ++other) {
    if (std::popcount(other) < std::popcount(face) && oracle::holds(s, other, x)) return false;
  }
  return true;
}

/// Within the accuracy promised, taking the largest extent of both simplices along the axis.
bool is_close(const ContactCorner& c, const oracle::Point<oracle::cpp_rational>& x,
              const test::SimplexPair& s) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    const auto [low, high] = std::minmax_element(s.p.begin(), s.p.end(),
                                                 [k](const auto& p, const auto& q) { return p[k] < q[k]; });
    const oracle::cpp_rational extent = oracle::cpp_rational((*high)[k]) - oracle::cpp_rational((*low)[k]);
    const double size = std::max(std::fabs((*low)[k]), std::fabs((*high)[k]));
    const oracle::cpp_rational bound = extent * oracle::cpp_rational(1e-13) +
                                       oracle::cpp_rational(size) * oracle::cpp_rational(0x1p-52) +
                                       oracle::cpp_rational(4.9e-324);
    if (!std::isfinite(c.x[static_cast<Eigen::Index>(k)])) return false;
    if (abs(oracle::cpp_rational(c.x[static_cast<Eigen::Index>(k)]) - x[k]) > bound) return false;
  }
  return true;
}

/// The extreme points of the intersection. Of degenerate simplices it is a point or segment, of which every
/// point that was found may be listed, so the lexicographic extremes are kept.
oracle::Points<oracle::cpp_rational> extreme_points(const Simplex& a, const Simplex& b, bool degenerate) {
  oracle::Points<oracle::cpp_rational> r;
  for (const auto& c : oracle::intersection_corners(a, b)) r.push_back(c.x);
  std::sort(r.begin(), r.end());
  r.erase(std::unique(r.begin(), r.end()), r.end());
  if (degenerate && r.size() > 2) r = {r.front(), r.back()};
  return r;
}

/// The corner of the contact that is this point: closest, and with the right features.
bool has_corner(const PairContact& c, const oracle::Point<oracle::cpp_rational>& x, const Simplex& a,
                const Simplex& b, const test::SimplexPair& s) {
  return std::any_of(c.corners.begin(), c.corners.begin() + c.corner_count, [&](const ContactCorner& k) {
    return is_close(k, x, s) && is_least_feature(a, k.on_a, x) && is_least_feature(b, k.on_b, x);
  });
}

/// Every two neighbours lie on a common edge.
bool is_ordered(const PairContact& c, std::size_t n) {
  if (c.corner_count < 4) return true;
  const auto count = static_cast<std::size_t>(c.corner_count);
  for (std::size_t i = 0; i < count; ++i) {
    const ContactCorner &p = c.corners[i], &q = c.corners[(i + 1) % count];
    const unsigned a = corners_of(p.on_a, n) | corners_of(q.on_a, n);
    const unsigned b = corners_of(p.on_b, n) | corners_of(q.on_b, n);
    if (std::popcount(a) > 2 && std::popcount(b) > 2) return false;
  }
  return true;
}

std::string compare(const test::SimplexPair& s, std::size_t n) {
  const auto ca = s.a(), cb = s.b();
  const PairContact c = n == 3 ? exact::contact_of_triangles(ca.data(), cb.data())
                               : exact::contact_of_segments(ca.data(), cb.data());
  const exact::Meet meet =
      n == 3 ? exact::meet_triangles(ca.data(), cb.data()) : exact::meet_segments(ca.data(), cb.data());
  if (c.meet != meet) return "meet";
  if ((meet == exact::Meet::disjoint) != (c.corner_count == 0))
    return "corners without contact, or contact without";
  const auto p = oracle::to_integers({{ca.data(), ca.data() + n}, {cb.data(), cb.data() + n}}, n);
  oracle::Points<oracle::cpp_int> both = p[0];
  both.insert(both.end(), p[1].begin(), p[1].end());
  if (c.coplanar != (oracle::affine_dimension(both) < static_cast<int>(n))) return "coplanar";
  if (meet == exact::Meet::disjoint) return "";
  Simplex a, b;
  for (std::size_t i = 0; i < n; ++i) {
    a.push_back(oracle::to_rational_point(ca[i], n));
    b.push_back(oracle::to_rational_point(cb[i], n));
  }
  const int full = static_cast<int>(n) - 1;
  const auto expected =
      extreme_points(a, b, oracle::affine_dimension(p[0]) < full || oracle::affine_dimension(p[1]) < full);
  if (expected.size() != c.corner_count) return "number of corners";
  for (const auto& x : expected) {
    if (!has_corner(c, x, a, b, s)) return "a corner";
  }
  return is_ordered(c, n) ? "" : "order";
}

void compare_kinds(std::uint64_t seed, std::size_t n, int rounds) {
  int met = 0;
  std::string fault;
  test::for_each_kind(seed, rounds, 1, [&](test::Rng&, const test::SimplexPair& s, Kind) {
    const auto a = s.a(), b = s.b();
    met += (n == 3 ? exact::meet_triangles(a.data(), b.data()) : exact::meet_segments(a.data(), b.data())) !=
           exact::Meet::disjoint;
    const std::string found = compare(s, n);
    if (fault.empty()) fault = found;
    return found.empty();
  });
  CHECK(fault == "");
  CHECK(met > 0);
}

}  // namespace

TEST_CASE("contacts of triangles have the corners, features and order of the rational oracle") {
  compare_kinds(31, 3, 40);
}
TEST_CASE("contacts of segments have the corners and features of the rational oracle") {
  compare_kinds(32, 2, 100);
}

TEST_CASE("a star of two coplanar triangles has six corners") {
  const double p[6][3] = {{0, 0, 1}, {4, 0, 1}, {2, 3, 1}, {0, 2, 1}, {2, -1, 1}, {4, 2, 1}};
  const double* const a[3] = {p[0], p[1], p[2]};
  const double* const b[3] = {p[3], p[4], p[5]};
  const PairContact c = exact::contact_of_triangles(a, b);
  CHECK(c.corner_count == 6);
  CHECK(c.coplanar);
  CHECK(c.meet == exact::Meet::touch);
}

TEST_CASE("coordinates keep their accuracy where the planes are nearly parallel") {
  test::Rng rng(33);
  int met = 0;
  std::string fault;
  for (int i = 0; i < test::effort(600) && fault.empty(); ++i) {
    test::SimplexPair s;
    test::fill_real(rng, s);
    const double angle = std::ldexp(1.0, -test::random_int(rng, 10, 53));
    for (std::size_t j = 0; j < 6; ++j) {
      auto& p = s.p[j];
      p[2] = 0.3 * p[0] + 0.7 * p[1] + (j < 3 ? 0 : angle * (p[2] - 0.5));
    }
    const auto a = s.a(), b = s.b();
    if (exact::meet_triangles(a.data(), b.data()) != exact::Meet::cross) continue;
    ++met;
    fault = compare(s, 3);
  }
  CHECK_MESSAGE(fault.empty(), fault);
  CHECK(met > 0);
}

TEST_CASE("points of cuts that doubles cannot place are the exact ones, rounded once") {
  using Rational = boost::multiprecision::cpp_rational;
  std::mt19937_64 random(7);
  std::size_t exact_ones = 0;
  for (int i = 0; i < 4000; ++i) {
    // A segment nearly in the plane of a triangle; coordinates of one size, of mixed sizes, and so far apart
    // that integers of a fixed size do not hold them.
    const int spread = std::array{0, 40, 400}[static_cast<std::size_t>(i % 3)];
    const auto number = [&] {
      const double x = static_cast<double>(static_cast<std::int64_t>(random())) * 0x1p-63;
      return std::ldexp(x, spread == 0 ? 0 : static_cast<int>(random() % static_cast<unsigned>(spread)));
    };
    double t[3][3], p[3], q[3];
    for (auto& corner : t)
      for (double& x : corner) x = number();
    for (int k = 0; k < 3; ++k) {
      const double inside = t[0][k] + 0.25 * (t[1][k] - t[0][k]) + 0.5 * (t[2][k] - t[0][k]);
      p[k] = inside * (1 + 0x1p-50 * static_cast<double>(random() % 9));
      q[k] = (inside + 0.125 * (t[1][k] - t[0][k])) * (1 + 0x1p-50 * static_cast<double>(random() % 9));
    }
    const double* const corners[3] = {t[0], t[1], t[2]};
    if (exact::orient3d(t[0], t[1], t[2], p) * exact::orient3d(t[0], t[1], t[2], q) >= 0) continue;
    const auto height = [&](const double* x) {
      Rational sum = 0;
      for (int k = 0; k < 3; ++k) {
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        const auto along = [&](int corner, int axis) {
          return Rational(t[corner][axis]) - Rational(t[0][axis]);
        };
        sum += (along(1, u) * along(2, v) - along(1, v) * along(2, u)) * (Rational(x[k]) - Rational(t[0][k]));
      }
      return sum;
    };
    const Rational share = height(p) / (height(p) - height(q));
    const exact::PlaneSide plane(t[0], t[1], t[2]);
    const Eigen::Vector3d found =
        exact::cut_by_plane(p, plane.determinant(p), q, plane.determinant(q), corners);
    bool is_exact = true;
    for (int k = 0; k < 3; ++k) {
      const Rational x = Rational(p[k]) + share * (Rational(q[k]) - Rational(p[k]));
      is_exact = is_exact && found[k] == x.convert_to<double>();
      CHECK(std::abs(found[k] - x.convert_to<double>()) <=
            1e-13 * std::abs(q[k] - p[k]) + 1e-15 * std::abs(p[k]));
    }
    exact_ones += is_exact;
  }
  CHECK(exact_ones > 1000);
}
