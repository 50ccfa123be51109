#include "engine/query/explain_parts.hpp"

#include <Eigen/Geometry>

#include "engine/mesh/nearest_on_simplex.hpp"
#include "engine/query/collide_impl.hpp"

namespace lrb::explain {

using Eigen::Vector3d;

void begin(QueryContext& ctx, const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  check_query(a, pose_a, b, pose_b);
  ctx[Side::a].begin(a, pose_a, WrapperMode::regularised);
  ctx[Side::b].begin(b, pose_b, WrapperMode::regularised);
}

Stepper::Outcome Stepper::step(const NodePair& pair) {
  // Make this pair the only one on the stack, and stop the kernel after it.
  start_at(k_, pair);
  k_.out_size = k_.parted_nodes_size = 0;
  k_.parted_nodes = parted_nodes_.data();
  k_.most_node_pairs = k_.node_pairs + 1;
  const std::uint64_t before = k_.prefilter_tests;
  run_tree_kernel(k_);
  return {{k_.stack, k_.stack + k_.stack_size},
          {k_.out, k_.out + k_.out_size},
          k_.prefilter_tests - before,
          k_.parted_nodes_size != 0};
}

void NearPoints::see(const Vector3d& of_a, const Vector3d& of_b) {
  const double d = (of_a - of_b).squaredNorm();
  if (d < distance_sq) a = of_a, b = of_b, distance_sq = d;
}

namespace {

/// Considers the closest points of the lines through two segments, if they are on the segments. (Otherwise a
/// corner of one is closest to the other.)
void see_edges(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s, NearPoints& out) {
  // Closest points of two lines (Ericson 2005, section 5.1.8).
  const Vector3d d = q - p, e = s - r, w = p - r;
  const double dd = d.dot(d), ee = e.dot(e), de = d.dot(e), dw = d.dot(w), ew = e.dot(w);
  const double det = dd * ee - de * de;
  // Parallel lines: a corner is among the closest points.
  if (!(det > 0)) return;
  const double x = (de * ew - ee * dw) / det, y = (dd * ew - de * dw) / det;
  if (x >= 0 && x <= 1 && y >= 0 && y <= 1) out.see(p + x * d, r + y * e);
}

}  // namespace

NearPoints nearest_points(int dim, const Corners& a, const Corners& b) {
  NearPoints out;
  const auto on = [dim](const Vector3d& p, const Corners& t) {
    const SimplexPoint n = dim == 3 ? nearest_on_triangle(p, point(t[0]), point(t[1]), point(t[2]))
                                    : nearest_on_segment(p, point(t[0]), point(t[1]));
    Vector3d x = n.weight[0] * point(t[0]) + n.weight[1] * point(t[1]);
    if (dim == 3) x += n.weight[2] * point(t[2]);
    return x;
  };
  // Closest points of disjoint simplices include a corner, or lie on an edge of each.
  for (int i = 0; i < dim; ++i) {
    out.see(point(a[i]), on(point(a[i]), b));
    out.see(on(point(b[i]), a), point(b[i]));
  }
  if (dim == 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        see_edges(point(a[i]), point(a[(i + 1) % 3]), point(b[j]), point(b[(j + 1) % 3]), out);
  return out;
}

}  // namespace lrb::explain
