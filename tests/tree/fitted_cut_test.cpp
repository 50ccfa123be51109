// Where a tree cuts its simplices in two: against all cuts, one by one.
#include "engine/tree/fitted_cut.hpp"

#include <algorithm>
#include <numeric>

#include <doctest/doctest.h>

#include "engine/core/infinity.hpp"
#include "engine/tree/obb_tree.hpp"
#include "scenarios/bodies/shapes/random_pose.hpp"

using namespace lrb;
using Eigen::Vector3d;
using shapes::RandomEngine;

namespace {

/// Loose triangles, each with corners of its own.
struct Triangles {
  std::vector<Vector3d> points;
  std::vector<SimplexId> ids;

  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    points.insert(points.end(), {a, b, c});
    ids.push_back(static_cast<SimplexId>(ids.size()));
  }

  Soup soup() const {
    SimplexView view;
    view.vertices = points;
    view.real_count = static_cast<std::uint32_t>(ids.size());
    view.corners_of = [](const void*, SimplexId s, VertexId* v) {
      for (std::uint32_t k = 0; k < 3; ++k) v[k] = static_cast<VertexId>(3 * s.value() + k);
    };
    return {view, ids, 1};
  }
};

double fitted_area(const Soup& soup, std::span<const std::uint32_t> some) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t s : some) box.extend(soup.box[s]);
  return half_area(box_in_frame(soup, some, fit_frame(soup, some, box)));
}

double cost(const Soup& soup, std::span<const std::uint32_t> order, std::size_t left) {
  const auto leaves = [](std::size_t n) { return static_cast<double>((n + kTreeWidth - 1) / kTreeWidth); };
  const std::size_t right = order.size() - left;
  return fitted_area(soup, order.first(left)) * leaves(left) +
         fitted_area(soup, order.last(right)) * leaves(right);
}

/// Returns the least cost of all cuts across the coordinate axes.
double least_cost(const Soup& soup) {
  double least = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t> order = soup.order;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t s, std::uint32_t t) { return soup.centre[s][axis] < soup.centre[t][axis]; });
    for (std::size_t left = kTreeWidth; left < order.size(); left += kTreeWidth)
      least = std::min(least, cost(soup, order, left));
  }
  return least;
}

bool holds_all(std::vector<std::uint32_t> order) {
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i)
    if (order[i] != i) return false;
  return true;
}

}  // namespace

TEST_CASE("of all cuts across the coordinate axes that one is found whose halves have the smallest boxes") {
  RandomEngine random(5);
  for (const int count : {9, 16, 17, 40, 200}) {
    Triangles triangles;
    // A bent strip in a pose of its own, so that boxes on the coordinate axes fit its parts badly.
    const Eigen::Matrix3d turn = shapes::random_rotation(random);
    for (int i = 0; i < count; ++i) {
      const double x = 0.9 * i / count, size = shapes::uniform(random, 0.01, 0.1);
      const Vector3d middle = turn * Vector3d(x, x * x, shapes::uniform(random, 0, 0.1));
      Vector3d corner[3];
      for (Vector3d& c : corner) c = middle + size * shapes::random_direction(random);
      triangles.add(corner[0], corner[1], corner[2]);
    }
    Soup soup = triangles.soup();
    const double least = least_cost(soup);
    const CutEffort everything{.principal = 0, .tried = 10'000};
    const std::uint32_t left = cut_by_fitted_boxes(soup, soup.order, everything);
    CAPTURE(count);
    REQUIRE(left % kTreeWidth == 0);
    REQUIRE(left > 0);
    REQUIRE(left < soup.order.size());
    CHECK(holds_all(soup.order));
    CHECK(cost(soup, soup.order, left) == doctest::Approx(least).epsilon(1e-5));
    // More directions and fewer trials: no worse than twice that here, and mostly better.
    Soup again = triangles.soup();
    const std::uint32_t guessed = cut_by_fitted_boxes(again, again.order, {.principal = 3, .tried = 4});
    CHECK(holds_all(again.order));
    CHECK(cost(again, again.order, guessed) < 2 * least);
  }
}

TEST_CASE("two plates side by side are parted, however they lie") {
  RandomEngine random(6);
  for (int round = 0; round < 20; ++round) {
    const Eigen::Matrix3d turn = shapes::random_rotation(random);
    Triangles triangles;
    for (int i = 0; i < 64; ++i) {  // even ones on one plate, odd ones on the other
      const Vector3d at(0.1 * (i / 2 % 8), 0.1 * (i / 16), i % 2 * 0.5);
      triangles.add(turn * at, turn * (at + Vector3d(0.1, 0, 0)), turn * (at + Vector3d(0, 0.1, 0)));
    }
    Soup soup = triangles.soup();
    const std::uint32_t left = cut_by_fitted_boxes(soup, soup.order, {.principal = 3, .tried = 32});
    CHECK(left == 32);
    const auto plate = [&](std::uint32_t i) { return soup.order[i] % 2; };
    bool parted = true;
    for (std::uint32_t i = 0; i < 64; ++i) parted &= plate(i) == (i < 32 ? plate(0) : 1 - plate(0));
    CHECK(parted);
  }
}

TEST_CASE(
    "simplices at one point, in one line or all alike can be cut, or it is said that nothing tells how") {
  const CutEffort effort{.principal = 3, .tried = 4};
  Triangles point, line, alike;
  for (int i = 0; i < 20; ++i) {
    const Vector3d a(0.5, 0.25, 0.125), b(0.5 + 0.01 * i, 0.25, 0.125);
    point.add(a, a, a);
    line.add(a, b, b);
    alike.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  }
  Soup soup = point.soup();
  CHECK(cut_by_fitted_boxes(soup, soup.order, effort) == 0);
  for (const Triangles* some : {&line, &alike}) {
    Soup other = some->soup();
    const std::uint32_t left = cut_by_fitted_boxes(other, other.order, effort);
    CHECK((left == 8 || left == 16));
    CHECK(holds_all(other.order));
  }
}
