#pragma once
/// Trees of any kind of volume over a mesh, in the form of a capture.

#include <algorithm>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::test {

/// The directions of 18-DOPs.
inline const std::vector<Eigen::Vector3d>& directions_of_18() {
  static const std::vector<Eigen::Vector3d> d = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1},  {1, 1, 0}, {1, 0, 1},
                                                 {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}};
  return d;
}

/// Returns the numbers of a volume that contains the points. OBBs and RSS have the frame `axes`.
inline std::vector<double> volume_around(capture::VolumeKind kind, const std::vector<Eigen::Vector3d>& points,
                                         const Eigen::Matrix3d& axes) {
  using capture::VolumeKind;
  using Eigen::Vector3d;
  Eigen::AlignedBox3d box, turned;
  for (const Vector3d& p : points) box.extend(p), turned.extend(axes.transpose() * p);
  std::vector<double> out;
  const auto append = [&](const Vector3d& v) { out.insert(out.end(), v.data(), v.data() + 3); };
  const Vector3d half = turned.sizes() / 2;
  switch (kind) {
    case VolumeKind::aabb:
      append(box.min());
      append(box.max());
      break;
    case VolumeKind::sphere: {
      double radius = 0;
      for (const Vector3d& p : points) radius = std::max(radius, (p - box.center()).norm());
      append(box.center());
      out.push_back(radius);
      break;
    }
    case VolumeKind::obb:
      append(axes * turned.center());
      for (int k = 0; k < 3; ++k) append(half[k] * axes.col(k));
      break;
    case VolumeKind::rss: {
      append(axes * Vector3d(turned.min().x(), turned.min().y(), turned.center().z()));
      append(2 * half.x() * axes.col(0));
      append(2 * half.y() * axes.col(1));
      out.push_back(half.z());
      break;
    }
    case VolumeKind::kdop:
      for (const Vector3d& d : directions_of_18()) {
        double least = d.dot(points[0]), greatest = least;
        for (const Vector3d& p : points)
          least = std::min(least, d.dot(p)), greatest = std::max(greatest, d.dot(p));
        out.push_back(least);
        out.push_back(greatest);
      }
      break;
  }
  return out;
}

/// Returns a tree over the triangles of a mesh, with nodes numbered breadth first. `split` returns the parts
/// of a node's triangles, which are its children, or none for a leaf. OBBs and RSS have a random frame each.
template <class Split>
capture::Tree tree_of(const capture::Mesh& mesh, capture::VolumeKind kind, Split split) {
  capture::Tree tree;
  tree.volume = kind;
  if (kind == capture::VolumeKind::kdop) tree.directions = directions_of_18();
  tree.first_child = tree.first_triangle = {0};
  shapes::RandomEngine random(1);
  std::vector<std::vector<std::uint32_t>> nodes(1, std::vector<std::uint32_t>(mesh.triangles.size()));
  std::iota(nodes[0].begin(), nodes[0].end(), 0U);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    std::vector<std::uint32_t> all = std::move(nodes[n]);
    std::vector<Eigen::Vector3d> points;
    for (const std::uint32_t t : all)
      for (const std::uint32_t v : mesh.triangles[t]) points.push_back(mesh.vertices[v]);
    const std::vector<double> numbers = volume_around(kind, points, shapes::random_rotation(random));
    tree.volumes.insert(tree.volumes.end(), numbers.begin(), numbers.end());
    std::vector<std::vector<std::uint32_t>> parts = split(all);
    if (parts.empty()) tree.triangle.insert(tree.triangle.end(), all.begin(), all.end());
    for (std::vector<std::uint32_t>& part : parts) {
      tree.child.push_back(static_cast<std::uint32_t>(nodes.size()));
      nodes.push_back(std::move(part));
    }
    tree.first_child.push_back(static_cast<std::uint32_t>(tree.child.size()));
    tree.first_triangle.push_back(static_cast<std::uint32_t>(tree.triangle.size()));
  }
  return tree;
}

/// Returns a tree that halves the triangles along their longest extent down to leaves of `leaf_size`.
inline capture::Tree halving_tree(const capture::Mesh& mesh, capture::VolumeKind kind,
                                  std::size_t leaf_size = 1) {
  const auto centre = [&](std::uint32_t t) {
    const auto& c = mesh.triangles[t];
    return Eigen::Vector3d((mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3);
  };
  return tree_of(mesh, kind, [&](std::vector<std::uint32_t>& all) {
    std::vector<std::vector<std::uint32_t>> halves;
    if (all.size() <= leaf_size) return halves;
    Eigen::AlignedBox3d centres;
    for (const std::uint32_t t : all) centres.extend(centre(t));
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const auto median = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), median, all.end(), [&](std::uint32_t s, std::uint32_t t) {
      const double x = centre(s)[axis], y = centre(t)[axis];
      return x != y ? x < y : s < t;
    });
    halves.emplace_back(all.begin(), median);
    halves.emplace_back(median, all.end());
    return halves;
  });
}

}  // namespace lrb::test
