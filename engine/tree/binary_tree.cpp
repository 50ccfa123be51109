// Top-down construction of a binary tree by the surface area heuristic (Goldsmith and Salmon 1987): ranges
// are split by boxes on the coordinate axes, at the best boundary between bins (Wald 2007). The index of
// every node follows from the number of simplices in each half. Threads therefore build subtrees without
// synchronisation, and the tree does not depend on the number of threads.

#include "engine/tree/binary_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

class LargeRanges {
 public:
  LargeRanges(const BuildInput& in, std::uint32_t count, Workers& workers)
      : in_(in), workers_(workers), boxes_(count), buffer_(count) {
    tree_.nodes.resize(nodes_for(count));
    tree_.order.resize(count);
    for_each_share(count, workers, [&](std::uint32_t begin, std::uint32_t end, std::size_t) {
      for (std::uint32_t s = begin; s < end; ++s) boxes_[s].simplex = s;
    });
    Frame frame;
    const Bounds bounds = measure(0, count, frame);
    split(0, 0, count, frame, bounds);
  }

  BinaryTree take() { return std::move(tree_); }

 private:
  /// Coordinates of boxes: (x - origin) * factor, for x in the tree's units.
  struct Frame {
    double origin[3] = {0, 0, 0}, factor = 1;
    bool closest = false;  ///< a closer one would not help
  };
  using Bounds = std::array<float, 8>;  ///< as FloatBox

  /// Computes the boxes of a range, and returns their union.
  Bounds measure(std::uint32_t begin, std::uint32_t end, const Frame& frame) {
    std::vector<Bounds> bounds(shares_of(end - begin));
    for_each_share(end - begin, workers_, [&](std::uint32_t first, std::uint32_t last, std::size_t share) {
      Bounds all;
      all.fill(std::numeric_limits<float>::infinity());
      for (std::uint32_t k = begin + first; k < begin + last; ++k) {
        FloatBox& box = boxes_[k];
        const VertexId* const v = in_.corners + std::size_t{3} * box.simplex;
        const double* const x[3] = {in_.vertices + std::size_t{3} * v[0],
                                    in_.vertices + std::size_t{3} * v[1],
                                    in_.vertices + std::size_t{3} * v[2]};
        for (std::size_t i = 0; i < 3; ++i) {
          const double low = std::min(x[0][i], std::min(x[1][i], x[2][i])),
                       high = std::max(x[0][i], std::max(x[1][i], x[2][i]));
          box.low[i] = static_cast<float>((low * in_.scale - frame.origin[i]) * frame.factor);
          box.negative_high[i] = -static_cast<float>((high * in_.scale - frame.origin[i]) * frame.factor);
          all[i] = std::min(all[i], box.low[i]);
          all[4 + i] = std::min(all[4 + i], box.negative_high[i]);
        }
        box.unused = 0;
      }
      bounds[share] = all;
    });
    for (const Bounds& more : bounds)
      for (std::size_t i = 0; i < more.size(); ++i) bounds[0][i] = std::min(bounds[0][i], more[i]);
    return bounds[0];
  }

  /// Returns the length of the longest side.
  static double size_of(const Bounds& b) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, -double{b[i]} - double{b[4 + i]});
    return most;
  }
  /// Returns BinaryNode::cost of bounds.
  static double cost_of(const Bounds& b, const Frame& frame) {
    double side[3];
    for (std::size_t i = 0; i < 3; ++i) side[i] = (-double{b[i]} - double{b[4 + i]}) / frame.factor;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0] +
           kLengthCost * (side[0] * side[0] + side[1] * side[1] + side[2] * side[2]);
  }

  /// Returns a frame about the centre of a range, in which its box has a side of about 1. Its vertices are
  /// compared in double, because floats may not tell them apart.
  Frame closer_frame(std::uint32_t begin, std::uint32_t end) const {
    Frame frame;
    frame.closest = true;
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double low = kInfinity, high = -kInfinity;
      for (std::uint32_t k = begin; k < end; ++k)
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const VertexId v = in_.corners[std::size_t{3} * boxes_[k].simplex + corner];
          const double x = in_.vertices[std::size_t{3} * v + i] * in_.scale;
          low = std::min(low, x);
          high = std::max(high, x);
        }
      frame.origin[i] = 0.5 * (low + high);
      size = std::max(size, high - low);
    }
    // All in one place, or nearly: any splits are right.
    constexpr double kLeast = 0x1p-500;
    if (size > kLeast) {
      int exponent = 0;
      std::frexp(size, &exponent);
      frame.factor = std::ldexp(1.0, -exponent);
      frame.closest = false;
    }
    return frame;
  }

  void split(std::uint32_t self, std::uint32_t begin, std::uint32_t end, Frame frame, Bounds bounds) {
    const std::uint32_t n = end - begin;
    BinaryNode& node = tree_.nodes[self];
    node = {begin, end};
    if (n <= kSmallRange) {
      bounds.fill(std::numeric_limits<float>::infinity());
      for (std::uint32_t k = begin; k < end; ++k) {
        tree_.order[k] = boxes_[k].simplex;
        for (std::size_t i = 0; i < 3; ++i) {
          bounds[i] = std::min(bounds[i], boxes_[k].low[i]);
          bounds[4 + i] = std::min(bounds[4 + i], boxes_[k].negative_high[i]);
        }
      }
      node.cost = cost_of(bounds, frame);
      return;
    }
    // The range has become small compared with the one for which boxes were computed.
    if (size_of(bounds) < kSmallSide && !frame.closest) {
      frame = closer_frame(begin, end);
      bounds = measure(begin, end, frame);
    }
    SplitKernel k;
    k.boxes = boxes_.data() + begin;
    k.buffer = buffer_.data() + begin;
    k.count = n;
    std::ranges::copy(bounds, k.bounds);
    run_split_kernel(k);
    part(k);
    node.cost = k.cost / (frame.factor * frame.factor);
    // Preorder: the left subtree follows its parent, and its size follows from the number of its leaves.
    node.left = self + 1;
    node.right = node.left + nodes_for(k.left);
    const std::uint32_t boundary = begin + k.left;
    const auto left = [&] { split(node.left, begin, boundary, frame, std::to_array(k.halves[0])); };
    const auto right = [&] { split(node.right, boundary, end, frame, std::to_array(k.halves[1])); };
    if (n > kShare) return workers_.both(left, right);
    left();
    right();
  }

  /// Completes the partition of a range: divides the bin with the boundary by the order of the centres, then
  /// by number.
  static void part(const SplitKernel& k) {
    const std::uint32_t inside = k.count - k.before - k.after, rank = k.left - k.before;
    const auto place = [&](const FloatBox& box) {
      return std::pair(box.low[k.axis] - box.negative_high[k.axis], box.simplex);
    };
    const std::span<const FloatBox> undecided(k.buffer + k.count - inside, inside);
    std::vector<std::pair<float, std::uint32_t>> places(inside);
    std::ranges::transform(undecided, places.begin(), place);
    std::nth_element(places.begin(), places.begin() + rank, places.end());
    std::uint32_t left = k.before, right = k.left + k.after;
    std::copy_n(k.buffer, k.after, k.boxes + k.left);
    // Backwards, which is their order in the range.
    for (std::uint32_t i = inside; i-- > 0;)
      k.boxes[place(undecided[i]) < places[rank] ? left++ : right++] = undecided[i];
  }

  const BuildInput& in_;
  Workers& workers_;
  std::vector<FloatBox> boxes_, buffer_;
  BinaryTree tree_;
};

}  // namespace

