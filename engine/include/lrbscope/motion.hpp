#pragma once
/// Rigid motions as exact functions of the time t, from 0 to 1.

#include <span>
#include <vector>

#include <lrbscope/pose.hpp>

namespace lrb {

/// Where a body is at each t from 0 to 1. A motion consists of pieces. In a piece from t = begin to t = end,
/// with s = (t - begin) / (end - begin), a point x of the body is at
///     r exp(s [turn]) (first.r x + first.t) + (1 - s) from + s to,
/// where [w] is the matrix of the cross product, [w] y = w x y, so that exp(s [turn]) is the rotation about
/// `turn` by s times its length: many turns are as good as part of one. The numbers of the piece are the
/// doubles that it holds, and this is a function of real numbers: nothing in it is rounded. At a t that two
/// pieces share, the later one counts; that is no jump beyond the rounding of its poses.
///
/// at(t) is that function in doubles. Pose::apply() of at(t) is off the exact function by at most
/// rounding_of_motion() (motion_bounds.hpp), about 1e-15 of the sizes of what is added up.
class Motion {
 public:
  struct Piece {
    double begin = 0, end = 1;
    Pose first;  ///< applied to the body once and for all
    Eigen::Vector3d turn{0, 0, 0};
    Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
    Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  };
  /// A pose at a time.
  struct KeyFrame {
    double t = 0;
    Pose pose;
  };

  Motion() : Motion(still({})) {}
  /// Throws InputError unless the pieces go from 0 to 1 without a gap, and all numbers are finite.
  explicit Motion(std::vector<Piece> pieces);

  static Motion still(const Pose& pose);
  /// Moves straight and does not turn: the matrix stays, which may be any.
  static Motion linear(const Pose& start, const Eigen::Vector3d& end);
  /// R(t) = R0 exp(t log(R0^T R1)), p(t) = (1 - t) p0 + t p1: turns by the shortest arc. The logarithm is
  /// rounded to doubles, so that at(1) is `end` but for that; at half a turn, of both arcs, the one about the
  /// axis whose first coordinate that is not 0 is positive. Throws InputError unless both matrices are
  /// rotations, mirrored ones too, to about 1e-3, or the same.
  static Motion screw(const Pose& start, const Pose& end);
  /// Starts at a pose, turns about the world's axis `turn` through `centre` by its length in radians, and
  /// moves by `way` meanwhile, the axis with it. Any number of turns.
  static Motion turning(const Pose& start, const Eigen::Vector3d& turn, const Eigen::Vector3d& centre,
                        const Eigen::Vector3d& way);
  /// Goes from pose to pose, each time as screw() does. The first is at t = 0, the last at t = 1, and times
  /// ascend (else InputError).
  static Motion key_frames(std::span<const KeyFrame> frames);

  /// Returns the pose at a t from 0 to 1.
  Pose at(double t) const;
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  std::vector<Piece> pieces_;
};

}  // namespace lrb
