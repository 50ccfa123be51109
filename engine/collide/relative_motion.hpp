#pragma once
/// Motion of B relative to A between successive poses: a bound on the displacement of any point of B, and an
/// extrapolation of the motion.
///
/// With (m, t) as in set_up_kernel(), a point x of B is m x + t on A's axes. From one pose to another it
/// moves by at most |dm c + dt| + |dm| R, where c and R are the centre and the radius of B; turn_bound()
/// bounds |dm|.
///
/// For a part of a motion, dm is not a difference of two rotations: its Frobenius norm bounds |dm| instead.
///
/// Points that are equal in the world may differ by on_a of set_up_kernel() on A's axes. rounding() bounds
/// this, the rounding of world coordinates and the rounding of everything computed here (see
/// wrapper_margin()).

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// The pose of B on A's axes, and the deviation of m from a rotation.
struct RelativePose {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double defect = 0;

  RelativePose() = default;
  RelativePose(const Eigen::Matrix3d& m, const Eigen::Vector3d& t);
};

/// A straight part of the relative motion: B at the middle pose, displaced by s (dm x + dt) on A's axes for
/// -1 <= s <= 1, and all positions within `width` of that.
struct Sweep {
  RelativePose mid_pose;
  Eigen::Matrix3d dm = Eigen::Matrix3d::Zero();
  Eigen::Vector3d dt = Eigen::Vector3d::Zero();
  double turn = 0;    ///< upper bound on |dm|
  double length = 0;  ///< upper bound on the displacement of any point of B to an end; 0: a fixed pose
  double width = 0;   ///< allowed deviation of B from the straight path
};

/// Position of B in a sweep: displaced from the middle by `at` times (dm x + dt), with a deviation of at most
/// `offset` for any point of B.
struct SweepPoint {
  double at = 0, offset = 0;
};

class RelativeMotion {
 public:
  RelativeMotion() = default;
  /// Tracks two bodies, which must not be empty. Keeps references.
  RelativeMotion(const LrbRep& a, const LrbRep& b);

  /// Records the bodies' current poses. Returns false, and forgets all poses, if the motion deviates from a
  /// rigid one by more than kRigid.
  bool record(const Pose& pose_a, const Pose& pose_b);
  /// Forgets the recorded poses, because they do not predict the next one.
  void forget() { seen_ = 0; }

  /// Returns the radius of B about its centre; mesh units.
  double radius() const { return radius_; }
  /// Returns the bound on rounding (see above) for the current poses; mesh units.
  double rounding() const { return rounding_; }
  /// Returns an upper bound on the displacement of any point of B, on A's axes, since the previous pose, or
  /// infinity if there is no previous pose; mesh units.
  double step() const;
  /// Return true if enough successive poses were recorded to judge whether B's motion is steady, and if it is
  /// steady.
  bool is_seen() const;
  bool is_kept() const;
  /// Returns the sweep of B over the next `steps` steps, or fewer if the motion is predictable only for
  /// fewer.
  Sweep ahead(double steps) const;
  /// Returns the neighbourhood of the current pose up to `width`.
  Sweep about(double width) const;
  /// Returns the position of B in a sweep.
  SweepPoint along(const Sweep& s) const;

 private:
  double farthest(const Eigen::Matrix3d& dm, const Eigen::Vector3d& dt, double turn) const;
  double motion(const RelativePose& from, const RelativePose& to) const;
  double deviation() const;
  double steady_steps() const;
  Sweep sweep_of(int steps) const;

  const LrbRep *a_ = nullptr, *b_ = nullptr;
  Eigen::Vector3d centre_{0, 0, 0};  ///< centre of B
  double radius_ = 0;                ///< radius of B about it
  int seen_ = 0;                     ///< number of successive poses recorded, at most three
  RelativePose now_, last_, earlier_;
  double rounding_ = 0;
};

}  // namespace lrb
