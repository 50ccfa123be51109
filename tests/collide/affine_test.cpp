// Bodies under maps that are no rotations: the answers are those of brute force, in every mode, and the work
// is that of the same bodies with the map in their vertices.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/collide.hpp>

using namespace lrb;
using shapes::RandomEngine;
using shapes::uniform;
using test::MapKind;

namespace {

using test::closed;

struct PosedScene {
  LrbRep a, b;
  Pose pose_a, pose_b;
};

/// The map, with sizes of the bodies and of the world on either side of it.
Pose sized(const Eigen::Matrix3d& map, const Eigen::Vector3d& at, double body, double world) {
  return {map * (world / body), at * world};
}

PosedScene random_scene(RandomEngine& random, int dim, int i) {
  const double sizes[] = {1, 1, 1, 1e-150, 1e150, 1e-12, 1e9};
  const double size_a = sizes[random() % 7], size_b = sizes[random() % 7], world = sizes[random() % 7];
  const auto kind = [&] { return static_cast<MapKind>(random() % test::kMapKinds); };
  const auto first = static_cast<MapKind>(i % test::kMapKinds);
  const Eigen::Matrix3d map_a = test::random_map(random, i % 3 ? kind() : first, dim),
                        map_b = test::random_map(random, i % 3 ? first : kind(), dim);
  Eigen::Vector3d at = uniform(random, 0, 2) * shapes::random_direction(random);
  if (dim == 2) at.z() = 0;
  // Often vertex upon vertex, in what the poses make of them.
  PosedScene s{closed(dim == 2 ? shapes::gear(12) : shapes::icosphere(1), size_a),
               closed(dim == 2 ? shapes::comb_2d(3, 1) : shapes::bumpy_sphere(1, 2), size_b),
               sized(map_a, {0, 0, 0}, size_a, world), sized(map_b, at, size_b, world)};
  if (i % 7 == 0) {
    const auto vertex = [&](const LrbRep& rep) { return rep.vertices()[random() % rep.vertices().size()]; };
    s.pose_b.t = s.pose_a.r * vertex(s.a) - s.pose_b.r * vertex(s.b);
    if (dim == 2) s.pose_b.t.z() = 0;
  }
  return s;
}

CollideResult ask(const PosedScene& s, Mode mode, QueryContext& context) {
  CollideRequest request;
  request.mode = mode;
  NullProbe probe;
  return collide(s.a, s.pose_a, s.b, s.pose_b, request, context, probe);
}

void check_modes(const PosedScene& s, const BruteForceResult& truth, QueryContext& context) {
  const CollideResult all = ask(s, Mode::all_pairs, context);
  REQUIRE(all.pairs == truth.pairs);
  REQUIRE(all.meets == truth.meets);
  REQUIRE(all.relation == truth.relation);
  const CollideResult first = ask(s, Mode::first_pair, context);
  REQUIRE(first.relation == truth.relation);
  REQUIRE(first.pairs.empty() == truth.pairs.empty());
  const CollideResult any = ask(s, Mode::any_pair, context);
  REQUIRE(any.pairs.empty() == truth.pairs.empty());
  for (const SimplexPair& p : any.pairs)
    REQUIRE(std::binary_search(truth.pairs.begin(), truth.pairs.end(), p));
}

/// Checks the answer within a tolerance against the exact one.
void check_coarse(const PosedScene& s, const BruteForceResult& truth, QueryContext& context) {
  CollideRequest request;
  request.tolerance = 0.05 * s.a.tree().extent();
  NullProbe probe;
  const CollideResult coarse = collide(s.a, s.pose_a, s.b, s.pose_b, request, context, probe);
  REQUIRE(!std::isnan(coarse.error_bound));
  if (coarse.relation == Relation::unresolved) {
    REQUIRE(coarse.error_bound > 0);
    return;
  }
  if (coarse.relation == Relation::separate || coarse.relation == Relation::crossing ||
      coarse.error_bound == 0)
    REQUIRE(coarse.relation == truth.relation);
}

}  // namespace

