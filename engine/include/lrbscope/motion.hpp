#pragma once
/// Rigid motions as exact functions of the time t in [0, 1].

#include <span>
#include <vector>

#include <lrbscope/pose.hpp>

namespace lrb {

/// The pose of a body for each t in [0, 1]. A motion consists of pieces. In a piece from t = begin to t =
/// end, with s = (t - begin) / (end - begin), a point x of the body is at
///     r exp(s [turn]) (first.r x + first.t) + (1 - s) from + s to,
/// where [w] is the cross product matrix, [w] y = w x y, so that exp(s [turn]) is the rotation about `turn`
/// by the angle s |turn|. The angle may exceed a full revolution. This is a function of real numbers whose
/// parameters are the doubles stored in the piece; nothing in it is rounded. At a t shared by two pieces the
/// later one applies; the jump there is at most the rounding error of the poses.
///
/// at(t) evaluates this function in doubles. Pose::apply() of at(t) deviates from the exact function by at
/// most MovingBody::rounding() (motion_bounds.hpp), about 1e-15 of the magnitude of the summands.
class Motion {
 public:
  struct Piece {
    double begin = 0, end = 1;
    Pose first;  ///< applied to the body before the motion
    Eigen::Vector3d turn{0, 0, 0};
    Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
    Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  };
  /// A pose at a given time.
  struct KeyFrame {
    double t = 0;
    Pose pose;
  };

  Motion() : Motion(still({})) {}
  /// Throws InputError unless the pieces cover [0, 1] without gaps and all numbers are finite.
  explicit Motion(std::vector<Piece> pieces);

  /// Stays at one pose.
  static Motion still(const Pose& pose);
  /// Translates at constant velocity from the pose `start` to the position `end`. The matrix is constant and
  /// arbitrary.
  static Motion linear(const Pose& start, const Eigen::Vector3d& end);
  /// R(t) = R0 exp(t log(R0^T R1)), p(t) = (1 - t) p0 + t p1: rotates by the shortest arc. The logarithm is
  /// rounded to doubles, so at(1) equals `end` up to rounding. A half turn has two shortest arcs: the one
  /// about the axis with a positive first nonzero coordinate is taken. Throws InputError unless both matrices
  /// are rotations (mirrored ones included) to about 1e-3, or equal.
  static Motion screw(const Pose& start, const Pose& end);
  /// Starts at a pose, rotates about the world axis `turn` through `centre` by |turn| radians, and translates
  /// by `translation` at the same time, together with the axis. |turn| may exceed a full revolution.
  static Motion turning(const Pose& start, const Eigen::Vector3d& turn, const Eigen::Vector3d& centre,
                        const Eigen::Vector3d& translation);
  /// Interpolates between key frames as screw() does. Throws InputError unless the first is at t = 0, the
  /// last at t = 1, and times ascend.
  static Motion key_frames(std::span<const KeyFrame> frames);

  /// Returns the pose at t in [0, 1].
  Pose at(double t) const;
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  std::vector<Piece> pieces_;
};

}  // namespace lrb
