#include <doctest/doctest.h>

#include "scenarios/io/poses.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;

TEST_CASE("poses: blank lines, comments, commas, CRLF, plus signs") {
  const std::vector<Pose> poses = io::parse_poses(
      "# a comment\r\n\r\n1 0 0 5  0 1 0 6  0 0 1 7\r\n  1,0,0,-1.5, 0,+1,0,2e3, 0,0,1,.25 # behind it\n\n",
      "p.txt");
  REQUIRE(poses.size() == 2);
  CHECK(poses[0].r == Eigen::Matrix3d::Identity());
  CHECK(poses[0].t == Eigen::Vector3d(5, 6, 7));
  CHECK(poses[1].t == Eigen::Vector3d(-1.5, 2000, 0.25));
}

TEST_CASE("poses: row-major") {
  const Pose p = io::parse_poses("1 2 3 4 5 6 7 8 9 10 11 12", "p")[0];
  CHECK(p.r(0, 1) == 2);
  CHECK(p.r(1, 0) == 5);
  CHECK(p.t == Eigen::Vector3d(4, 8, 12));
}

TEST_CASE("poses: errors report file and line") {
  const auto fails = [](const std::string& text, const char* message) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(io::parse_poses(text, "p.txt"), message, InputError);
  };
  fails("1 0 0 5  0 1 0 6  0 0 1 7\n\n1 2 3", "p.txt:3: expected 12 numbers (a row-major 3x4 pose), found 3");
  fails("1 0 0 x 0 1 0 0 0 0 1 0", "p.txt:1: \"x\" is not a number: expected 12 numbers per line");
  fails("1 0 0 nan 0 1 0 0 0 0 1 0", "p.txt:1: \"nan\" is not finite; every number must be finite");
  fails("1 0 0 1e999 0 1 0 0 0 0 1 0", "p.txt:1: \"1e999\" exceeds the range of a double");
  fails("", "p.txt: no poses: expected lines of 12 numbers (row-major 3x4)");
  fails(std::string("1 0 0 \0 0 1 0 0 0 0 1 0", 23),
        "p.txt:1: \"?\" is not a number: expected 12 numbers per line");
}

TEST_CASE("parse_vector() accepts three finite numbers only") {
  CHECK(io::parse_vector("1,-2,3.5", "--from") == Eigen::Vector3d(1, -2, 3.5));
  CHECK_THROWS_WITH_AS(io::parse_vector("1,2", "--from"),
                       "--from: expected three numbers X,Y,Z, found 2 in \"1,2\"", InputError);
  CHECK_THROWS_AS(io::parse_vector("1,2,inf", "--from"), InputError);
}
