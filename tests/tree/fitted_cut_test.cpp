// Where a tree cuts its simplices in two: against all cuts, one by one.

#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "engine/core/geometry.hpp"
#include "engine/tree/binary_tree.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/obb_tree.hpp>

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

  /// Refers to these.
  SimplexView view() const {
    SimplexView view;
    view.vertices = points;
    view.real_count = static_cast<std::uint32_t>(ids.size());
    view.corners_of = [](const void*, SimplexId s, VertexId* v) {
      for (std::uint32_t k = 0; k < 3; ++k) v[k] = static_cast<VertexId>(3 * s.value() + k);
    };
    return view;
  }

  Soup soup() const {
    Workers workers;
    return {view(), ids, 1, workers};
  }
};

double fitted_cost(const Soup& soup, std::span<const std::uint32_t> some) {
  Eigen::AlignedBox3d box;
  Spread spread;
  for (const std::uint32_t s : some) {
    box.extend(soup.box[s]);
    spread += soup.spread(s);
  }
  return std::min(box_cost(box),
                  box_cost(box_in_frame(soup, some, principal_frame(soup, some, spread, box))));
}

double cost(const Soup& soup, std::span<const std::uint32_t> order, std::size_t left) {
  const auto right = static_cast<std::uint32_t>(order.size() - left);
  return fitted_cost(soup, order.first(left)) * leaves_for(static_cast<std::uint32_t>(left)) +
         fitted_cost(soup, order.last(right)) * leaves_for(right);
}

/// Returns the least cost of all cuts of some simplices across the coordinate axes.
double min_cost(const Soup& soup, std::vector<std::uint32_t> some) {
  double least = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    std::sort(some.begin(), some.end(),
              [&](std::uint32_t s, std::uint32_t t) { return soup.centre(s)[axis] < soup.centre(t)[axis]; });
    for (std::size_t left = kTreeWidth; left < some.size(); left += kTreeWidth)
      least = std::min(least, cost(soup, some, left));
  }
  return least;
}

/// A cut of all of some triangles.
struct FirstCut {
  Soup soup;
  std::vector<std::uint32_t> order;
  std::uint32_t left;

  FirstCut(const Triangles& triangles, CutEffort effort) : soup(triangles.soup()) {
    FittedCuts cuts(soup, soup.order, effort);
    left = cuts.cut(0, static_cast<std::uint32_t>(soup.order.size())).boundary;
    order = cuts.order();
  }

  double cost() const { return ::cost(soup, order, left); }

  /// Returns true if one side holds exactly the first `count` triangles or the others.
  bool parts_first(std::uint32_t count) const {
    const auto is_first = [&](std::uint32_t s) { return s < count; };
    const auto on_left = std::span(order).first(left), on_right = std::span(order).subspan(left);
    return (std::ranges::all_of(on_left, is_first) && std::ranges::none_of(on_right, is_first)) ||
           (std::ranges::none_of(on_left, is_first) && std::ranges::all_of(on_right, is_first));
  }
};

bool same_set(std::span<const std::uint32_t> x, std::span<const std::uint32_t> y) {
  std::vector<std::uint32_t> a(x.begin(), x.end()), b(y.begin(), y.end());
  std::ranges::sort(a);
  std::ranges::sort(b);
  return a == b;
}

/// Small triangles along a bent strip in a pose of its own, so that boxes on the coordinate axes fit its
/// parts badly; the more of them in one place, the larger `crowding` is.
Triangles bent_strip(RandomEngine& random, int count, double crowding, double thickness) {
  Triangles triangles;
  const Eigen::Matrix3d turn = shapes::random_rotation(random);
  for (int i = 0; i < count; ++i) {
    const double x = 0.9 * std::pow(1.0 * i / count, crowding),
                 size = shapes::uniform(random, 0.1, 1) * thickness;
    const Vector3d centre = turn * Vector3d(x, x * x, shapes::uniform(random, 0, 0.1));
    Vector3d corner[3];
    for (Vector3d& c : corner) c = centre + size * shapes::random_direction(random);
    triangles.add(corner[0], corner[1], corner[2]);
  }
  return triangles;
}

