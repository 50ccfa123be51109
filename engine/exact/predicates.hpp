#pragma once
/// Signs of determinants of doubles, always exact: a floating-point filter first, then exact arithmetic where
/// the filter cannot decide. Points are arrays of doubles (3D: x, y, z; 2D: x, y), finite, of any magnitude.

namespace lrb::exact {

/// Returns the sign (-1, 0, +1) of the area of triangle a, b, c in the plane: +1 if counter-clockwise.
int orient2d(const double* a, const double* b, const double* c);

/// Returns the sign of det[b - a; c - a; d - a]: +1 if d lies on the side of plane (a, b, c) to which the
/// triangle's normal (b - a) x (c - a) points (that is, a, b, c appear counter-clockwise seen from d); 0 if
/// coplanar.
int orient3d(const double* a, const double* b, const double* c, const double* d);

/// Returns true if a, b, c lie on one line (or coincide), in 3D.
bool collinear3d(const double* a, const double* b, const double* c);

/// Turns exactness off for this thread while an object lives: signs that the filter cannot decide are then
/// those of plain double arithmetic, right or wrong. Exists to measure what exactness costs and what goes
/// wrong without it.
class FloatingPredicates {
 public:
  explicit FloatingPredicates(bool on = true);
  ~FloatingPredicates();
  FloatingPredicates(const FloatingPredicates&) = delete;
  FloatingPredicates& operator=(const FloatingPredicates&) = delete;

 private:
  bool before_;
};

/// Returns true while a FloatingPredicates is in force on this thread.
bool only_floating();

}  // namespace lrb::exact
