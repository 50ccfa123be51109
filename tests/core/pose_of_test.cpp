// Poses from what others keep them in, to the bit.
#include <limits>

#include <doctest/doctest.h>

#include <lrbscope/pose.hpp>

using namespace lrb;

namespace {

const Pose kPose = Pose::rotation({1, -2, 3}, 0.7, {4, 5, 1e-300});

void check_equal(const Pose& x, const Pose& y) {
  CHECK(x.r == y.r);
  CHECK(x.t == y.t);
}

}  // namespace

TEST_CASE("a pose converts from Eigen's types without loss") {
  check_equal(pose_of(transform_of(kPose)), kPose);
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = kPose.r;
  isometry.translation() = kPose.t;
  check_equal(pose_of(isometry), kPose);
  check_equal(pose_of(Eigen::AffineCompact3d(matrix_of(kPose).topRows<3>())), kPose);
  check_equal(pose_of(matrix_of(kPose)).value(), kPose);
  check_equal(pose_of(Eigen::Matrix<double, 3, 4>(matrix_of(kPose).topRows<3>())).value(), kPose);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  check_equal(pose_of(turn, {1, 2, 3}), {turn.toRotationMatrix(), {1, 2, 3}});
}

TEST_CASE("a pose converts from rows of numbers, 3 x 4 or 4 x 4") {
  const double rows[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0, 0, 0, 1};
  Pose expected;
  expected.r << 1, 2, 3, 5, 6, 7, 9, 10, 11;
  expected.t << 4, 8, 12;
  check_equal(pose_of_rows(rows).value(), expected);
  check_equal(pose_of_rows(std::span(rows).first(12)).value(), expected);
  std::vector<double> three;
  for (int i = 0; i < 3; ++i) three.insert(three.end(), rows, rows + 16);
  REQUIRE(poses_of_rows(three, 3).value().size() == 3);
  check_equal(poses_of_rows(three, 3).value()[2], expected);
  CHECK(poses_of_rows(std::span(three).first(36), 3).value().size() == 3);  // (3, 3, 4)
  CHECK(poses_of_rows({}, 0).value().empty());
}

TEST_CASE("invalid poses are rejected with a reason") {
  double rows[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  CHECK(pose_of_rows(std::span(rows).first(9)).error().reason ==
        "pose: expected 12 numbers (3 x 4) or 16 (4 x 4), row by row, found 9");
  CHECK(pose_of(Eigen::Matrix3d(Eigen::Matrix3d::Zero())).error().reason ==
        "pose: expected a matrix of 3 x 4 or 4 x 4, found 3 x 3");
  CHECK(poses_of_rows(rows, 3).error().reason ==
        "3 poses: expected 12 numbers (3 x 4) or 16 (4 x 4) for each, row by row, found 32 in all");
  CHECK(!poses_of_rows(std::vector<double>(37), 3));  // 12 for each, and one more
  CHECK(!poses_of_rows({}, 2));
  CHECK(!poses_of_rows(rows, 0));
  rows[31] = 2;
  CHECK(
      poses_of_rows(rows, 2).error().reason ==
      "pose 1: expected an affine matrix for column vectors, with the last row 0 0 0 1, found another last row");
  rows[31] = std::numeric_limits<double>::quiet_NaN();
  CHECK(!poses_of_rows(rows, 2));
}
