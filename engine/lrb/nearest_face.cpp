#include "engine/lrb/nearest_face.hpp"

#include <algorithm>
#include <cmath>

namespace lrb {
namespace {

/// Writes the squared distances from p (units) to the boxes of a node's children, in float: only the order of
/// the search and its choice of the nearest simplex depend on them.
void box_distances_sq(const TreeNode& node, const Eigen::Vector3d& p, float out[kTreeWidth]) {
  // The difference is taken in double: close to a small node far from zero, floats would lose all digits.
  const float from_origin[3] = {static_cast<float>(p.x() - node.origin[0]),
                                static_cast<float>(p.y() - node.origin[1]),
                                static_cast<float>(p.z() - node.origin[2])};
  for (std::uint32_t k = 0; k < kTreeWidth; ++k) out[k] = 0;
  for (int i = 0; i < 3; ++i) {
    // Coordinate of p on the node's axis i, from the start of the quantized range.
    const float q = node.frame[i][0] * from_origin[0] + node.frame[i][1] * from_origin[1] +
                    node.frame[i][2] * from_origin[2] - node.base[i];
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      // Distance to the interval [lo, hi] on this axis; 0 inside. Squares add up over the axes.
      const float low = node.scale[i] * static_cast<float>(node.lo[i][k]) - q;
      const float high = q - node.scale[i] * static_cast<float>(node.hi[i][k]);
      const float d = std::max(std::max(low, high), 0.0f);
      out[k] += d * d;
    }
  }
}

/// Writes the children whose distance is below a limit to `order`, nearest first. Returns their number.
std::uint32_t sort_below(const float d[kTreeWidth], std::uint32_t children, double limit_sq,
                         std::uint32_t order[kTreeWidth]) {
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < children; ++k) {
    if (!(static_cast<double>(d[k]) < limit_sq)) continue;
    // Insertion sort: at most kTreeWidth (8) entries.
    std::uint32_t at = count++;
    for (; at > 0 && d[order[at - 1]] > d[k]; --at) order[at] = order[at - 1];
    order[at] = k;
  }
  return count;
}

}  // namespace

std::vector<Eigen::Vector3d> vertices_in_units(const LrbRep& rep) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(rep.vertices().size());
  for (const Eigen::Vector3d& v : rep.vertices()) out.push_back(v / rep.tree().unit());
  return out;
}

SimplexPoint NearestFace::nearest_point(const Eigen::Vector3d& p, SimplexId s) const {
  VertexId v[3];
  rep_.simplex(s, v);
  return rep_.dim() == 3 ? nearest_on_triangle(p, x_[v[0]], x_[v[1]], x_[v[2]])
                         : nearest_on_segment(p, x_[v[0]], x_[v[1]]);
}

double NearestFace::distance(const Eigen::Vector3d& p, SimplexId s) const {
  return std::sqrt(nearest_point(p, s).distance_sq);
}

/// A nearer point can lie beyond a border only where the nearest one so far lies on it: there it crosses.
NearFace NearestFace::walk(const Eigen::Vector3d& p, SimplexId from,
                           const std::vector<Across>& neighbours) const {
  // Greedy descent on the surface. The distance falls at each step, so the walk ends; it can end in a local
  // minimum, which callers allow for.
  const int corners = rep_.dim();
  SimplexPoint nearest = nearest_point(p, from);
  for (bool moves = true; moves;) {
    moves = false;
    const SimplexPoint here = nearest;
    const Across& across = neighbours[from];
    for (int e = 0; e < corners; ++e) {
      // Border e is opposite corner e + 2 (2D: is end e). The closest point lies on it if the weight there is
      // 0.
      const bool on_border = here.weight[corners == 3 ? (e + 2) % 3 : 1 - e] == 0;
      if (!on_border || across[e] == kNull) continue;
      const SimplexPoint there = nearest_point(p, across[e]);
      if (there.distance_sq < nearest.distance_sq) nearest = there, from = across[e], moves = true;
    }
  }
  return {from, std::sqrt(nearest.distance_sq)};
}

/// Goes down to the nearest boxes first. On a stack of its own: a tree from a file may be as high as it
/// likes.
NearFace NearestFace::find(const Eigen::Vector3d& p, NearFace known) {
  // Depth-first branch and bound (Roussopoulos et al. 1995): nearest boxes first, subtrees beyond the best
  // distance pruned.
  const ObbTree& tree = rep_.tree();
  NearFace best = known;
  double best_sq = known.distance * known.distance;
  stack_.clear();
  if (!tree.empty()) stack_.push_back({0, 0});
  while (!stack_.empty()) {
    const Branch branch = stack_.back();
    stack_.pop_back();
    // The best distance may have fallen since the branch was pushed.
    if (!(static_cast<double>(branch.distance_sq) < best_sq)) continue;
    const TreeNode& node = tree.nodes()[branch.node];
    float d[kTreeWidth];
    std::uint32_t order[kTreeWidth];
    box_distances_sq(node, p, d);
    const std::uint32_t count = sort_below(d, node.count, best_sq, order);
    if (node.is_leaf == 0) {
      // Pushed in reverse, so that the nearest child is popped first.
      for (std::uint32_t i = count; i-- > 0;) stack_.push_back({node.first + order[i], d[order[i]]});
      continue;
    }
    // Leaf: distances to the simplices in double. Boxes are sorted, so the first one too far ends the loop.
    for (std::uint32_t i = 0; i < count && static_cast<double>(d[order[i]]) < best_sq; ++i) {
      const SimplexId s = tree.blocks()[node.first].simplex[order[i]];
      const double square = nearest_point(p, s).distance_sq;
      if (square < best_sq) best_sq = square, best.simplex = s;
    }
  }
  if (best.simplex != known.simplex) best.distance = std::sqrt(best_sq);
  return best;
}

}  // namespace lrb
