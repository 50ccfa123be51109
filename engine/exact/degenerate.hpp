#pragma once
/// Triangles that lie in one plane, and triangles whose corners lie on one line. Private to engine/exact.

namespace lrb::exact {

/// What a triangle's corners span, exactly: the triangle, a segment or a point.
struct Hull {
  const double* corner[3];  ///< the first dim + 1; a segment's are the lexicographic extremes of the three
  int dim;
};

Hull hull_of(const double* const t[3]);

/// A pair of coordinates to project to, such that three points that are not on one line stay off one line.
struct Axes {
  int x, y;
  int turn;  ///< orientation of the projected points, -1 or +1
};

/// Returns axes for three points; turn = 0 if they are on one line.
Axes axes_for(const double* a, const double* b, const double* c);

/// Returns true if two hulls share a point. They may have any dimensions, but two triangles must lie in one
/// plane.
bool hulls_meet(const Hull& a, const Hull& b);

}  // namespace lrb::exact
