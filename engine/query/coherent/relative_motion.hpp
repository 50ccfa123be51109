#pragma once
/// How B moves, seen from A, from one pose of the two bodies to the next: how far any of its points has come
/// at most, and where it will be if it goes on like this.
///
/// With (m, t) as in set_up_kernel() the points of B, on A's axes, are m x + t. From one pose to another they
/// move by at most |dm c + dt| + |dm| R, where c and R are the middle and radius of B. Between rotations
/// |dm|^2 is half the sum of the squares of dm's entries. An m with |m^T m - 1| <= D is within D of a
/// rotation: between two of those |dm| is at most what it would be between rotations, taken from dm itself,
/// and 2.3 times the sum of both D more.
///
/// The same for parts of a motion, which are not between rotations, with the root of the sum of all squares.
///
/// Points that are equal in the world are not quite equal on A's axes: they may differ by on_a of
/// set_up_kernel(), which rounding() bounds, together with the rounding of world coordinates and of all
/// that is computed here (see wrapper_margin()).

#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// B seen from A, and how far m is from a rotation.
struct RelativePose {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double defect = 0;

  RelativePose() = default;
  RelativePose(const Eigen::Matrix3d& m, const Eigen::Vector3d& t);
};

/// A stretch of a course: B from the middle by -1 to 1 times (dm x + dt), on A's axes, and all that is near.
struct Sweep {
  RelativePose middle;
  Eigen::Matrix3d dm = Eigen::Matrix3d::Zero();
  Eigen::Vector3d dt = Eigen::Vector3d::Zero();
  double turn = 0;    ///< a bound of |dm|
  double length = 0;  ///< a bound of how far any point of B goes from the middle to an end; 0: a place
  double width = 0;   ///< B may be so far off
};

/// Where B is: so many times (dm x + dt) from the middle, and no point of it further off from there.
struct SweepPoint {
  double at = 0, off = 0;
};

class RelativeMotion {
 public:
  RelativeMotion() = default;
  /// Of bodies that are not empty. Keeps references.
  RelativeMotion(const LrbRep& a, const LrbRep& b);

  /// The bodies are at these poses now. False, and all is forgotten, if that is further from a rigid motion
  /// than kRigid.
  bool see(const Pose& pose_a, const Pose& pose_b);
  /// What was seen tells nothing of what will be.
  void forget() { seen_ = 0; }

  /// Of B, about its middle. Mesh's unit.
  double radius() const { return radius_; }
  /// Mesh's unit; of the pose of now.
  double rounding() const { return rounding_; }
  /// An upper bound of how far any point of B is now, on A's axes, from where it was at the pose before;
  /// infinite if there was none. Mesh's unit.
  double step() const;
  /// Enough poses in a row to tell whether B keeps its course; and whether it does.
  bool is_seen() const;
  bool is_kept() const;
  /// Where B will be for so many steps, if it keeps its course, as it does.
  Sweep ahead(double steps) const;
  /// The surroundings of where B is.
  Sweep about(double width) const;
  SweepPoint along(const Sweep& s) const;

 private:
  double farthest(const Eigen::Matrix3d& dm, const Eigen::Vector3d& dt, double turn) const;
  double motion(const RelativePose& from, const RelativePose& to) const;
  double off_course() const;
  double steps_on_course() const;
  Sweep sweep_of(int steps) const;

  const LrbRep *a_ = nullptr, *b_ = nullptr;
  Eigen::Vector3d middle_{0, 0, 0};  ///< of B
  double radius_ = 0;                ///< of B about it
  int seen_ = 0;                     ///< so many poses in a row, but no more than three
  RelativePose now_, last_, earlier_;
  double rounding_ = 0;
};

}  // namespace lrb
