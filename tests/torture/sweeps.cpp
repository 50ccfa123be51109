#include <cmath>

#include "engine/collide/collide_into.hpp"
#include "engine/motion/contact_search.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/simplex_distance.hpp"
#include "tests/torture/torture.hpp"

namespace lrb::torture {
namespace {

/// Draws motions of all kinds.
class Motions {
 public:
  Motions(const cases::Case& c, RandomEngine& random)
      : c_(c),
        random_(random),
        dim_(c.a->dim()),
        size_(shapes::box_of(*c.a).diagonal().norm() + shapes::box_of(*c.b).diagonal().norm()) {}
  double size() const { return size_; }

  Motion motion_a() {
    if (random_() % 3 != 0) return Motion::still({});
    const Pose start{shapes::random_rotation(random_, dim_), 0.2 * size_ * direction()};
    return Motion::turning(start, uniform(random_, 0, 3) * axis(), start.t, 0.3 * size_ * direction());
  }

  Motion motion_b() {
    const double size = size_;
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
    const double size = size_;
    double hits = 0, misses = size;
    const auto beside = [&](double x) {
      return Motion::linear({r, x * aside - size * way}, x * aside + size * way);
    };
    FirstContactRequest request;
    request.max_steps = 100'000;
    for (int i = 0; i < 40; ++i) {
      const double x = (hits + misses) / 2;
      const Motion m = beside(x);
      (first_contact(*c_.a, Motion::still({}), *c_.b, m, request, context_).outcome == MotionOutcome::never
           ? misses
           : hits) = x;
    }
    return beside(misses + (random_() % 2 ? -1 : 1) * std::pow(10, uniform(random_, -17, -1)) * size);
  }

  const cases::Case& c_;
  RandomEngine& random_;
  FirstContactContext context_;
  int dim_;
  double size_;  ///< of both bodies
};

}  // namespace

void check_motion(const cases::Case& c, RandomEngine& random, Tally& t, std::string& trouble) {
  constexpr int kSamples = 40, kCloseSamples = 24;
  static FirstContactContext context;
  static QueryContext query;
  Motions motions(c, random);
  if (!(motions.size() > 1e-6 && motions.size() < 1e6)) return;
  const Motion of_a = motions.motion_a(), of_b = motions.motion_b();
  ++t.motions;
  const auto meets = [&](double at) {
    CollideRequest any;
    any.mode = Mode::any_pair;
    NullProbe probe;
    return !collide(*c.a, of_a.at(at), *c.b, of_b.at(at), any, query, probe).pairs.empty();
  };
  const FirstContactRequest request;
  const FirstContactResult r = first_contact(*c.a, of_a, *c.b, of_b, request, context);
  t.contacts += r.is_contact();
  if (r.at_start) {
    if (!meets(0)) complain(t.no_contact, trouble, "motion: no contact at the start");
    return;
  }
  // At times before t0, most of them close to it.
  bool missed = false;
  for (int i = 0; i < kSamples; ++i) missed = missed || meets(r.t0 * uniform(random));
  for (int i = 0; i < kCloseSamples; ++i)
    missed = missed || meets(r.t0 * (1 - std::pow(10, uniform(random, -16, -2))));
  if (missed || meets(std::nextafter(r.t0, 0))) complain(t.misses, trouble, "motion: a contact before t0");
  if (!r.is_contact()) return;
  if (!r.passed &&
      test::meet_of(test::simplex_points(*c.a, of_a.at(r.t1), r.pair.a),
                    test::simplex_points(*c.b, of_b.at(r.t1), r.pair.b)) == exact::Meet::disjoint)
    complain(t.no_contact, trouble, "motion: its pair does not meet at t1");
  if (!r.grazing && r.t1 - r.t0 > request.tolerance)
    complain(t.wide, trouble, "motion: the interval is too wide");
}

}  // namespace lrb::torture