/// Looks at so many cuts that none is left out.
constexpr std::uint32_t kAll = 10'000;

}  // namespace

TEST_CASE("the split across the coordinate axes with the smallest boxes is found") {
  RandomEngine random(5);
  for (const int count : {9, 16, 17, 40, 61, 203}) {
    const Triangles triangles = bent_strip(random, count, 1, 0.1);
    Soup soup = triangles.soup();
    FittedCuts cuts(soup, soup.order, {.principal = 0, .tried = kAll});
    // Cuts the whole, and what comes of it, down to leaves.
    struct Range {
      std::uint32_t begin, end;
    };
    std::vector<Range> ranges = {{0, static_cast<std::uint32_t>(count)}};
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const std::uint32_t begin = ranges[k].begin, end = ranges[k].end;
      if (end - begin <= kTreeWidth) continue;
      const auto listed = [&](const std::vector<std::uint32_t>& order) {
        return std::vector(order.begin() + begin, order.begin() + end);
      };
      const std::vector<std::uint32_t> before = listed(cuts.order());
      const FittedCuts::Halves halves = cuts.cut(begin, end);
      const std::uint32_t boundary = halves.boundary;
      const std::vector<std::uint32_t> after = listed(cuts.order());
      CAPTURE(count);
      CAPTURE(begin);
      CAPTURE(end);
      REQUIRE((boundary - begin) % kTreeWidth == 0);
      REQUIRE(boundary > begin);
      REQUIRE(boundary < end);
      REQUIRE(same_set(before, after));
      CHECK(cost(soup, after, boundary - begin) == doctest::Approx(min_cost(soup, before)).epsilon(1e-5));
      const auto of_left = std::span(after).first(boundary - begin),
                 of_right = std::span(after).subspan(boundary - begin);
      CHECK(halves.left_cost == doctest::Approx(fitted_cost(soup, of_left)).epsilon(1e-5));
      CHECK(halves.right_cost == doctest::Approx(fitted_cost(soup, of_right)).epsilon(1e-5));
      ranges.push_back({begin, boundary});
      ranges.push_back({boundary, end});
    }
    CHECK(same_set(cuts.order(), soup.order));
  }
}

TEST_CASE("a split does not depend on the order of simplices, nor on other simplices") {
  RandomEngine random(9);
  const Triangles strip = bent_strip(random, 300, 1, 0.1);
  const Soup soup = strip.soup();
  std::vector<std::uint32_t> some;
  for (std::uint32_t i = 0; i < 300; i += 3) some.push_back(i);
  std::vector<std::uint32_t> shuffled = some;
  std::ranges::shuffle(shuffled, random);
  std::vector<std::uint32_t> orders[2];
  for (const int round : {0, 1}) {
    FittedCuts cuts(soup, round == 0 ? some : shuffled, {.principal = 3, .tried = 2});
    double ratio = 0;
    int ranges = 0;
    const auto cut_down = [&](const auto& again, std::uint32_t begin, std::uint32_t end) -> void {
      if (end - begin <= kTreeWidth) return;
      const std::uint32_t boundary = cuts.cut(begin, end).boundary;
      const std::vector<std::uint32_t> order = cuts.order();
      const auto range = std::span(order).subspan(begin, end - begin);
      ratio += std::log(cost(soup, range, boundary - begin) / min_cost(soup, {range.begin(), range.end()}));
      ++ranges;
      again(again, begin, boundary);
      again(again, boundary, end);
    };
    cut_down(cut_down, 0, static_cast<std::uint32_t>(some.size()));
    orders[round] = cuts.order();
    CHECK(same_set(orders[round], some));
    CHECK(std::exp(ratio / ranges) < 1.05);  // against the best cuts across coordinate axes
  }
  CHECK(orders[0] == orders[1]);
}
