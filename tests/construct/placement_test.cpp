#include <limits>
#include <random>

#include <Eigen/LU>
#include <doctest/doctest.h>

#include "engine/construct/half_spaces.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

/// The nearest of the points that are nearest to the target on the target itself, on a plane, on a line of
/// two planes or at a corner of three, and that all half-spaces hold.
double distance_by_brute_force(const Vector3& target, const std::vector<HalfSpace>& hs) {
  double best = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vector3& p) {
    for (const HalfSpace& h : hs)
      if (h.n.dot(p) < h.d - 1e-9) return;
    best = std::min(best, (p - target).norm());
  };
  consider(target);
  for (std::size_t i = 0; i < hs.size(); ++i) {
    consider(target + hs[i].n * (hs[i].d - hs[i].n.dot(target)));
    for (std::size_t j = 0; j < i; ++j) {
      Eigen::Matrix<double, 2, 3> a;
      a << hs[i].n.transpose(), hs[j].n.transpose();
      const Eigen::Vector2d missing = Eigen::Vector2d(hs[i].d, hs[j].d) - a * target;
      consider(target + a.transpose() * (a * a.transpose()).inverse() * missing);
      for (std::size_t k = 0; k < j; ++k) {
        Eigen::Matrix3d b;
        b << hs[i].n.transpose(), hs[j].n.transpose(), hs[k].n.transpose();
        if (std::abs(b.determinant()) > 1e-9) consider(b.inverse() * Vector3(hs[i].d, hs[j].d, hs[k].d));
      }
    }
  }
  return best;
}

TEST_CASE("nearest_point agrees with trying all planes, lines and corners") {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  int found = 0, empty = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<HalfSpace> hs;
    for (int i = 0; i < 3 + round % 9; ++i)
      hs.push_back({Vector3(normal(random), normal(random), normal(random)).normalized(), normal(random)});
    const Vector3 target(normal(random), normal(random), normal(random));
    const auto p = nearest_point(target, hs, 1e-12);
    const double expected = distance_by_brute_force(target, hs);
    CAPTURE(round);
    REQUIRE(p.has_value() == std::isfinite(expected));
    if (p) CHECK((*p - target).norm() == doctest::Approx(expected).epsilon(1e-6));
    (p ? found : empty) += 1;
  }
  CHECK(found > 100);
  CHECK(empty > 100);
}

TEST_CASE("nearest_point: opposite half-spaces without a point between them") {
  std::vector<HalfSpace> hs = {{Vector3::UnitX(), 1}, {-Vector3::UnitX(), 1}};
  CHECK_FALSE(nearest_point(Vector3::Zero(), hs, 1e-12));
}

}  // namespace
}  // namespace lrb::construct