TEST_CASE("affine maps: all modes agree with brute force") {
  RandomEngine random(11);
  int in_contact = 0, apart = 0, by_kind[test::kMapKinds] = {};
  for (const int dim : {3, 2}) {
    QueryContext context;
    for (int i = 0; i < 600; ++i) {
      CAPTURE(dim);
      CAPTURE(i);
      const PosedScene s = random_scene(random, dim, i);
      const BruteForceResult truth = brute_force(s.a, s.pose_a, s.b, s.pose_b);
      check_modes(s, truth, context);
      check_coarse(s, truth, context);
      in_contact += !truth.pairs.empty();
      apart += truth.relation == Relation::separate;
      by_kind[i % test::kMapKinds] += !truth.pairs.empty();
    }
  }
  CHECK(in_contact > 400);
  CHECK(apart > 200);
  for (const int met : by_kind) CHECK(met > 5);
}

TEST_CASE("affine maps: coherent queries of moving bodies") {
  RandomEngine random(12);
  int in_contact = 0;
  for (int i = 0; i < 200; ++i) {
    const int dim = i % 4 == 3 ? 2 : 3;
    PosedScene s = random_scene(random, dim, i);
    CAPTURE(i);
    CoherentQuery coherent(s.a, s.b, {}, CoherentQuery::CacheUse::always);
    const Eigen::Vector3d step = 0.01 * s.pose_b.t;
    for (int k = 0; k < 8; ++k) {
      const CollideResult& now = coherent.collide(s.pose_a, s.pose_b);
      const BruteForceResult truth = brute_force(s.a, s.pose_a, s.b, s.pose_b);
      REQUIRE(now.pairs == truth.pairs);
      REQUIRE(now.relation == truth.relation);
      in_contact += !truth.pairs.empty();
      s.pose_b.t += step;
      // From a rotation to a map that is none, and back.
      if (k == 3) s.pose_b.r *= 1.25;
      if (k == 5) s.pose_b.r /= 1.25;
    }
  }
  CHECK(in_contact > 400);
}

TEST_CASE("contact normals point from A to B for mirrored and scaled bodies") {
  for (const double size : {1.0, 1e-120, 1e120})
    for (const double mirror_a : {1.0, -1.0})
      for (const double mirror_b : {1.0, -1.0}) {
        CAPTURE(size);
        CAPTURE(mirror_a);
        CAPTURE(mirror_b);
        // Boxes from 0 to 1 on each axis; B's lower side is the plane x = size.
        const LrbRep box = closed(shapes::box());
        Pose a, b = Pose::translation({size, 0.25 * size, 0.25 * size});
        a.r = size * Eigen::Vector3d(1, mirror_a, 1).asDiagonal();
        a.t.y() = mirror_a < 0 ? size : 0;
        b.r = 0.5 * size * Eigen::Vector3d(1, mirror_b, 1).asDiagonal();
        b.t.y() += mirror_b < 0 ? 0.5 * size : 0;
        CollideRequest request;
        request.contacts = request.interiors_overlap = true;
        const CollideResult r = collide(box, a, box, b, request);
        REQUIRE(r.regions.size() == 1);
        CHECK((r.regions[0].normal - Eigen::Vector3d(1, 0, 0)).norm() < 1e-12);
        CHECK(r.interiors_overlap == Answer::no);
        b.t.x() -= 0.5 * size;  // sides that coincide, from within
        CHECK(collide(box, a, box, b, request).interiors_overlap == Answer::yes);
      }
}

