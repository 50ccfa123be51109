#include <cstdio>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/coarse_checks.hpp"
#include "tests/torture/children.hpp"
#include "tests/torture/torture.hpp"
#include <lrbscope/build.hpp>

namespace lrb::torture {
namespace {

using shapes::RandomEngine;
using shapes::uniform;

constexpr std::uint64_t kCoarseBatch = 2000;
constexpr std::uint64_t kPosesOfOneContact = 20;
/// Measuring takes longer than all else: one query in so many.
constexpr std::uint64_t kMeasuredEvery = 16;

struct CoarseTally {
  std::uint64_t queries = 0, meeting = 0, alone_apart = 0, unresolved = 0, with_lids = 0, measured = 0;
  std::uint64_t wrong_relations = 0, wrong_separate = 0, wrong_bounds = 0, crashes = 0;
};

}  // namespace

template <>
inline constexpr auto kColumns<CoarseTally> =
    std::to_array<Column<CoarseTally>>({{"queries", &CoarseTally::queries},
                                        {"meeting", &CoarseTally::meeting},
                                        {"apart by", &CoarseTally::alone_apart},
                                        {"unresolved", &CoarseTally::unresolved},
                                        {"with lids", &CoarseTally::with_lids},
                                        {"measured", &CoarseTally::measured},
                                        {"relation", &CoarseTally::wrong_relations, true},
                                        {"separate", &CoarseTally::wrong_separate, true},
                                        {"bound", &CoarseTally::wrong_bounds, true},
                                        {"crashes", &CoarseTally::crashes, true}});

namespace {

struct CoarseBodies {
  const char* name;
  LrbRep a, b;
};

std::vector<CoarseBodies> coarse_bodies() {
  std::vector<CoarseBodies> list;
  const auto add = [&](const char* name, const Mesh& a, const Mesh& b) {
    list.push_back({name, build_lrb(a), build_lrb(b)});
  };
  add("bumps", shapes::bumpy_sphere(3, 7, 0.3), shapes::bumpy_sphere(3, 8, 0.3));
  add("ball in bowl", shapes::bowl(24, 12), shapes::icosphere(3, 0.5));
  add("tori", shapes::torus(24, 14), shapes::torus(20, 12, 1, 0.25));
  add("combs", shapes::comb(6), shapes::comb(5));
  add("void", shapes::box_with_void(), shapes::icosphere(2, 0.4));
  add("gears 2D", shapes::gear(40), shapes::gear(31, 0.9, 0.6));
  return list;
}

/// Poses of B around a first contact: at it, and off it by 10^-17 to 10^-1 of the body, or flush along A's
/// axes.
class Poses {
 public:
  Poses(const CoarseBodies& bodies, RandomEngine& random) : bodies_(bodies), random_(random) {
    size_ = shapes::box_of(bodies.a).diagonal().norm();
  }

  void approach(QueryContext& context) {
    const int dim = bodies_.a.dim();
    frame_ = random_() % 2 ? Pose{}
                           : Pose{shapes::random_rotation(random_, dim),
                                  std::pow(10, uniform(random_, -2, 3)) *
                                      test::in_space(shapes::random_direction(random_), bodies_.a.dim())};
    flush_ = random_() % 4 == 0;
    if (!flush_)
      touch_.r = shapes::random_rotation(random_, dim);
    else
      touch_.r = Eigen::Matrix3d::Identity();
    way_ = test::in_space(shapes::random_direction(random_), bodies_.a.dim()).normalized();
    CollideRequest any;
    any.mode = Mode::any_pair;
    NullProbe probe;
    double apart = 2 * size_, meeting = 0;  // bodies one of which holds the other count as apart here
    for (int i = 0; i < 50; ++i) {
      const double s = (apart + meeting) / 2;
      touch_.t = s * way_;
      const bool meets =
          !collide(bodies_.a, frame_, bodies_.b, in_frame(touch_), any, context, probe).pairs.empty();
      (meets ? meeting : apart) = s;
    }
    touch_.t = apart * way_;
  }

  const Pose& frame() const { return frame_; }

