// Outlines without the parts that run along a line and back.
#include <doctest/doctest.h>

#include "render/scene_parts.hpp"

namespace lrb::render {
namespace {

Segment2d segment(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector3d(x0, y0, 0), Eigen::Vector3d(x1, y1, 0)};
}

/// Returns the largest x of the segments.
double reach(const std::vector<Segment2d>& segments) {
  double most = -1e9;
  for (const Segment2d& s : segments)
    for (const Eigen::Vector3d& p : s) most = std::max(most, p.x());
  return most;
}

TEST_CASE("outlines: lids that run to a point and back are left out, the rest is kept") {
  // The lids of a wrapper of a gear, 7e-7 apart.
  const std::vector<Segment2d> lids = {segment(0.334, 1.0398, -0.337, 1.0368),
                                       segment(-0.337, 1.0368, 0.437, 1.0403),
                                       segment(0.437, 1.0403, -0.624, 1.0355)};
  CHECK(reach(lids) == 0.437);
  const std::vector<Segment2d> rest = without_hairs(lids, 4e-4);
  CHECK(reach(rest) == doctest::Approx(0.334).epsilon(0.001));
  double leftmost = 0, length = 0;
  for (const Segment2d& s : rest) {
    leftmost = std::min(leftmost, s[1].x());
    length = std::max(length, s[0].x() - s[1].x());
  }
  CHECK(leftmost == -0.624);
  CHECK(length == doctest::Approx(0.334 + 0.624).epsilon(0.001));  // one piece
}

TEST_CASE("outlines: corners, parallel sides at a distance, and equal directions are kept") {
  const std::vector<Segment2d> square = {segment(0, 0, 1, 0), segment(1, 0, 1, 1), segment(1, 1, 0, 1),
                                         segment(0, 1, 0, 0)};
  CHECK(without_hairs(square, 1e-3) == square);
  const std::vector<Segment2d> same = {segment(0, 0, 1, 0), segment(0.5, 1e-6, 2, 1e-6)};
  CHECK(without_hairs(same, 1e-3) == same);
  const std::vector<Segment2d> crossing = {segment(0, 0, 1, 1), segment(1, 0, 0, 1)};
  CHECK(without_hairs(crossing, 1e-3) == crossing);
  CHECK(without_hairs({segment(0, 0, 1, 0), segment(1, 1e-9, 0, 1e-9)}, 1e-3).empty());
}

}  // namespace
}  // namespace lrb::render
