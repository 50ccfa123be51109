#pragma once
/// The relative motion of B, seen from A, from one pose of the two bodies to the next: a bound on how far any
/// point of B has moved, and where B will be if it goes on like this.
///
/// With (m, t) as in set_up_kernel(), the points of B on A's axes are m x + t. From one pose to another they
/// move by at most |dm c + dt| + |dm| R, where c and R are the middle and the radius of B; turn_bound()
/// bounds |dm|.
///
/// For parts of a motion, which are not between rotations, the same holds with the root of the sum of all
/// squares.
///
/// Points that are equal in the world are not quite equal on A's axes: they may differ by on_a of
/// set_up_kernel(). rounding() bounds this together with the rounding of world coordinates and of everything
/// that is computed here (see wrapper_margin()).

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// The pose of B seen from A, and how far m is from a rotation.
struct RelativePose {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double defect = 0;

  RelativePose() = default;
  RelativePose(const Eigen::Matrix3d& m, const Eigen::Vector3d& t);
};

/// A part of the relative motion: B at the middle pose, displaced by -1 to 1 times (dm x + dt) on A's axes,
/// and everything within `width` of that.
struct Sweep {
  RelativePose middle;
  Eigen::Matrix3d dm = Eigen::Matrix3d::Zero();
  Eigen::Vector3d dt = Eigen::Vector3d::Zero();
  double turn = 0;    ///< a bound on |dm|
  double length = 0;  ///< a bound on how far any point of B moves from the middle to an end; 0: a fixed pose
  double width = 0;   ///< B may be off by this much
};

/// The position of B relative to a sweep: displaced from the middle by `at` times (dm x + dt), with no point
/// of B further than `off` from there.
struct SweepPoint {
  double at = 0, off = 0;
};

class RelativeMotion {
 public:
  RelativeMotion() = default;
  /// Follows two bodies, which must not be empty. Keeps references.
  RelativeMotion(const LrbRep& a, const LrbRep& b);

  /// Takes in the bodies' current poses. Returns false, and forgets everything, if they are further from a
  /// rigid motion than kRigid.
  bool see(const Pose& pose_a, const Pose& pose_b);
  /// Forgets what was seen, because it tells nothing about what will come.
  void forget() { seen_ = 0; }

  /// Returns the radius of B about its middle. Mesh's unit.
  double radius() const { return radius_; }
  /// Returns the bound on rounding (see above) for the current poses. Mesh's unit.
  double rounding() const { return rounding_; }
  /// Returns an upper bound on how far any point of B has moved, on A's axes, since the pose before; infinite
  /// if there was none. Mesh's unit.
  double step() const;
  /// Tell whether enough poses in a row were seen to judge if B's motion is steady, and whether it is.
  bool is_seen() const;
  bool is_kept() const;
  /// Returns the sweep of B over the next `steps` steps, or as many as can be foreseen, if its motion stays
  /// steady.
  Sweep ahead(double steps) const;
  /// Returns the surroundings, up to `width`, of the current pose.
  Sweep about(double width) const;
  /// Returns where B is relative to a sweep.
  SweepPoint along(const Sweep& s) const;

 private:
  double farthest(const Eigen::Matrix3d& dm, const Eigen::Vector3d& dt, double turn) const;
  double motion(const RelativePose& from, const RelativePose& to) const;
  double deviation() const;
  double steady_steps() const;
  Sweep sweep_of(int steps) const;

  const LrbRep *a_ = nullptr, *b_ = nullptr;
  Eigen::Vector3d middle_{0, 0, 0};  ///< middle of B
  double radius_ = 0;                ///< radius of B about it
  int seen_ = 0;                     ///< number of poses seen in a row, three at most
  RelativePose now_, last_, earlier_;
  double rounding_ = 0;
};

}  // namespace lrb
