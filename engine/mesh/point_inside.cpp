// Point location by ray parity. The exact ray predicate resolves degenerate hits by Simulation of Simplicity
// (Edelsbrunner and Muecke 1990), so each face is either crossed or not.
#include "engine/mesh/point_inside.hpp"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>

#include "engine/exact/locate.hpp"

namespace lrb {
namespace {

/// Calls visit(hit) for each triangle of the face's fan (2D: for the segment) until it returns false. Returns
/// false if it did.
template <class Visit>
bool cast_at_face(const Mesh& mesh, FaceId f, const Eigen::Vector3d& p, Visit visit) {
  const auto corners = mesh.face(f);
  const auto point = [&](std::size_t i) { return mesh.vertices[corners[i]].data(); };
  if (mesh.dim == 2) {
    const double* const segment[2] = {point(0), point(1)};
    return visit(exact::ray_crosses_2d(p.data(), segment));
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const double* const triangle[3] = {point(0), point(i), point(i + 1)};
    if (!visit(exact::ray_crosses(p.data(), triangle))) return false;
  }
  return true;
}

}  // namespace

PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p) {
  // Every crossing toggles the side. A point on the surface itself ends the count.
  bool inside = false;
  const auto count = [&](exact::RayHit hit) {
    inside ^= hit == exact::RayHit::crosses;
    return hit != exact::RayHit::on_face;
  };
  for (const FaceId f : faces)
    if (!cast_at_face(mesh, f, p, count)) return PointSide::on_surface;
  return inside ? PointSide::inside : PointSide::outside;
}

SideFinder::SideFinder(const Mesh& mesh, std::vector<std::uint32_t> surface_of_face)
    : mesh_(mesh), surface_of_face_(std::move(surface_of_face)), boxes_(mesh.face_count()) {
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    if (surface_of_face_[f] == kNull) continue;
    for (const VertexId v : mesh.face(f)) boxes_[f].extend(mesh.vertices[v]);
    order_.push_back(f);
  }
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

/// Builds a subtree in preorder, by median splits of the boxes' centres. Returns its index.
std::uint32_t SideFinder::build(std::uint32_t first, std::uint32_t last) {
  constexpr std::uint32_t kLeafSize = 4;
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, first, last, 0});
  for (std::uint32_t i = first; i < last; ++i) nodes_[index].box.extend(boxes_[order_[i]]);
  if (last - first <= kLeafSize) return index;
  // Median split along the longest extent. Halved coordinates cannot overflow.
  const Eigen::AlignedBox3d& box = nodes_[index].box;
  int axis = 0;
  (box.max() / 2 - box.min() / 2).maxCoeff(&axis);
  const std::uint32_t median = first + (last - first) / 2;
  const auto centre = [&](FaceId f) { return boxes_[f].min()[axis] / 2 + boxes_[f].max()[axis] / 2; };
  const auto at = [&](std::uint32_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(median), at(last),
                   [&](FaceId f, FaceId g) { return centre(f) < centre(g); });
  build(first, median);
  const std::uint32_t right = build(median, last);
  nodes_[index].right = right;
  return index;
}

std::vector<SideFinder::Side> SideFinder::sides(const Eigen::Vector3d& p) const {
  // The ray runs to +x. Its origin is perturbed infinitesimally from p, which closed boxes account for.
  const auto is_on_ray = [&](const Eigen::AlignedBox3d& box) {
    return box.max().x() >= p.x() && box.min().y() <= p.y() && p.y() <= box.max().y() &&
           (mesh_.dim == 2 || (box.min().z() <= p.z() && p.z() <= box.max().z()));
  };
  // One parity for each surface with a box on the ray. on_surface is final.
  std::map<std::uint32_t, PointSide> found;
  const auto cast = [&](FaceId f) {
    PointSide& side = found.try_emplace(surface_of_face_[f], PointSide::outside).first->second;
    cast_at_face(mesh_, f, p, [&](exact::RayHit hit) {
      if (hit == exact::RayHit::on_face) side = PointSide::on_surface;
      if (side == PointSide::on_surface) return false;
      if (hit == exact::RayHit::crosses)
        side = side == PointSide::inside ? PointSide::outside : PointSide::inside;
      return true;
    });
  };
  // Traverse only nodes on the ray: O(log n + hits) for usual meshes.
  std::vector<std::uint32_t> stack;
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const std::uint32_t n = stack.back();
    const Node& node = nodes_[n];
    stack.pop_back();
    if (!is_on_ray(node.box)) continue;
    if (node.right != 0) {
      stack.push_back(node.right);
      stack.push_back(n + 1);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.last; ++i)
      if (is_on_ray(boxes_[order_[i]])) cast(order_[i]);
  }
  // Return only surfaces that the point is in or on. The map lists them in ascending order.
  std::vector<Side> out;
  for (const auto& [surface, side] : found)
    if (side != PointSide::outside) out.push_back({surface, side});
  return out;
}

}  // namespace lrb
