#include "engine/mesh/triangle_tree.hpp"

#include <algorithm>

namespace lrb {

TriangleTree::TriangleTree(const Mesh& mesh, const UnitCube& cube, std::vector<Triangle> triangles,
                           std::uint32_t leaf_size)
    : triangles_(std::move(triangles)) {
  build(mesh, cube, 0, static_cast<std::uint32_t>(triangles_.size()), leaf_size);
}

/// Parents before children, left before right.
std::uint32_t TriangleTree::build(const Mesh& mesh, const UnitCube& cube, std::uint32_t first,
                                  std::uint32_t last, std::uint32_t leaf_size) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  // Fit an oriented box to the corners of all triangles below the node.
  std::vector<Eigen::Vector3d> points;
  for (std::uint32_t i = first; i < last; ++i)
    for (const VertexId v : triangles_[i]) points.push_back(cube(mesh.vertices[v]));
  nodes_.push_back({OrientedBox::about(points), first, last, 0});
  if (last - first <= leaf_size) return index;
  // Halve it along its own longest axis.
  int axis = 0;
  nodes_[index].box.half.maxCoeff(&axis);
  const Eigen::Vector3d along = nodes_[index].box.axes.row(axis);
  // Three times the centroid's coordinate along that axis.
  const auto place = [&](const Triangle& t) {
    return along.dot(cube(mesh.vertices[t[0]]) + cube(mesh.vertices[t[1]]) + cube(mesh.vertices[t[2]]));
  };
  const std::uint32_t middle = first + (last - first) / 2;
  const auto at = [&](std::uint32_t i) { return triangles_.begin() + static_cast<std::ptrdiff_t>(i); };
  // Median split: the tree is balanced.
  std::nth_element(at(first), at(middle), at(last),
                   [&](const Triangle& s, const Triangle& t) { return place(s) < place(t); });
  build(mesh, cube, first, middle, leaf_size);
  const std::uint32_t right = build(mesh, cube, middle, last, leaf_size);
  nodes_[index].right = right;
  return index;
}

}  // namespace lrb
