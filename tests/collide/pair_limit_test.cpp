/// Queries end at the limit of pairs, through every interface.

#include <array>
#include <utility>

#include <doctest/doctest.h>

#include <lrbscope/coherent.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

using namespace lrb;

namespace {

constexpr std::uint64_t kStrips = 60, kPairs = kStrips * kStrips;

/// Thin upright triangles, side by side along x or along y: each of one body crosses each of the other.
LrbRep strips(int along) {
  Mesh mesh;
  mesh.dim = 3;
  for (std::uint64_t i = 0; i < kStrips; ++i) {
    const double at = static_cast<double>(i) / kStrips;
    for (const auto& [far, z] : {std::pair{-1.0, -0.5}, std::pair{2.0, -0.5}, std::pair{0.5, 2.0}}) {
      Eigen::Vector3d v(at, far, z);
      if (along == 1) std::swap(v[0], v[1]);
      mesh.vertices.push_back(v);
    }
    mesh.add_face(std::array{VertexId(3 * i), VertexId(3 * i + 1), VertexId(3 * i + 2)});
  }
  return LrbRep::without_regions(mesh, false, false);
}

CollideResult ask(const CollideRequest& request) {
  static const LrbRep a = strips(0), b = strips(1);
  return collide(a, {}, b, Pose::translation({0, 0, 0.125}), request);
}

}  // namespace

TEST_CASE("a query with more pairs than its limit is rejected with a remedy") {
  REQUIRE(ask({}).pairs.size() == kPairs);
  CollideRequest request;
  request.max_pairs = kPairs;  // as many as there are
  CHECK(ask(request).pairs.size() == kPairs);
  request.max_pairs = kPairs - 1;
  CHECK_THROWS_WITH_AS(
      ask(request), doctest::Contains("more than 3599 pairs of triangles intersect, the limit"), InputError);
  CHECK_THROWS_WITH_AS(ask(request), doctest::Contains("max_pairs; raise it (--max-pairs)"), InputError);
  request.contacts = true;
  CHECK_THROWS_AS(ask(request), InputError);
  for (const Recursion recursion : {Recursion::paper, Recursion::paper_strict}) {
    CollideRequest paper{.recursion = recursion};
    CHECK(ask(paper).pairs.size() == kPairs);
    paper.max_pairs = 10;
    CHECK_THROWS_AS(ask(paper), InputError);
  }
  CHECK_THROWS_AS(ask({.tolerance = 1e-9, .max_pairs = 10}), InputError);
}

TEST_CASE("a limit of pairs does not apply to one pair") {
  for (const Mode mode : {Mode::first_pair, Mode::any_pair})
    CHECK(ask({.mode = mode, .max_pairs = 1}).pairs.size() == 1);
}

TEST_CASE("a coherent query has the same limit of pairs, and recovers when fewer pairs intersect") {
  const LrbRep a = strips(0), b = strips(1);
  for (const auto use : {CoherentQuery::CacheUse::always, CoherentQuery::CacheUse::as_it_pays}) {
    CoherentQuery query(a, b, {.max_pairs = kPairs / 2}, use);
    const auto at = [](double x) { return Pose::translation({x, 0, 0.125}); };
    int rejected = 0, answered = 0;
    for (int step = 0; step < 60; ++step) {
      const double x = 3.0 - 0.05 * step;
      const std::size_t expected = collide(a, {}, b, at(x)).pairs.size();
      CAPTURE(x);
      if (expected > kPairs / 2) {
        CHECK_THROWS_AS(query.collide({}, at(x)), InputError);
        ++rejected;
      } else {
        CHECK(query.collide({}, at(x)).pairs.size() == expected);
        ++answered;
      }
    }
    CHECK(rejected > 5);
    CHECK(answered > 5);
    CHECK(query.collide({}, at(4)).pairs.empty());
  }
}

TEST_CASE("default limits of pairs") {
  CHECK(CollideRequest{}.pair_limit() == kMaxPairs);
  CHECK(CollideRequest{.contacts = true}.pair_limit() == kMaxPairsWithContacts);
  CHECK(CollideRequest{.max_pairs = 7}.pair_limit() == 7);
}
