#pragma once
/// Adds up squared distances from planes.

#include <Eigen/Core>

namespace lrb::resolutions {

/// The sum over some triangles of area times squared distance from the triangle's plane, as a function of the
/// point: x^T a x - 2 b^T x + c, with a symmetric. Its unit is length^4.
class Quadric {
 public:
  Quadric() = default;
  /// Starts with the plane through p with normal n; the length of n is the plane's weight.
  Quadric(const Eigen::Vector3d& n, const Eigen::Vector3d& p) {
    weight_ = n.norm();
    if (!(weight_ > 0)) return;
    const Eigen::Vector3d unit = n / weight_;
    const double d = unit.dot(p);
    xx_ = weight_ * unit.x() * unit.x();
    xy_ = weight_ * unit.x() * unit.y();
    xz_ = weight_ * unit.x() * unit.z();
    yy_ = weight_ * unit.y() * unit.y();
    yz_ = weight_ * unit.y() * unit.z();
    zz_ = weight_ * unit.z() * unit.z();
    b_ = weight_ * d * unit;
    c_ = weight_ * d * d;
  }

  Quadric& operator+=(const Quadric& q) {
    xx_ += q.xx_, xy_ += q.xy_, xz_ += q.xz_, yy_ += q.yy_, yz_ += q.yz_, zz_ += q.zz_;
    b_ += q.b_;
    c_ += q.c_;
    weight_ += q.weight_;
    return *this;
  }
  friend Quadric operator+(Quadric p, const Quadric& q) { return p += q; }

  double weight() const { return weight_; }  ///< of all planes together
  double at(const Eigen::Vector3d& p) const { return p.dot(times(p)) - 2 * b_.dot(p) + c_; }

  /// Returns the point where at(x) + pull |x - m|^2 is least; pull > 0.
  Eigen::Vector3d lowest(const Eigen::Vector3d& m, double pull) const {
    // By Cramer's rule: the matrix is positive definite because of the pull, and the result is the same on
    // every machine.
    const double xx = xx_ + pull, yy = yy_ + pull, zz = zz_ + pull;
    const Eigen::Vector3d r = b_ + pull * m;
    const double cxx = yy * zz - yz_ * yz_, cxy = yz_ * xz_ - xy_ * zz, cxz = xy_ * yz_ - yy * xz_;
    const double cyy = xx * zz - xz_ * xz_, cyz = xy_ * xz_ - xx * yz_, czz = xx * yy - xy_ * xy_;
    const double det = xx * cxx + xy_ * cxy + xz_ * cxz;
    return {(cxx * r.x() + cxy * r.y() + cxz * r.z()) / det, (cxy * r.x() + cyy * r.y() + cyz * r.z()) / det,
            (cxz * r.x() + cyz * r.y() + czz * r.z()) / det};
  }

 private:
  Eigen::Vector3d times(const Eigen::Vector3d& p) const {
    return {xx_ * p.x() + xy_ * p.y() + xz_ * p.z(), xy_ * p.x() + yy_ * p.y() + yz_ * p.z(),
            xz_ * p.x() + yz_ * p.y() + zz_ * p.z()};
  }

  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0, c_ = 0, weight_ = 0;
  Eigen::Vector3d b_ = Eigen::Vector3d::Zero();
};

}  // namespace lrb::resolutions
