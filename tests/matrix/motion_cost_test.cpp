/// No motion, however degenerate, and no tolerance, however small, takes a search for a first contact more
/// than forty times the work of an ordinary one: for every kind of body of the matrix that can be loaded,
/// against itself.

#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "tests/matrix/bodies.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb::matrix {
namespace {

using Eigen::Vector3d;

std::uint64_t work_of(const Body& body, const Motion& motion, double tolerance) {
  FirstContactRequest request;
  request.tolerance = tolerance;
  const FirstContactResult r = first_contact(body, Motion(), body, motion, request);
  CHECK(r.t0 <= r.t1);
  // About what each costs, in steps of a pair.
  const FirstContactCounters& c = r.counters;
  return 16 * c.spans + c.pairs / 16 + c.steps + 64 * c.exact_queries;
}

Motion straight(const Vector3d& from, const Vector3d& to) {
  return Motion::linear(Pose::translation(from), to);
}

}  // namespace

TEST_CASE("no motion and no tolerance takes more than 40 times the work of an ordinary search") {
  const Matrix matrix = make_matrix(1);
  std::size_t searched = 0;
  double largest = 0;
  for (const Kind& kind : matrix.kinds) {
    CAPTURE(kind.name);
    const Expected<Body> loaded = Body::from(kind.mesh);
    if (!loaded) continue;
    const Body& body = *loaded;
    const Eigen::AlignedBox3d box = world_box(body, {});
    const double d = box.diagonal().norm();
    if (!(d > 0)) continue;
    // Ordinary: B comes straight at A along an axis, a little off its middle.
    std::uint64_t ordinary = 0;
    for (int axis = 0; axis < body.rep().dim(); ++axis) {
      const Vector3d along = Vector3d::Unit(axis), aside = Vector3d::Unit((axis + 1) % body.rep().dim());
      ordinary = std::max(
          ordinary, work_of(body, straight(3 * d * along + 0.013 * d * aside, 0.013 * d * aside), 1e-9));
    }
    // Sliding in the plane of faces, at rest, closing in on a touch, by less than doubles tell, turning on
    // the spot.
    std::vector<Motion> hard = {straight({1.5 * d, 0, 0}, {-1.5 * d, 0, 0}),
                                straight({0, 1.5 * d, 0}, {0, -1.5 * d, 0}),
                                straight({1.01 * d, 0, 0}, {1.01 * d, 0, 0}),
                                straight({0, 0, 0}, {0, 0, 0}),
                                straight({1.5 * d, 0, 0}, {box.sizes().x(), 0, 0}),
                                straight({box.sizes().x(), 0, 0}, {box.sizes().x(), d, 0}),
                                straight({1.0000001 * d, 0, 0}, {1.0000001 * d - 1e-300 * d, 0, 0}),
                                Motion::turning(Pose::translation({1.1 * d, 0, 0}),
                                                {0, 0, 4 * std::numbers::pi}, {0, 0, 0}, {0, 0, 0})};
    for (std::size_t m = 0; m < hard.size(); ++m)
      for (const double tolerance : {1e-9, 1e-15, 1e-300}) {
        CAPTURE(m);
        CAPTURE(tolerance);
        const std::uint64_t work = work_of(body, hard[m], tolerance);
        CHECK(work <= 40 * ordinary);
        largest = std::max(largest, static_cast<double>(work) / static_cast<double>(ordinary));
      }
    ++searched;
  }
  CHECK(searched > 30);
  MESSAGE("the largest share: " << largest << " times the work of an ordinary search");
}

}  // namespace lrb::matrix