  Pose next() {
    Pose p = touch_;
    if (flush_) {
      for (int k = 0; k < bodies_.a.dim(); ++k) p.t[k] = static_cast<double>(random_() % 25) / 4 - 3;
    } else if (random_() % 8 != 0) {
      const double off = std::pow(10, uniform(random_, -17, -1)) * size_;
      p.t += (random_() % 2 ? off : -off) * way_;
    }
    return in_frame(p);
  }

 private:
  Pose in_frame(const Pose& p) const { return {frame_.r * p.r, frame_.r * p.t + frame_.t}; }

  const CoarseBodies& bodies_;
  RandomEngine& random_;
  double size_;
  Pose frame_, touch_;
  Eigen::Vector3d way_;
  bool flush_ = false;
};

class CoarseChecker {
 public:
  CoarseChecker(const CoarseBodies& bodies, RandomEngine& random) : bodies_(bodies), random_(random) {}

  CoarseTally run(std::uint64_t count) {
    Poses poses(bodies_, random_);
    const double size = shapes::box_of(bodies_.a).diagonal().norm();
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i % kPosesOfOneContact == 0) poses.approach(context_);
      CollideRequest request;
      request.tolerance = std::pow(10, uniform(random_, -3, 0)) * size;
      request.mode = static_cast<Mode>(random_() % 3);
      if (random_() % 3 == 0) request.max_tests = std::uint64_t{1} << random_() % 8;
      check(poses.frame(), poses.next(), request);
    }
    return t_;
  }

 private:
  void check(const Pose& pose_a, const Pose& pose_b, const CollideRequest& request) {
    NullProbe probe;
    CollideRequest exact;
    exact.mode = request.mode;
    const CollideResult truth = collide(bodies_.a, pose_a, bodies_.b, pose_b, exact, context_, probe);
    const CollideResult coarse = collide(bodies_.a, pose_a, bodies_.b, pose_b, request, context_, probe);
    const bool meets = truth.relation != Relation::separate;
    ++t_.queries;
    t_.meeting += meets;
    t_.unresolved += coarse.relation == Relation::unresolved;
    if (coarse.relation != truth.relation && coarse.relation != Relation::unresolved &&
        request.mode != Mode::any_pair)
      complain(t_.wrong_relations, "another relation");
    if (meets && coarse.relation == Relation::separate)
      complain(t_.wrong_separate, "separate, though they meet");
    const bool alone =
        test::wrappers_are_disjoint(bodies_.a, pose_a, bodies_.b, pose_b, request.tolerance, context_);
    t_.alone_apart += alone;
    if (meets && alone) complain(t_.wrong_separate, "wrappers apart, though the bodies meet");
    const bool has_lids = coarse.error_bound > 0 && !coarse.pairs.empty();
    t_.with_lids += has_lids;
    if (random_() % kMeasuredEvery == 0 && coarse.error_bound > 0 && std::isfinite(coarse.error_bound))
      measure(pose_a, pose_b, coarse, meets);
  }

  void measure(const Pose& pose_a, const Pose& pose_b, const CollideResult& coarse, bool meets) {
    ++t_.measured;
    const test::RealSurfaces real(bodies_.a, pose_a, bodies_.b, pose_b);
    // Measured values are also rounded.
    const double bound = coarse.error_bound * (1 + 1e-9) + 1e-12 * pose_b.t.cwiseAbs().maxCoeff();
    if (!coarse.pairs.empty() && real.off(coarse.pairs[random_() % coarse.pairs.size()]) > bound)
      complain(t_.wrong_bounds, "a pair deviates by more than the bound");
    if (!meets && coarse.relation == Relation::unresolved && real.between() > bound)
      complain(t_.wrong_bounds, "unresolved, and further apart than the bound");
  }

  void complain(std::uint64_t& counter, const char* what) {
    torture::complain(counter, bodies_.name, t_.queries, what);
  }

  const CoarseBodies& bodies_;
  RandomEngine& random_;
  QueryContext context_;
  CoarseTally t_;
};

}  // namespace

std::uint64_t torture_coarse(std::uint64_t count, std::uint64_t seed, unsigned jobs) {
  const std::vector<CoarseBodies> list = coarse_bodies();
  for (const CoarseBodies& bodies : list) {
    bodies.a.levels();
    bodies.b.levels();
  }
  return print_table(rows_of<CoarseTally, CoarseChecker>(list, count, seed), kCoarseBatch, jobs);
}

}  // namespace lrb::torture
