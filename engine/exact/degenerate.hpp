#pragma once
/// Triangles that lie in one plane, or whose corners lie on one line. Private to engine/exact.

namespace lrb::exact {

/// What a triangle's corners span: the triangle, a segment or a point, exactly.
struct Hull {
  const double* corner[3];  ///< the first dim + 1; a segment's are the lexicographic extremes of the three
  int dim;
};

Hull hull_of(const double* const t[3]);

/// A pair of coordinates in which three points that are not on one line stay off one line.
struct Axes {
  int x, y;
  int turn;  ///< orientation of the points there, -1 or +1
};

/// turn = 0 if the points are on one line.
Axes axes_for(const double* a, const double* b, const double* c);

/// True if two hulls share a point: of any dimensions, but two triangles must lie in one plane.
bool hulls_meet(const Hull& a, const Hull& b);

}  // namespace lrb::exact
