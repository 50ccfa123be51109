// What captions say of bodies that are apart.
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "render/pictures/marks.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/distance.hpp>

namespace lrb {
namespace {

/// Returns the number behind "gap >= ".
double gap_in(const std::string& words) {
  const std::string before = "gap >= ";
  REQUIRE(words.find(before) != std::string::npos);
  return std::stod(words.substr(words.find(before) + before.size()));
}

TEST_CASE("captions: a gap is a lower bound of the distance, and shrinks as the bodies approach") {
  const LrbRep ring = build_lrb(shapes::torus(24, 12));
  Pose through = Pose::translation({1, 0, 0});
  through.r << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  double last = 1e300;
  for (const double x : {4.0, 3.5, 3.0, 2.8, 1.05, 1.1, 1.15}) {  // beside it; then linked with it
    if (x == 1.05) last = 1e300;
    CAPTURE(x);
    through.t.x() = x;
    const WalkExplanation walk = explain_walk(ring, {}, ring, through);
    REQUIRE(walk.result.pairs.empty());
    const std::string words = pictures::separating_plane_text(walk, {ring, {}, ring, through});
    CHECK(words.starts_with(walk.plane ? "by a plane, " : "by boxes, "));
    if (x == 4 || x < 2) CHECK(walk.plane.has_value() == (x == 4));
    const double gap = gap_in(words), distance = lrb::distance(ring, {}, ring, through).upper;
    CHECK(gap <= distance);
    CHECK(gap >= 0.99 * distance);  // three digits
    CHECK(gap <= last);
    last = gap;
  }
}

TEST_CASE("a lower bound is rounded down where it is printed") {
  for (const auto& [x, text] : std::vector<std::pair<double, std::string>>{{0.0236, "0.0236"},
                                                                           {0.02366, "0.0236"},
                                                                           {0.02364, "0.0236"},
                                                                           {2, "2"},
                                                                           {1.9999999, "1.99"},
                                                                           {9.996, "9.99"},
                                                                           {0.09999, "0.0999"},
                                                                           {1e-9, "1e-09"},
                                                                           {999.9, "999"},
                                                                           {123456, "1.23e+05"},
                                                                           {1235999, "1.23e+06"},
                                                                           {7.7775e-300, "7.77e-300"}})
    CHECK(io::lower_text(x) == text);
}

}  // namespace
}  // namespace lrb