BinaryTree split_large_ranges(const BuildInput& in, std::uint32_t count, Workers& workers) {
  return LargeRanges(in, count, workers).take();
}

// Collapses a binary tree to a wide one by dynamic programming (Ylitie, Karras and Laine 2017, section 3.1).
// Let cost(n, p) be the minimum cost of the wide nodes in the subtree of n if it may use p child slots of its
// wide parent:
// - p = 1: n becomes a wide node, and its two halves share kTreeWidth slots below it;
// - p > 1: the halves share the p slots, or the subtree uses fewer.
// Each inner node takes at most kTreeWidth^2 / 2 steps.

namespace {

/// Returns the cost of a wide node. The exponent is measured (docs/measurements.md).
double wide_cost(const BinaryNode& n) {
  return n.cost * std::sqrt(n.cost) + kSimplexCost * (n.end - n.begin);
}

}  // namespace

Collapse::Collapse(std::span<const BinaryNode> tree) : tree_(tree), best_(tree.size()) {
  // Children come after parents: reverse order is bottom-up. Leaves keep cost 0.
  for (std::size_t node = tree.size(); node-- > 0;) {
    if (tree[node].is_leaf()) continue;
    Best& best = best_[node];
    const Best &left = best_[tree[node].left], &right = best_[tree[node].right];
    for (std::uint32_t places = 2; places <= kTreeWidth; ++places) {
      // The best distribution of the slots over both halves; ties: fewest slots on the left.
      std::uint32_t to_left = 1;
      const auto cost = [&](std::uint32_t k) { return left.cost[k - 1] + right.cost[places - k - 1]; };
      for (std::uint32_t k = 2; k < places; ++k)
        if (cost(k) < cost(to_left)) to_left = k;
      best.to_left[places - 1] = static_cast<std::uint8_t>(to_left);
      best.cost[places - 1] = cost(to_left);
    }
    // One slot: the node itself becomes wide, and its halves share all of its slots.
    best.cost[0] = wide_cost(tree[node]) + best.cost[kTreeWidth - 1];
    // More slots never cost more, because a subtree may leave some unused.
    for (std::uint32_t places = 2; places <= kTreeWidth; ++places)
      best.cost[places - 1] = std::min(best.cost[places - 1], best.cost[places - 2]);
  }
}

std::vector<std::uint32_t> Collapse::children(std::uint32_t node) const {
  std::vector<std::uint32_t> children;
  share(node, kTreeWidth, children);
  return children;
}

/// Distributes slots among the children of a node that does not become a wide one itself.
void Collapse::share(std::uint32_t node, std::uint32_t places, std::vector<std::uint32_t>& children) const {
  const std::uint32_t to_left = best_[node].to_left[places - 1];
  const auto give = [&](std::uint32_t child, std::uint32_t given) {
    const auto& cost = best_[child].cost;
    // Equal cost with fewer slots: release the rest. share() must not follow a distribution that was not
    // chosen.
    while (given > 1 && cost[given - 1] == cost[given - 2]) --given;
    // One slot left: the child is a wide node (or a leaf). More: its own children take its slots.
    given == 1 ? children.push_back(child) : share(child, given, children);
  };
  give(tree_[node].left, to_left);
  give(tree_[node].right, places - to_left);
}

}  // namespace lrb
