// The certificate of separation, checked without the query and its predicates: two wrappers, every face of
// one against every face of the other and every corner against the other as a whole, in rational arithmetic.
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"
#include "tests/torture/parity_oracle.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>

using namespace lrb;
using shapes::RandomEngine;
using torture::WorldPoint;

namespace {

/// A wrapper in the world: made from a list of regions, as any reader of the certificate would make it.
struct Wrapped {
  const LrbRep& rep;
  std::vector<WorldPoint> x;
  std::vector<SimplexId> simplices;
  torture::ParityOracle parity;

  Wrapped(const LrbRep& r, const Pose& pose, const std::vector<RegionId>& refined)
      : rep(r),
        x(torture::world_points(r, pose)),
        simplices(boundary(r, refined)),
        parity(r, pose, simplices) {}

  static std::vector<SimplexId> boundary(const LrbRep& rep, const std::vector<RegionId>& refined) {
    std::vector<bool> open(rep.region_count(), false);
    for (const RegionId r : refined) open[r] = true;
    const auto part_of_it = [&](CellId c) { return c == kSolid || (is_region(c) && !open[c]); };
    std::vector<SimplexId> out;
    for (SimplexId s = 0; s < rep.simplex_count(); ++s) {
      const FaceId f = rep.face_of_simplex(s);
      if (part_of_it(rep.inner_cell(f)) != part_of_it(rep.outer_cell(f))) out.push_back(s);
    }
    return out;
  }
};

/// Whether two closed surfaces have no point in common and neither reaches into what the other encloses.
bool are_apart(const Wrapped& a, const Wrapped& b, RandomEngine& random) {
  const int n = a.rep.dim();
  for (const SimplexId s : a.simplices)
    for (const SimplexId t : b.simplices) {
      const auto p = torture::corners_of(a.rep, a.x, s), q = torture::corners_of(b.rep, b.x, t);
      if (!torture::boxes_disjoint(p.data(), q.data(), n) &&
          oracle::meet_of_simplices(p.data(), q.data(), static_cast<std::size_t>(n)) != 0)
        return false;
    }
  const auto has_corner_in = [&](const Wrapped& inner, const Wrapped& outer) {
    std::vector<bool> seen(inner.x.size(), false);
    for (const SimplexId s : inner.simplices) {
      VertexId v[3];
      inner.rep.simplex(s, v);
      for (int k = 0; k < n; ++k) {
        if (!seen[v[k]] && outer.parity.holds(inner.x[v[k]], random)) return true;
        seen[v[k]] = true;
      }
    }
    return false;
  };
  return !has_corner_in(a, b) && !has_corner_in(b, a);
}

struct SeparateBodies {
  const char* name;
  LrbRep a, b;
  double share;  ///< of random_pose(): how near
};

std::vector<SeparateBodies> separate_bodies() {
  return {
      {"bumps", build_lrb(shapes::bumpy_sphere(3, 7, 0.3)), build_lrb(shapes::bumpy_sphere(2, 8, 0.3)), 0.6},
      {"ball in bowl", build_lrb(shapes::bowl(16, 8)), build_lrb(shapes::icosphere(2, 0.3)), 0.3},
      {"tori", build_lrb(shapes::torus(16, 10)), build_lrb(shapes::torus(14, 8, 1, 0.25)), 0.4},
      {"void", build_lrb(shapes::box_with_void()), build_lrb(shapes::icosphere(1, 0.2)), 0.1},
      {"gears 2D", build_lrb(shapes::gear(24)), build_lrb(shapes::gear(19, 0.9, 0.6)), 0.65},
      {"comb 2D", build_lrb(shapes::comb_2d(6)), build_lrb(shapes::star(7, 0.3, 0.15)), 0.3}};
}

}  // namespace

TEST_CASE("certificates of separation are valid, also under affine maps, and refine no region needlessly") {
  using test::MapKind;
  constexpr MapKind kKinds[] = {MapKind::scaled, MapKind::stretched, MapKind::sheared, MapKind::mirrored};
  RandomEngine random(99);
  for (const SeparateBodies& pair : separate_bodies()) {
    CAPTURE(pair.name);
    int certified[2] = {}, trials = 0, refined = 0, minimal = 0;
    for (int i = 0; i < 800 && (certified[0] < 5 || certified[1] < 4); ++i) {
      CAPTURE(i);
      const bool mapped = i % 2 == 1;
      Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
      if (mapped) map = test::random_map(random, kKinds[i / 2 % 4], pair.a.dim());
      const double share = shapes::uniform(random, 0.4, 1.3) * pair.share;
      const Pose p = shapes::random_pose(random, pair.a, pair.b, share);
      const Pose pose_a{map, {0, 0, 0}}, pose_b{map * p.r, map * p.t};
      CollideRequest request;
      request.separation = true;
      const CollideResult r = collide(pair.a, pose_a, pair.b, pose_b, request);
      if (r.relation != Relation::separate) REQUIRE(!r.separation);
      if (!mapped) REQUIRE(r.separation.has_value() == (r.relation == Relation::separate));
      if (!r.separation || ++certified[mapped] > 5) continue;
      const Wrapped a(pair.a, pose_a, r.separation->refined[0]), b(pair.b, pose_b, r.separation->refined[1]);
      REQUIRE(are_apart(a, b, random));
      if (mapped) continue;
      refined += static_cast<int>(r.separation->refined[0].size() + r.separation->refined[1].size());
      for (int side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < r.separation->refined[side].size(); ++k, ++trials) {
          std::vector<RegionId> fewer = r.separation->refined[side];
          fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
          const Wrapped larger(side == 0 ? pair.a : pair.b, side == 0 ? pose_a : pose_b, fewer);
          minimal += !(side == 0 ? are_apart(larger, b, random) : are_apart(a, larger, random));
        }
    }
    MESSAGE(std::string(pair.name) << ": " << certified[0] << " certificates, " << refined
                                   << " regions refined in all");
    CHECK(certified[0] >= 5);
    CHECK(certified[1] >= 4);
    CHECK(minimal == trials);
  }
}

TEST_CASE("bodies closer than rounding have no certificate") {
  const LrbRep a = build_lrb(shapes::box()), b = build_lrb(shapes::box());
  CollideRequest request;
  request.separation = true;
  const CollideResult r = collide(a, Pose{}, b, Pose::translation({1 + 0x1p-50, 0, 0}), request);
  CHECK(r.relation == Relation::separate);
  CHECK(!r.separation);
  CHECK(collide(a, Pose{}, b, Pose::translation({1.001, 0, 0}), request).separation);
}
