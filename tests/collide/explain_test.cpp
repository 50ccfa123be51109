// Explanations against the query itself, brute force and distances from another source.
#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/support/simplex_distance.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>

namespace lrb::test {
namespace {

using namespace shapes;

struct ExplainedScene {
  LrbRep a, b;
  Pose pose;
};

/// Bodies in contact or near it, under rotations and other maps, in the plane too.
std::vector<ExplainedScene> scenes() {
  RandomEngine random(11);
  std::vector<ExplainedScene> out;
  for (int i = 0; i < 24; ++i) {
    const int dim = i % 4 == 3 ? 2 : 3;
    const LrbRep a = build_lrb(dim == 3 ? bumpy_sphere(2, 5, 0.2) : gear(24));
    const LrbRep b = i % 4 == 1 ? LrbRep::without_regions(comb(4), true, false)
                                : build_lrb(dim == 3 ? torus(24, 12) : comb_2d(6, 1));
    Pose pose;
    pose.r = random_map(random, static_cast<MapKind>(i % kMapKinds), dim);
    pose.t = uniform(random, 0.2, 2.5) * random_direction(random);
    if (dim == 2) pose.t.z() = 0;
    out.push_back({a, b, pose});
  }
  return out;
}

/// Checks the invariants of any explanation.
void check(const ExplainedScene& s, const SimplexPair& pair, exact::Meet meet) {
  CAPTURE(pair.a);
  CAPTURE(pair.b);
  const PairExplanation e = explain_pair(s.a, {}, s.b, s.pose, pair);
  REQUIRE(e.meet == meet);
  REQUIRE(!e.nodes.empty());
  CHECK((e.nodes.front().node[0] == 0 && e.nodes.front().node[1] == 0));
  const bool by_boxes = e.decided_by == DecidedBy::node_boxes || e.decided_by == DecidedBy::node_edges;
  CHECK(by_boxes == !e.reaches_faces);
  if (meet != exact::Meet::disjoint) {
    // Boxes of faces that meet never part, and nothing but the last two tests says that they do.
    CHECK((e.decided_by == DecidedBy::floats || e.decided_by == DecidedBy::exact));
    const double size = 1e-6 * (1 + s.pose.r.norm());
    for (const BoxPair& boxes : e.nodes) CHECK(boxes.gap <= size);
    CHECK(e.face_boxes.gap <= size);
    CHECK(e.contact.corner_count > 0);
    CHECK(e.contact.meet == meet);
  } else {
    const double distance =
        simplex_distance(simplex_points(s.a, {}, pair.a), simplex_points(s.b, s.pose, pair.b));
    CHECK(e.distance == doctest::Approx(distance).epsilon(1e-6));
    if (e.decided_by == DecidedBy::node_boxes) CHECK(e.nodes.back().gap <= e.distance * (1 + 1e-6));
  }
  const int count = s.a.dim();
  for (const PlaneSides& sides : e.sides) {
    const auto all = [&](int sign) {
      return std::count(sides.exact.begin(), sides.exact.begin() + count, sign) == count;
    };
    if (all(1) || all(-1)) CHECK(meet == exact::Meet::disjoint);
  }
}

TEST_CASE("explanations of reported and other pairs are correct") {
  RandomEngine random(3);
  for (const ExplainedScene& s : scenes()) {
    const BruteForceResult truth = brute_force(s.a, {}, s.b, s.pose);
    for (std::size_t i = 0; i < truth.pairs.size(); i += 1 + truth.pairs.size() / 8)
      check(s, truth.pairs[i], truth.meets[i]);
    for (int i = 0; i < 12; ++i) {
      const SimplexPair pair{SimplexId(random() % s.a.real_simplex_count()),
                             SimplexId(random() % s.b.real_simplex_count())};
      const auto at = std::lower_bound(truth.pairs.begin(), truth.pairs.end(), pair);
      const bool meets = at != truth.pairs.end() && *at == pair;
      check(s, pair,
            meets ? truth.meets[static_cast<std::size_t>(at - truth.pairs.begin())] : exact::Meet::disjoint);
    }
  }
}

TEST_CASE("the reported traversal is the query's own") {
  for (const ExplainedScene& s : scenes()) {
    const CollideResult result = collide(s.a, {}, s.b, s.pose);
    const WalkExplanation e = explain_walk(s.a, {}, s.b, s.pose);
    CHECK(e.result.pairs == result.pairs);
    CHECK(e.result.relation == result.relation);
    std::uint64_t node_pairs = 0;
    for (const WalkDepth& d : e.depths) {
      node_pairs += d.node_pairs;
      CHECK(d.ended <= d.node_pairs);
    }
    CHECK(node_pairs == result.counters.node_pairs);
    CHECK(e.face_pairs == result.counters.prefilter_tests);
    CHECK(e.left == result.counters.face_tests);
    CHECK(e.certain <= e.left);
    if (!result.pairs.empty()) CHECK(e.near.empty());
    if (result.pairs.empty() && e.left > 0) CHECK(e.near.size() == std::min<std::size_t>(e.left, e.kMaxNear));
  }
}

/// Returns the largest n.x over a body's vertices.
double reach(const LrbRep& rep, const Pose& pose, const Eigen::Vector3d& n) {
  double out = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& v : rep.vertices()) out = std::max(out, n.dot(pose.apply(v)));
  return out;
}

TEST_CASE("separate bodies: the closest disjoint boxes, and a separating plane if one was found") {
  int planes = 0, boxes = 0;
  for (const ExplainedScene& s : scenes())
    for (const double factor : {1.0, 1.5, 4.0}) {
      Pose pose = s.pose;
      pose.t *= factor;
      const WalkExplanation e = explain_walk(s.a, {}, s.b, pose);
      if (!e.result.pairs.empty()) CHECK_FALSE((e.nearest_boxes || e.plane));
      if (e.result.relation != Relation::separate) CHECK_FALSE(e.plane);
      if (e.nearest_boxes) {
        ++boxes;
        BoxPair again;
        compare_boxes(e.nearest_boxes->boxes[0], e.nearest_boxes->boxes[1], again);
        CHECK(again.gap == e.nearest_boxes->pair.gap);
        CHECK(again.gap > 0);
      }
      if (e.plane) {
        ++planes;
        CHECK(e.plane->normal.norm() == doctest::Approx(1));
        CHECK(reach(s.a, {}, e.plane->normal) <= e.plane->of_a);
        CHECK(reach(s.b, pose, -e.plane->normal) <= -e.plane->of_b);
        CHECK(e.plane->gap() > 0);
        CHECK(e.plane->normal.dot(e.plane->reach[0]) == doctest::Approx(e.plane->of_a));
        CHECK(e.plane->normal.dot(e.plane->reach[1]) == doctest::Approx(e.plane->of_b));
      }
    }
  CHECK(planes > 10);
  CHECK(boxes > 10);
}

LrbRep segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.vertices = {from, to};
  const VertexId corners[2] = {0, 1};
  mesh.add_face(corners);
  return LrbRep::without_regions(mesh, false, false);
}

TEST_CASE("wrong signs of plain doubles are reported next to the exact sign") {
  // Points within 2^-49 of the line x = y, about which doubles are known to err (L. Kettner et al.,
  // "Classroom examples of robustness problems in geometric computations", 2008).
  const LrbRep line = segment({12, 12, 0}, {24, 24, 0});
  int wrong = 0;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) {
      const Eigen::Vector3d p(0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53, 0);
      const PairExplanation e = explain_pair(segment(p, {0, 1, 0}), {}, line, {}, {0, 0});
      const int sign = (j > i) - (j < i);
      CHECK(e.sides[0].exact[0] == sign);
      CHECK(e.sides[0].exact[1] == 1);
      wrong += e.sides[0].in_double[0] != sign;
    }
  CHECK(wrong > 0);
}

}  // namespace
}  // namespace lrb::test
