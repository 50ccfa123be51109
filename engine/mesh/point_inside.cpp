#include "engine/mesh/point_inside.hpp"

#include <algorithm>

#include "engine/exact/predicates.hpp"

namespace lrb {
namespace {

int sign_of_difference(double a, double b) {
  return (a > b) - (a < b);
}

/// Sign of the turn a, b, c seen along an axis: that component of (b - a) x (c - a).
int turn_along(int axis, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double pa[2] = {a[x], a[y]}, pb[2] = {b[x], b[y]}, pc[2] = {c[x], c[y]};
  return exact::orient2d(pa, pb, pc);
}

int first_nonzero(std::initializer_list<int> signs) {
  const auto it = std::find_if(signs.begin(), signs.end(), [](int s) { return s != 0; });
  return it == signs.end() ? 0 : *it;
}

/// turn_along(0, a, b, p) for the moved p: the turn grows with p.y as a.z - b.z and with p.z as b.y - a.y.
int moved_turn(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p) {
  return first_nonzero(
      {turn_along(0, a, b, p), sign_of_difference(a.z(), b.z()), sign_of_difference(b.y(), a.y())});
}

bool ray_can_reach(const Eigen::Vector3d& p, std::initializer_list<const Eigen::Vector3d*> corners) {
  bool ahead = false, left = false, right = false, below = false, above = false;
  for (const Eigen::Vector3d* c : corners) {
    ahead |= c->x() >= p.x();
    left |= c->y() <= p.y();
    right |= c->y() >= p.y();
    below |= c->z() <= p.z();
    above |= c->z() >= p.z();
  }
  return ahead && left && right && below && above;
}

void cast_at_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& p, PointSide& side) {
  if (!ray_can_reach(p, {&a, &b, &c})) return;
  const int ab = moved_turn(a, b, p), bc = moved_turn(b, c, p), ca = moved_turn(c, a, p);
  const int facing = turn_along(0, a, b, c);  // the side of the normal's x
  const int height = exact::orient3d(a.data(), b.data(), c.data(), p.data());
  if (height == 0 && !side.on_surface) {
    // In the plane: on the triangle if it is on the inner side of all edges as seen along an axis that sees
    // area.
    for (int axis = 0; axis < 3 && !side.on_surface; ++axis) {
      const int turn = turn_along(axis, a, b, c);
      side.on_surface = turn != 0 && turn_along(axis, a, b, p) != -turn &&
                        turn_along(axis, b, c, p) != -turn && turn_along(axis, c, a, p) != -turn;
    }
  }
  if (facing == 0 || ab != facing || bc != facing || ca != facing) return;
  const int moved_height = first_nonzero({height, turn_along(1, a, b, c), turn_along(2, a, b, c), facing});
  if (moved_height == -facing) side.inside = !side.inside;  // p is behind, seen along the ray
}

/// The same in the plane: the ray starts at p + (e^2, e).
void cast_at_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p,
                     PointSide& side) {
  const int turn = exact::orient2d(a.data(), b.data(), p.data());
  const auto between = [](double x, double from, double to) {
    return std::min(from, to) <= x && x <= std::max(from, to);
  };
  side.on_surface |= turn == 0 && between(p.x(), a.x(), b.x()) && between(p.y(), a.y(), b.y());
  const bool a_above = a.y() > p.y(), b_above = b.y() > p.y();  // a point at p's height is below the moved p
  if (a_above == b_above) return;
  const int upward = b_above ? 1 : -1;
  // The turn grows with p.y as b.x - a.x and with p.x as a.y - b.y.
  const int moved = first_nonzero({turn, sign_of_difference(b.x(), a.x()), -upward});
  if (moved == upward)
    side.inside = !side.inside;  // an upward segment crosses in front of p if p is on its left
}

}  // namespace

PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p) {
  PointSide side;
  for (const FaceId f : faces) {
    const auto c = mesh.face(f);
    if (mesh.dim == 2) {
      cast_at_segment(mesh.vertices[c[0]], mesh.vertices[c[1]], p, side);
      continue;
    }
    for (std::size_t i = 1; i + 1 < c.size(); ++i)
      cast_at_triangle(mesh.vertices[c[0]], mesh.vertices[c[i]], mesh.vertices[c[i + 1]], p, side);
  }
  return side;
}

}  // namespace lrb