TEST_CASE("a 2D body that is flipped over is mirrored, whatever its matrix does to z") {
  const LrbRep box = closed(shapes::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  CollideRequest request;
  request.contacts = request.interiors_overlap = true;
  for (const double z : {1.0, -1.0, 0.0, 7.0}) {
    CAPTURE(z);
    Pose over;
    over.r = Eigen::Vector3d(1, -1, z).asDiagonal();
    over.t = {1, 1, 0};
    const CollideResult r = collide(box, Pose{}, box, over, request);
    REQUIRE(r.regions.size() == 1);
    CHECK((r.regions[0].normal - Eigen::Vector3d(1, 0, 0)).norm() < 1e-12);
    CHECK(r.interiors_overlap == Answer::no);
    over.t.x() = 0;
    CHECK(collide(box, Pose{}, box, over, request).interiors_overlap == Answer::yes);
  }
}

namespace {

struct Work {
  std::uint64_t node_pairs = 0, simplex_pairs = 0;
  void add(const Counters& c) {
    node_pairs += c.node_pairs;
    simplex_pairs += c.prefilter_tests;
  }
};

struct Kind {
  const char* name;
  Eigen::Matrix3d map;
  double most;  ///< node pairs, relative to a rotation's of the mapped mesh
};

std::vector<Kind> kinds() {
  const Eigen::Matrix3d turn = Pose::rotation({1, 2, 3}, 1).r;
  const auto diagonal = [&](double x, double y, double z) -> Eigen::Matrix3d {
    return turn * Eigen::Vector3d(x, y, z).asDiagonal() * turn.transpose();
  };
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.5;
  // By 2, the mapped mesh's tree is the same: then the difference is what the kernel for rigid motions leaves
  // out by comparing whole nodes, which that for other maps does not. Where the map rounds, trees differ,
  // too.
  return {{"2", diagonal(2, 2, 2), 1.1},
          {"1.01", diagonal(1.01, 1.01, 1.01), 1.05},
          {"1.5", diagonal(1.5, 1.5, 1.5), 1.1},
          {"10", diagonal(10, 10, 10), 1.05},
          {"0.1", diagonal(0.1, 0.1, 0.1), 1.05},
          {"1e-150", 1e-150 * Eigen::Matrix3d::Identity(), 1.05},
          {"mirrored", diagonal(1, -1, 1), 1.1},
          {"stretched", diagonal(1, 2, 0.5), 1.5},
          {"sheared", shear, 1.5},
          {"thin", diagonal(1, 1, 0.01), 2.5},
          {"flat", diagonal(1, 1, 0), 2.5}};
}

}  // namespace

TEST_CASE("an affine map needs no more node pairs than a rotation of the mapped mesh") {
  const Mesh mesh_a = shapes::bumpy_sphere(4, 1), mesh_b = shapes::torus(60, 30);
  for (const Kind& kind : kinds())
    for (const bool on_a : {false, true}) {
      CAPTURE(kind.name);
      CAPTURE(on_a);
      RandomEngine random(5);
      Mesh mapped = on_a ? mesh_a : mesh_b;
      for (auto& x : mapped.vertices) x = kind.map * x;
      const LrbRep plain_a = closed(mesh_a), plain_b = closed(mesh_b), baked = closed(mapped);
      const double size = kind.map.cwiseAbs().maxCoeff() < 1e-9 ? 1e-150 : 1;
      const LrbRep other = closed(on_a ? mesh_b : mesh_a, size);
      Work as_mesh, as_pose;
      for (int i = 0; i < 12; ++i) {
        const LrbRep &a = on_a ? baked : other, &b = on_a ? other : baked;
        const Eigen::Matrix3d turn = shapes::random_rotation(random);
        Pose pose_a{turn, {0, 0, 0}}, pose_b = shapes::random_pose(random, a, b, 0.1 * i);
        pose_b = {turn * pose_b.r, turn * pose_b.t};
        as_mesh.add(collide(a, pose_a, b, pose_b).counters);
        (on_a ? pose_a : pose_b).r *= kind.map;
        const LrbRep &x = on_a ? plain_a : other, &y = on_a ? other : plain_b;
        as_pose.add(collide(x, pose_a, y, pose_b).counters);
      }
      MESSAGE(std::string(kind.name) << (on_a ? ", A: " : ", B: ") << as_pose.node_pairs << " node pairs for "
                                     << as_mesh.node_pairs << ", " << as_pose.simplex_pairs
                                     << " pairs of simplices for " << as_mesh.simplex_pairs);
      CHECK(static_cast<double>(as_pose.node_pairs) <=
            kind.most * static_cast<double>(as_mesh.node_pairs) + 20);
      CHECK(static_cast<double>(as_pose.simplex_pairs) <=
            kind.most * static_cast<double>(as_mesh.simplex_pairs) + 20);
    }
}
