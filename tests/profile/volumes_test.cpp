#include "scenarios/profile/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/captured_trees.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/error.hpp>

using namespace lrb;
using capture::VolumeKind;
using Eigen::Vector3d;
using profile::Volumes;

namespace {

/// Returns a tree of one node with this volume.
capture::Tree one_node(VolumeKind kind, std::vector<double> numbers, std::vector<Vector3d> directions = {}) {
  capture::Tree t;
  t.volume = kind;
  t.first_child = t.first_triangle = {0, 0};
  t.volumes = std::move(numbers);
  t.directions = std::move(directions);
  return t;
}

std::vector<double> numbers_of(const std::vector<Vector3d>& points) {
  std::vector<double> out;
  for (const Vector3d& p : points) out.insert(out.end(), p.data(), p.data() + 3);
  return out;
}

/// Returns a random OBB, of which `flat` half axes are zero.
capture::Tree random_obb(shapes::RandomEngine& random, int flat = 0) {
  const Eigen::Matrix3d r = shapes::random_rotation(random);
  std::vector<Vector3d> numbers = {1.3 * shapes::random_direction(random)};
  for (int k = 0; k < 3; ++k) {
    const double length = k < flat ? 0 : shapes::uniform(random, 0.1, 1);
    numbers.push_back(length * r.col(k));
  }
  std::swap(numbers[1], numbers[1 + static_cast<std::size_t>(shapes::uniform(random, 0, 3))]);
  return one_node(VolumeKind::obb, numbers_of(numbers));
}

capture::Tree random_rss(shapes::RandomEngine& random, int flat = 0) {
  const Eigen::Matrix3d r = shapes::random_rotation(random);
  std::vector<double> numbers = numbers_of({1.3 * shapes::random_direction(random),
                                            shapes::uniform(random, 0.1, 1) * r.col(0) * (flat < 2),
                                            shapes::uniform(random, 0.1, 1) * r.col(1) * (flat < 1)});
  numbers.push_back(shapes::uniform(random, 0.05, 0.5));
  return one_node(VolumeKind::rss, numbers);
}

/// Returns the k-DOP of random points.
capture::Tree random_kdop(shapes::RandomEngine& random, int points = 8) {
  std::vector<Vector3d> all;
  const Vector3d centre = shapes::random_direction(random);
  for (int i = 0; i < points; ++i)
    all.emplace_back(centre + shapes::random_direction(random).cwiseProduct(Vector3d(1, 0.7, 0.4)));
  const std::vector<double> numbers = test::volume_around(VolumeKind::kdop, all, Eigen::Matrix3d::Identity());
  return one_node(VolumeKind::kdop, numbers, test::directions_of_18());
}

/// Returns a random volume of a kind, flat if it may be.
capture::Tree random_volume(shapes::RandomEngine& random, VolumeKind kind, int flat = 0) {
  const auto number = [&] { return shapes::uniform(random); };
  switch (kind) {
    case VolumeKind::obb:
      return random_obb(random, flat);
    case VolumeKind::rss:
      return random_rss(random, flat);
    case VolumeKind::kdop:
      return random_kdop(random, 12);
    case VolumeKind::sphere:
      return one_node(kind, {number(), 0, 0, 0.2 + number()});
    case VolumeKind::aabb:
      break;
  }
  return one_node(kind, {0, number(), 0, 1, 2, number()});
}

/// Returns a tree of two nodes with the volumes of two trees.
capture::Tree both(capture::Tree a, const capture::Tree& b) {
  a.volumes.insert(a.volumes.end(), b.volumes.begin(), b.volumes.end());
  a.first_child = a.first_triangle = {0, 0, 0};
  return a;
}

constexpr VolumeKind kKinds[] = {VolumeKind::aabb, VolumeKind::sphere, VolumeKind::obb, VolumeKind::rss,
                                 VolumeKind::kdop};

Vector3d random_point(shapes::RandomEngine& random, const trace::ShapeBox& box, double reach = 1) {
  Vector3d p = box.centre;
  for (const Vector3d& half : box.half) p += shapes::uniform(random, -reach, reach) * half;
  return p;
}

/// Returns the volume's share of its box, estimated from points, times the box's volume.
double sampled_volume(shapes::RandomEngine& random, const Volumes& v, int samples) {
  const trace::ShapeBox box = v.box(0);
  int inside = 0;
  for (int i = 0; i < samples; ++i) inside += v.outside(0, random_point(random, box)) == 0;
  return 8 * box.half[0].norm() * box.half[1].norm() * box.half[2].norm() * inside / samples;
}

/// A triangle whose corners are one where they differ by rounding, so that its area is 0 if it has none.
test::Points triangle(test::Points t) {
  for (std::size_t i = 1; i < 3; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if ((t[i] - t[k]).norm() < 1e-12) t[i] = t[k];
  return t;
}

/// Two triangles for each side of a box, whose corners are numbered by three bits.
std::vector<test::Points> sides(const Volumes& box, const Pose& pose) {
  const std::vector<Vector3d> c = box.corners(0);
  std::vector<test::Points> out;
  for (unsigned axis = 0; axis < 3; ++axis)
    for (const unsigned high : {0U, 1U << axis}) {
      const unsigned u = 1U << (axis + 1) % 3, v = 1U << (axis + 2) % 3;
      const Vector3d p = pose.apply(c[high]), q = pose.apply(c[high | u]), r = pose.apply(c[high | v]),
                     s = pose.apply(c[high | u | v]);
      out.push_back(triangle({p, q, s}));
      out.push_back(triangle({p, r, s}));
    }
  return out;
}

/// The rectangle of an RSS, in two triangles.
std::vector<test::Points> rectangle(const capture::Tree& t) {
  const double* const n = t.volumes.data();
  const Vector3d p(n[0], n[1], n[2]), u(n[3], n[4], n[5]), v(n[6], n[7], n[8]);
  return {triangle({p, p + u, p + u + v}), triangle({p, p + v, p + u + v})};
}

/// The distance of two surfaces, which may cross.
double distance_of(const std::vector<test::Points>& a, const std::vector<test::Points>& b) {
  for (const test::Points& s : a)
    for (const test::Points& t : b)
      if (test::meet_of(s, t) != exact::Meet::disjoint) return 0;
  return test::surface_distance(a, b);
}

}  // namespace

TEST_CASE("area and volume of k-DOPs are those of their polytopes") {
  SUBCASE("a box") {
    const capture::Tree t = one_node(VolumeKind::kdop, {0, 2, 0, 3, 0, 4}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    CHECK(Volumes(t).size(0).area == doctest::Approx(52).epsilon(1e-12));
    CHECK(Volumes(t).size(0).volume == doctest::Approx(24).epsilon(1e-12));
  }
  SUBCASE("a cube without two corners, along a direction that has not unit length; repeated directions") {
    const capture::Tree t = one_node(VolumeKind::kdop, {-1, 1, -1, 1, -1, 1, -2, 2, -4, 4, -2, 2},
                                     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {-2, -2, -2}, {0, 2, 0}});
    CHECK(Volumes(t).size(0).area == doctest::Approx(24 - 3 + std::sqrt(3.0)).epsilon(1e-12));
    CHECK(Volumes(t).size(0).volume == doctest::Approx(8 - 2.0 / 6).epsilon(1e-12));
  }
  SUBCASE("planes that only touch an edge or a corner change nothing") {
    const capture::Tree t = one_node(VolumeKind::kdop, {-1, 1, -1, 1, -1, 1, -2, 2, -3, 3},
                                     {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}});
    CHECK(Volumes(t).size(0).area == doctest::Approx(24).epsilon(1e-12));
    CHECK(Volumes(t).size(0).volume == doctest::Approx(8).epsilon(1e-12));
  }
  SUBCASE("of random points, against sampling") {
    shapes::RandomEngine random(5);
    for (int i = 0; i < 5; ++i) {
      const capture::Tree t = random_kdop(random);
      const Volumes v(t);
      CHECK(v.size(0).volume == doctest::Approx(sampled_volume(random, v, 100'000)).epsilon(0.03));
      for (const Vector3d& p : v.corners(0)) CHECK(v.outside(0, p) < 1e-11);
    }
  }
  SUBCASE("of points in a plane that is no coordinate plane: both sides") {
    const capture::Tree t =
        one_node(VolumeKind::kdop, {0, 1, 0, 1, 0, 2, 1, 1}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}});
    CHECK(Volumes(t).size(0).area == doctest::Approx(2 * 2 * std::sqrt(2.0)).epsilon(1e-9));
    CHECK(Volumes(t).size(0).volume == doctest::Approx(0));
    CHECK_FALSE(Volumes(t).empty(0));
  }
  SUBCASE("of a point, and of nothing") {
    const std::vector<Vector3d> d = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    const capture::Tree point = one_node(VolumeKind::kdop, {1, 1, 2, 2, 3, 3, 6, 6}, d);
    CHECK(Volumes(point).size(0).area == doctest::Approx(0));
    CHECK_FALSE(Volumes(point).empty(0));
    const capture::Tree inverted = one_node(VolumeKind::kdop, {1, 0, 2, 2, 3, 3, 6, 6}, d);
    CHECK(Volumes(inverted).empty(0));
    CHECK(Volumes(inverted).size(0).area == 0);
    const capture::Tree beyond = one_node(VolumeKind::kdop, {0, 1, 0, 1, 0, 1, 4, 5}, d);
    CHECK(Volumes(beyond).empty(0));
    CHECK(Volumes(beyond).size(0).volume == 0);
  }
  SUBCASE("directions in a plane are refused") {
    const capture::Tree t = one_node(VolumeKind::kdop, {0, 1, 0, 1, 0, 1}, {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    CHECK_THROWS_WITH_AS(Volumes{t},
                         "tree 0: expected directions of its k-DOPs that span space, found 3 in one plane; "
                         "report at least three independent ones",
                         InputError);
  }
}

TEST_CASE("volumes with a greatest below a least coordinate, or a negative radius, are empty") {
  for (const capture::Tree& t :
       {one_node(VolumeKind::aabb, {0, 2, 0, 1, 1, 1}), one_node(VolumeKind::sphere, {0, 0, 0, -1}),
        one_node(VolumeKind::rss, {0, 0, 0, 1, 0, 0, 0, 1, 0, -0.1})}) {
    CHECK(Volumes(t).empty(0));
    CHECK(Volumes(t).size(0).volume == 0);
    CHECK_FALSE(overlap(Volumes(t), 0, {}, Volumes(t), 0, {}));
  }
}

TEST_CASE("how far a point lies outside is its distance to the nearest point of the volume") {
  shapes::RandomEngine random(7);
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const capture::Tree obb = random_obb(random, i % 4), rss = random_rss(random, i % 3),
                        kdop = random_kdop(random);
    const trace::ShapeBox box = Volumes(obb).box(0);
    const Vector3d p = box.centre + shapes::uniform(random, 0, 1.5) * shapes::random_direction(random);
    const std::vector<test::Points> point = {{p, p, p}};
    const double found = Volumes(obb).outside(0, p), to_sides = distance_of(point, sides(Volumes(obb), {}));
    if (found > 0) CHECK(found == doctest::Approx(to_sides).epsilon(1e-9));
    for (const Vector3d& half : box.half)
      if (found == 0) CHECK(std::abs((p - box.centre).dot(half)) <= half.squaredNorm() * (1 + 1e-9) + 1e-12);
    inside += found == 0;
    const double to_rectangle = distance_of(point, rectangle(rss));
    CHECK(Volumes(rss).outside(0, p) ==
          doctest::Approx(std::max(0.0, to_rectangle - rss.volumes[9])).epsilon(1e-9));
    double most = 0;
    for (const auto& h : Volumes(kdop).half_spaces(0)) most = std::max(most, h.normal.dot(p) - h.offset);
    CHECK(Volumes(kdop).outside(0, p) == doctest::Approx(most));
  }
  CHECK(inside > 5);
}

TEST_CASE("the gap of two boxes is the distance of their sides, of flat ones too, and 0 if they overlap") {
  shapes::RandomEngine random(12);
  int apart = 0, met = 0;
  for (int i = 0; i < 1500; ++i) {
    const capture::Tree a = random_obb(random, i % 4);
    capture::Tree b = random_obb(random, i / 4 % 4);
    if (i % 3 == 0) b.volumes = a.volumes;  // parallel, coplanar and coincident sides
    const Volumes x(a), y(b);
    const Vector3d by = (i % 4) * shapes::random_direction(random);
    const Pose pose =
        i % 5 == 0 ? Pose::translation(i % 2 ? by : i % 4 * x.box(0).half[1])
                   : Pose::rotation(shapes::random_direction(random), shapes::uniform(random, 0, 3), by);
    const double found = gap(x, 0, {}, y, 0, pose), to_sides = distance_of(sides(x, {}), sides(y, pose));
    CHECK((found == 0) == overlap(x, 0, {}, y, 0, pose));
    const Pose back{pose.r.transpose(), -(pose.r.transpose() * pose.t)};
    const bool held =
        x.outside(0, pose.apply(y.box(0).centre)) == 0 || y.outside(0, back.apply(x.box(0).centre)) == 0;
    met += to_sides == 0;
    if (to_sides < 1e-9 && found < 1e-9) continue;  // within rounding of contact, or crossing
    if (!held || found > 0) CHECK(found == doctest::Approx(to_sides).epsilon(1e-7));
    apart += found > 0;
  }
  CHECK(apart > 200);
  CHECK(met > 100);
}

TEST_CASE("rounded rectangles overlap from the distance of their rectangles on") {
  shapes::RandomEngine random(17);
  for (int i = 0; i < 300; ++i) {
    capture::Tree a = random_rss(random, i % 3), b = random_rss(random, i / 3 % 3);
    if (i % 4 == 0)  // rectangles that cross
      for (std::size_t k = 0; k < 3; ++k)
        b.volumes[k] =
            a.volumes[k] + 0.5 * (a.volumes[3 + k] + a.volumes[6 + k] - b.volumes[3 + k] - b.volumes[6 + k]);
    const double distance = distance_of(rectangle(a), rectangle(b));
    a.volumes[9] = 0;
    b.volumes[9] = distance * (1 + 1e-7) + 1e-9;
    CHECK(overlap(Volumes(a), 0, {}, Volumes(b), 0, {}));
    b.volumes[9] = distance * (1 - 1e-7) - 1e-9;
    if (b.volumes[9] >= 0) CHECK_FALSE(overlap(Volumes(a), 0, {}, Volumes(b), 0, {}));
  }
}

TEST_CASE("how far a volume extends beyond another is the farthest of its points") {
  shapes::RandomEngine random(19);
  for (int i = 0; i < 40; ++i)
    for (const VolumeKind kind : kKinds) {
      const capture::Tree t = both(random_volume(random, kind, i % 3), random_volume(random, kind, i % 3));
      const Volumes v(t);
      const double found = v.excess(0, 1);
      double sampled = 0;
      for (int j = 0; j < 3000; ++j) {
        const Vector3d p = random_point(random, v.box(0));
        if (v.outside(0, p) < 1e-12) sampled = std::max(sampled, v.outside(1, p));
      }
      CHECK(found >= sampled - 1e-12);
      CHECK(found <= sampled + 0.4);
      CHECK(v.excess(0, 0) < 1e-12);
    }
}

TEST_CASE("the volume that two share is that found by sampling") {
  shapes::RandomEngine random(23);
  for (int i = 0; i < 25; ++i) {
    const VolumeKind kind = kKinds[i % 5];
    const capture::Tree t = both(random_volume(random, kind), random_volume(random, kind));
    const Volumes v(t);
    const auto shared = v.shared_volume(0, 1);
    CHECK(shared.has_value() == (kind != VolumeKind::rss));
    if (!shared) continue;
    const trace::ShapeBox box = v.box(0);
    constexpr int kSamples = 40'000;
    int inside = 0;
    for (int j = 0; j < kSamples; ++j) {
      const Vector3d p = random_point(random, box);
      inside += v.outside(0, p) == 0 && v.outside(1, p) == 0;
    }
    const double of_box = 8 * box.half[0].norm() * box.half[1].norm() * box.half[2].norm();
    CHECK(std::abs(*shared / of_box - static_cast<double>(inside) / kSamples) < 0.012);
    CHECK(*shared == doctest::Approx(*v.shared_volume(1, 0)));
    CHECK(*v.shared_volume(1, 1) == doctest::Approx(v.size(1).volume));
  }
}
