#include "engine/construct/surface_walk.hpp"

#include <Eigen/Geometry>

namespace lrb::construct {

SurfaceWalk::SurfaceWalk(const FrontMesh& front, const AabbTree& tree, double unit)
    : slots_(tree.items().begin(), tree.items().end()), scale_(1 / unit) {
  Eigen::AlignedBox3d box;
  for (FrontMesh::Corner v = 0; v < front.point_count(); ++v) box.extend(front.x(v));
  centre_ = box.min() / 2 + box.max() / 2;
  triangles_.resize(front.slot_count());
  for (Slot s = 0; s < front.slot_count(); ++s) {
    const FrontMesh::Triangle& t = front[s];
    const Point a = local(front.x(t.v[0]));
    triangles_[s] = {a, local(front.x(t.v[1])) - a, local(front.x(t.v[2])) - a, t.v, t.across};
  }
  // Grown by more than the rounding of coordinates, which are at most 2.
  const Point rounding = Point::Constant(0x1p-20f);
  nodes_.reserve(tree.nodes().size());
  for (const AabbTree::Node& n : tree.nodes())
    nodes_.push_back(
        {local(n.box.min()) - rounding, local(n.box.max()) + rounding, n.first, n.last, n.right});
}

float SurfaceWalk::walk(const Point& p, Slot& hint, float enough) const {
  auto best = nearest(triangles_[hint], p);
  while (best.distance_sq > enough && best.part != TrianglePart::inside) {
    const Slot from = hint;
    const float before = best.distance_sq;
    const auto look_at = [&](Slot s) {
      const auto n = nearest(triangles_[s], p);
      if (n.distance_sq < best.distance_sq) best = n, hint = s;
    };
    if (best.part < TrianglePart::corner_a) {
      // Over the edge that is nearest.
      look_at(triangles_[from].across[static_cast<int>(best.part) - 1]);
    } else {
      // Around the corner that is nearest.
      constexpr int kMaxTurns = 40;
      const std::uint32_t corner = triangles_[from].v[static_cast<int>(best.part) - 4];
      Slot s = from;
      for (int turn = 0; turn < kMaxTurns && best.distance_sq > enough; ++turn) {
        const Triangle& t = triangles_[s];
        const int i = t.v[0] == corner ? 0 : t.v[1] == corner ? 1 : 2;
        s = t.across[(i + 2) % 3];
        if (s == from) break;
        look_at(s);
      }
    }
    // Stop at a local minimum; less progress than this is rounding.
    constexpr float kMinProgress = 1e-6f;
    if (!(best.distance_sq < before * (1 - kMinProgress))) break;
  }
  return best.distance_sq;
}

bool SurfaceWalk::find_within(const Point& p, Slot& hint, float enough) const {
  // Depth-first search that ends at the first triangle within the distance.
  std::uint32_t stack[AabbTree::kMaxDepth];
  int top = 0;
  if (!nodes_.empty()) stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t n = stack[--top];
    const Node& node = nodes_[n];
    const Point offset = (node.low - p).cwiseMax(p - node.high).cwiseMax(0.0f);
    if (!((offset[0] * offset[0] + offset[1] * offset[1]) + offset[2] * offset[2] <= enough)) continue;
    if (node.right != 0) {
      stack[top++] = node.right;
      stack[top++] = n + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.last; ++i)
      if (nearest(triangles_[slots_[i]], p).distance_sq <= enough) {
        hint = slots_[i];
        return true;
      }
  }
  return false;
}

}  // namespace lrb::construct
