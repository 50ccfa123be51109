#include <cmath>
#include <cstdio>

#include "engine/collide/collide_into.hpp"
#include "engine/motion/contact_search.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/simplex_distance.hpp"
#include "tests/torture/children.hpp"
#include "tests/torture/torture.hpp"

namespace lrb::torture {
namespace {

using shapes::RandomEngine;
using shapes::uniform;

constexpr std::uint64_t kSweepBatch = 1000;
constexpr int kSamples = 40, kCloseSamples = 24;

struct SweepTally {
  std::uint64_t motions = 0, contacts = 0, at_start = 0, never = 0, undecided = 0, grazing = 0, passed = 0,
                steps = 0, samples = 0;
  std::uint64_t misses = 0, no_contact = 0, wide = 0, crashes = 0;
};

}  // namespace

template <>
inline constexpr auto kColumns<SweepTally> =
    std::to_array<Column<SweepTally>>({{"motions", &SweepTally::motions},
                                       {"contact", &SweepTally::contacts},
                                       {"at start", &SweepTally::at_start},
                                       {"never", &SweepTally::never},
                                       {"undecided", &SweepTally::undecided},
                                       {"grazing", &SweepTally::grazing},
                                       {"passed", &SweepTally::passed},
                                       {"steps", &SweepTally::steps},
                                       {"samples", &SweepTally::samples},
                                       {"misses", &SweepTally::misses, true},
                                       {"no contact", &SweepTally::no_contact, true},
                                       {"wide", &SweepTally::wide, true},
                                       {"crashes", &SweepTally::crashes, true}});

namespace {

struct SweepBodies {
  const char* name;
  LrbRep a, b;
  double size;  ///< of both

  SweepBodies(const char* name_, const Mesh& mesh_a, const Mesh& mesh_b, bool closed_a = true)
      : name(name_),
        a(LrbRep::without_regions(mesh_a, closed_a, false)),
        b(LrbRep::without_regions(mesh_b, mesh_b.face_count() > 2, false)),
        size(shapes::box_of(a).diagonal().norm() + shapes::box_of(b).diagonal().norm()) {}
};

std::vector<SweepBodies> sweep_bodies() {
  const auto sheet = [](double half) { return test::sheet(1, {-half, -half}, {half, half}); };
  std::vector<SweepBodies> list;
  list.emplace_back("bumps", shapes::bumpy_sphere(3, 7, 0.3), shapes::bumpy_sphere(3, 8, 0.3));
  list.emplace_back("ball in bowl", shapes::bowl(24, 12), shapes::icosphere(3, 0.5));
  list.emplace_back("tori", shapes::torus(24, 14), shapes::torus(20, 12, 1, 0.25));
  list.emplace_back("combs", shapes::comb(6), shapes::comb(5));
  list.emplace_back("boxes", shapes::box(), shapes::quad_box());
  list.emplace_back("void", shapes::box_with_void(), shapes::icosphere(1, 0.4));
  list.emplace_back("sheets", sheet(1), sheet(0.7), false);
  list.emplace_back("ball, sheet", sheet(1), shapes::icosphere(2, 0.3), false);
  list.emplace_back("grain, ball", shapes::icosphere(3), shapes::scaled(shapes::tetrahedron(), 1e-3));
  list.emplace_back("gears 2D", shapes::gear(40), shapes::gear(31, 0.9, 0.6));
  return list;
}

/// Draws motions of all kinds.
class Motions {
 public:
  Motions(const SweepBodies& bodies, RandomEngine& random)
      : bodies_(bodies), random_(random), dim_(bodies.a.dim()) {}

  Motion motion_a() {
    if (random_() % 3 != 0) return Motion::still({});
    const Pose start{shapes::random_rotation(random_, dim_), 0.2 * bodies_.size * direction()};
    return Motion::turning(start, uniform(random_, 0, 3) * axis(), start.t, 0.3 * bodies_.size * direction());
  }

  Motion motion_b() {
    const double size = bodies_.size;
    const Pose start = pose(uniform(random_, 0.3, 1.2) * size);
    switch (random_() % 8) {
      case 0:  // straight through, at any speed
        return Motion::linear(
            start, start.t - (start.t + 0.3 * size * direction()) * std::pow(10, uniform(random_, 0, 5)));
      case 1:
        return Motion::screw(start, pose(uniform(random_, 0, 1) * size));
      case 2:  // many turns
        return Motion::turning(start, std::pow(10, uniform(random_, 0, 2.5)) * axis(), start.t,
                               -1.6 * start.t);
      case 3:  // about a far point
        return Motion::turning(start, uniform(random_, 0, 12) * axis(), 0.5 * size * direction(), {0, 0, 0});
      case 4:
        return flush();
      case 5: {  // a little, from near
        const Pose near = pose(uniform(random_, 0, 0.5) * size);
        return Motion::linear(near, near.t + std::pow(10, uniform(random_, -6, -1)) * size * direction());
      }
      case 6:
        return graze();
      default: {
        const Pose between = pose(uniform(random_, 0.2, 0.8) * size);
        return Motion::key_frames(std::array<Motion::KeyFrame, 4>{
            {{0, start}, {0.25, between}, {0.7, pose(0.5 * size)}, {1, pose(0.1 * size)}}});
      }
    }
  }

 private:
  Eigen::Vector3d direction() { return test::in_space(shapes::random_direction(random_), dim_); }
  Eigen::Vector3d axis() { return dim_ == 2 ? Eigen::Vector3d::UnitZ() : shapes::random_direction(random_); }
  Pose pose(double distance) { return {shapes::random_rotation(random_, dim_), distance * direction()}; }

