#include "engine/query/node_boxes.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace lrb {

using Eigen::Vector3d;

WorldBox box_of(const ObbTree& tree, std::uint32_t node, int child, const Pose& pose) {
  const TreeNode& n = tree.nodes()[node];
  Vector3d local, half;
  Eigen::Matrix3d frame;
  for (int i = 0; i < 3; ++i) {
    const double low = child == kWhole ? 0 : n.lo[i][child],
                 high = child == kWhole ? kQuantizedMost : n.hi[i][child];
    // Decode the quantized box in the node's frame.
    local[i] = n.base[i] + n.scale[i] * (low + high) / 2;
    half[i] = n.scale[i] * (high - low) / 2;
    for (int j = 0; j < 3; ++j) frame(i, j) = n.frame[i][j];
  }
  WorldBox out;
  const Vector3d origin(n.origin[0], n.origin[1], n.origin[2]);
  out.centre = pose.apply((origin + frame.transpose() * local) * tree.unit());
  // Normals are transformed by the inverse transpose, for poses that scale or shear.
  const double volume = pose.r.determinant();
  const Eigen::Matrix3d normals = volume != 0 ? Eigen::Matrix3d(pose.r.inverse().transpose()) : pose.r;
  for (int i = 0; i < 3; ++i) {
    out.half[i] = pose.r * (frame.row(i).transpose() * (half[i] * tree.unit()));
    out.across[i] = (normals * frame.row(i).transpose()).normalized();
  }
  return out;
}

void compare_boxes(const WorldBox& a, const WorldBox& b, BoxPair& out) {
  out.gap = -std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 6; ++axis) {
    // Separating axis test along the six side normals: centre distance minus both half widths.
    const Vector3d& n = axis < 3 ? a.across[axis] : b.across[axis - 3];
    double gap = std::abs(n.dot(a.centre - b.centre));
    for (int i = 0; i < 3; ++i) gap -= std::abs(n.dot(a.half[i])) + std::abs(n.dot(b.half[i]));
    if (gap > out.gap) out.gap = gap, out.axis = static_cast<BoxAxis>(axis);
  }
}

}  // namespace lrb
