#pragma once
/// Signs of determinants of doubles, always exact: a floating-point filter first, exact arithmetic where it
/// cannot decide. Points are arrays of doubles (3D: x, y, z; 2D: x, y), finite, of any magnitude.

namespace lrb::exact {

/// Sign (-1, 0, +1) of the area of triangle a, b, c in the plane: +1 if counter-clockwise.
int orient2d(const double* a, const double* b, const double* c);

/// Sign of det[b - a; c - a; d - a]: +1 if d lies on the side of plane (a, b, c) to which the triangle's
/// normal (b - a) x (c - a) points (that is, a, b, c appear counter-clockwise seen from d); 0 if coplanar.
int orient3d(const double* a, const double* b, const double* c, const double* d);

/// True if a, b, c lie on one line (or coincide), in 3D.
bool collinear3d(const double* a, const double* b, const double* c);

/// While one lives, this thread's predicates give up exactness: signs that the filter cannot decide are those
/// of plain double arithmetic, right or wrong. It exists to measure what exactness costs and what its lack
/// breaks.
class FloatingPredicates {
 public:
  explicit FloatingPredicates(bool on = true);
  ~FloatingPredicates();
  FloatingPredicates(const FloatingPredicates&) = delete;
  FloatingPredicates& operator=(const FloatingPredicates&) = delete;

 private:
  bool before_;
};

/// Whether one lives on this thread.
bool only_floating();

}  // namespace lrb::exact