  /// Along A's axes, by multiples of a quarter: faces and edges meet flush, or slide along each other.
  Motion flush() {
    const auto quarter = [&] { return static_cast<double>(random_() % 33) / 4 - 4; };
    Pose start;
    Eigen::Vector3d end(0, 0, 0);
    for (int k = 0; k < dim_; ++k) start.t[k] = quarter();
    end = start.t;
    const int axis = static_cast<int>(random_() % static_cast<unsigned>(dim_));
    end[axis] = -start.t[axis];
    if (random_() % 2 != 0) end[(axis + 1) % dim_] = quarter();
    if (random_() % 4 != 0) return Motion::linear(start, end);
    const double angle = static_cast<double>(random_() % 5) * 1.5707963267948966;
    return Motion::turning(start, angle * Eigen::Vector3d::UnitZ(), start.t, end - start.t);
  }

  /// Past A, by hardly anything: aside of a path by as much as leaves the bodies a gap of 10^-1 to 10^-17.
  Motion graze() {
    const Eigen::Vector3d way = direction().normalized();
    Eigen::Vector3d aside = direction().cross(dim_ == 2 ? Eigen::Vector3d(0, 0, 1) : way);
    if (dim_ == 2) aside = {-way.y(), way.x(), 0};
    aside.normalize();
    const Eigen::Matrix3d r = shapes::random_rotation(random_, dim_);
    const double size = bodies_.size;
    double hits = 0, misses = size;
    const auto beside = [&](double x) {
      return Motion::linear({r, x * aside - size * way}, x * aside + size * way);
    };
    FirstContactRequest request;
    request.max_steps = 100'000;
    for (int i = 0; i < 40; ++i) {
      const double x = (hits + misses) / 2;
      const Motion m = beside(x);
      (first_contact(bodies_.a, Motion::still({}), bodies_.b, m, request, context_).outcome ==
               MotionOutcome::never
           ? misses
           : hits) = x;
    }
    return beside(misses + (random_() % 2 ? -1 : 1) * std::pow(10, uniform(random_, -17, -1)) * size);
  }

  const SweepBodies& bodies_;
  RandomEngine& random_;
  FirstContactContext context_;
  int dim_;
};

class SweepChecker {
 public:
  SweepChecker(const SweepBodies& bodies, RandomEngine& random) : bodies_(bodies), random_(random) {}

  SweepTally run(std::uint64_t count) {
    Motions motions(bodies_, random_);
    for (std::uint64_t i = 0; i < count; ++i) {
      const Motion a = motions.motion_a();
      check(a, motions.motion_b());
    }
    return t_;
  }

 private:
  bool meets(const Motion& a, const Motion& b, double t) {
    ++t_.samples;
    CollideRequest any;
    any.mode = Mode::any_pair;
    NullProbe probe;
    return !collide(bodies_.a, a.at(t), bodies_.b, b.at(t), any, query_, probe).pairs.empty();
  }

  /// Asks at times before `end`, most of them close to it.
  void look_before(const Motion& a, const Motion& b, double end) {
    bool missed = false;
    for (int i = 0; i < kSamples; ++i) missed = missed || meets(a, b, end * uniform(random_));
    for (int i = 0; i < kCloseSamples; ++i)
      missed = missed || meets(a, b, end * (1 - std::pow(10, uniform(random_, -16, -2))));
    missed = missed || meets(a, b, std::nextafter(end, 0));
    if (missed) complain(t_.misses, "a contact before t0");
  }

  void check(const Motion& a, const Motion& b) {
    ++t_.motions;
    const FirstContactResult r = first_contact(bodies_.a, a, bodies_.b, b, request_, context_);
    t_.steps += r.counters.steps + r.counters.spans;
    t_.grazing += r.grazing;
    t_.passed += r.passed;
    if (r.at_start) {
      ++t_.at_start;
      if (!meets(a, b, 0)) complain(t_.no_contact, "none at the start");
      return;
    }
    if (r.outcome == MotionOutcome::never) ++t_.never;
    if (r.outcome == MotionOutcome::undecided) ++t_.undecided;
    look_before(a, b, r.t0);
    if (!r.is_contact()) return;
    ++t_.contacts;
    if (!r.passed && !pair_meets(r, a.at(r.t1), b.at(r.t1)))
      complain(t_.no_contact, "its pair does not meet at t1");
    if (!r.grazing && r.t1 - r.t0 > request_.tolerance) complain(t_.wide, "the interval is too wide");
  }

  bool pair_meets(const FirstContactResult& r, const Pose& pose_a, const Pose& pose_b) {
    ++t_.samples;
    return test::meet_of(test::simplex_points(bodies_.a, pose_a, r.pair.a),
                         test::simplex_points(bodies_.b, pose_b, r.pair.b)) != exact::Meet::disjoint;
  }

  void complain(std::uint64_t& counter, const char* what) {
    torture::complain(counter, bodies_.name, t_.motions, what);
  }

  const SweepBodies& bodies_;
  RandomEngine& random_;
  const FirstContactRequest request_;
  FirstContactContext context_;
  QueryContext query_;
  SweepTally t_;
};

}  // namespace

std::uint64_t torture_sweeps(std::uint64_t count, std::uint64_t seed, unsigned jobs) {
  const std::vector<SweepBodies> list = sweep_bodies();
  return print_table(rows_of<SweepTally, SweepChecker>(list, count, seed), kSweepBatch, jobs);
}

}  // namespace lrb::torture
