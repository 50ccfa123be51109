// Top-down construction of a binary tree by the surface area heuristic (Goldsmith and Salmon 1987).
// 1. Split large ranges by boxes on the coordinate axes: at the best boundary between bins (Wald 2007) or, on
//    request, at the best of all cuts.
// 2. Split small ranges by the cost of the tight boxes of their halves (FittedCuts).
// 3. Compute all boxes on the coordinate axes in one pass from the leaves upwards.
// The index of every node follows from the number of simplices in each half. Threads therefore build subtrees
// without synchronisation, and the tree does not depend on the number of threads.

#include "engine/tree/binary_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include <lrbscope/obb_tree.hpp>

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;

class BinaryBuilder {
 public:
  BinaryBuilder(Soup& soup, Workers& workers, Splits splits)
      : soup_(soup), workers_(workers), splits_(splits) {
    const auto n = static_cast<std::uint32_t>(soup.order.size());
    nodes_.resize(nodes_for(n));
    build(0, 0, n);
  }

  std::vector<BinaryNode> take() { return std::move(nodes_); }

 private:
  /// Returns the number of nodes of a subtree with this many simplices.
  static std::uint32_t nodes_for(std::uint32_t simplices) { return 2 * leaves_for(simplices) - 1; }

  /// Returns true if ranges of this size are split by the tight boxes of their halves.
  bool is_fitted(std::uint32_t simplices) const { return simplices <= std::max(splits_.fitted, kTreeWidth); }

  /// Builds a subtree.
  void build(std::uint32_t self, std::uint32_t begin, std::uint32_t end) {
    // FittedCuts keeps the simplices sorted along all axes, so it handles the entire subtree.
    if (is_fitted(end - begin)) {
      FittedCuts cuts(soup_, soup_.listed(begin, end), splits_.effort);
      build_fitted(self, begin, end, cuts.whole_cost(), cuts, begin);
      std::ranges::copy(cuts.order(), soup_.order.begin() + begin);
      // Children come after parents, so reverse order visits children first.
      for (std::uint32_t i = self + nodes_for(end - begin); i-- > self;) {
        BinaryNode& node = nodes_[i];
        if (!node.is_leaf()) {
          join(node);
          continue;
        }
        for (std::uint32_t k = node.begin; k < node.end; ++k) {
          node.box.extend(soup_.box[soup_.order[k]]);
          node.spread += cuts.spread(k - begin);
        }
      }
      return;
    }
    // A large range: reorder the simplices around the cut, then build both halves, possibly in parallel.
    const std::uint32_t boundary = split(begin, end);
    const auto [left, right] = fork(self, begin, boundary, end, 0);
    workers_.both([&, left = left] { build(left, begin, boundary); },
                  [&, right = right] { build(right, boundary, end); });
    join(nodes_[self]);
    nodes_[self].cost = box_cost(nodes_[self].box);
  }

  /// Builds a part of the subtree that `cuts` divides. cost: of its root; first: begin of the range of
  /// `cuts`.
  void build_fitted(std::uint32_t self, std::uint32_t begin, std::uint32_t end, double cost, FittedCuts& cuts,
                    std::uint32_t first) {
    if (end - begin <= kTreeWidth) {
      nodes_[self] = {begin, end, kNull, kNull, {}, {}, cost};
      return;
    }
    // The halves' costs were computed to choose the cut, and are stored in the children.
    const FittedCuts::Halves halves = cuts.cut(begin - first, end - first);
    const std::uint32_t boundary = first + halves.boundary;
    const auto [left, right] = fork(self, begin, boundary, end, cost);
    build_fitted(left, begin, boundary, halves.left_cost, cuts, first);
    build_fitted(right, boundary, end, halves.right_cost, cuts, first);
  }

  /// Creates an inner node. Its subtrees contain the simplices before `boundary` and the rest. cost: 0 if
  /// build() is to compute it. Returns the roots of the subtrees.
  std::pair<std::uint32_t, std::uint32_t> fork(std::uint32_t self, std::uint32_t begin,
                                               std::uint32_t boundary, std::uint32_t end, double cost) {
    // Preorder: the left subtree follows its parent, and its size follows from the number of its leaves.
    const std::uint32_t left = self + 1, right = left + nodes_for(boundary - begin);
    nodes_[self] = {begin, end, left, right, {}, {}, cost};
    return {left, right};
  }

  /// Computes the box and the moments of a node from those of its children.
  void join(BinaryNode& node) {
    node.box = nodes_[node.left].box.merged(nodes_[node.right].box);
    node.spread = nodes_[node.left].spread;
    node.spread += nodes_[node.right].spread;
  }

  /// A split of a range: number of simplices on the left, in the order of their centres on an axis.
  struct Split {
    double cost = kInfinity;
    int axis = 0;
    std::uint32_t left = 0;
  };

  std::uint32_t split(std::uint32_t begin, std::uint32_t end) {
    // `near`: simplices that are neighbours in the order on the axis, among them the first one on the right,
    // which has `rank` of them before it.
    std::vector<std::uint32_t> near;
    std::uint32_t rank = 0;
    Split best;
    if (splits_.all_cuts) {
      best = best_of_all(begin, end);
      near.assign(soup_.order.begin() + begin, soup_.order.begin() + end);
      rank = best.left;
    } else {
      best = best_binned(begin, end, near, rank);
    }
    // A stable partition in linear time. The simplices of each half stay in the order of the mesh, in which
    // neighbours mostly are neighbours in memory.
    const auto before = soup_.order_on(best.axis);
    std::nth_element(near.begin(), near.begin() + rank, near.end(), before);
    std::stable_partition(soup_.order.begin() + begin, soup_.order.begin() + end,
                          [&](std::uint32_t s) { return before(s, near[rank]); });
    return begin + best.left;
  }

  static int bin_of(const BoxBins& bins, int axis, double centre) {
    return std::min(kBins - 1, static_cast<int>((centre - bins.from[axis]) * bins.per_unit[axis]));
  }

  /// Returns the best split between two bins, and the simplices of the bin where it is, with the number of
  /// those on the left.
  Split best_binned(std::uint32_t begin, std::uint32_t end, std::vector<std::uint32_t>& near,
                    std::uint32_t& rank) {
    const std::uint32_t n = end - begin;
    // Bins divide the range of centres, not of boxes, so that every bin is on one side of each cut.
    std::vector<GrowingBox<double>> centres(shares_of(n));
    for_each_share(n, workers_, [&](std::uint32_t first, std::uint32_t last, std::size_t share) {
      GrowingBox<double> some;
      for (const std::uint32_t s : soup_.listed(begin + first, begin + last))
        some.extend(four<double>(soup_.centre(s)));
      centres[share] = some;
    });
    for (const GrowingBox<double>& some : centres) centres[0].extend(some);
    BoxBins empty;
    for (int axis = 0; axis < 3; ++axis) {
      empty.from[axis] = centres[0].low[axis];
      empty.per_unit[axis] = kBins / (centres[0].high[axis] - centres[0].low[axis]);
      // The centres (nearly) coincide on this axis: no cut across it.
      if (!std::isfinite(empty.per_unit[axis])) empty.per_unit[axis] = 0;
    }
    // Pass 1: the box and number of simplices of each bin, on all axes.
    std::vector<BoxBins> filled(shares_of(n), empty);
    for_each_share(n, workers_, [&](std::uint32_t first, std::uint32_t last, std::size_t share) {
      BoxKernel k;
      k.which = soup_.order.data() + begin + first;
      k.count = last - first;
      k.bins = &filled[share];
      k.boxes = soup_.box.data()->min().data();
      run_box_kernel(k);
    });
    BoxBins& bins = filled[0];
    for (const BoxBins& more : std::span(filled).subspan(1))
      for (int axis = 0; axis < 3; ++axis)
        for (int b = 0; b < kBins; ++b) add_to(bins.bin[axis][b], more.bin[axis][b]);
    Split best;
    for (int axis = 0; axis < 3; ++axis)
      if (bins.per_unit[axis] > 0) try_axis(bins.bin[axis], n, axis, best);
    // Round the cut to a multiple of kTreeWidth, so that all leaves except the last are full. Keep both
    // halves nonempty.
    if (best.left == 0) best.left = n / 2;  // all centres coincide: any half is valid
    best.left = (best.left + kTreeWidth / 2) / kTreeWidth * kTreeWidth;
    best.left = std::clamp(best.left, kTreeWidth, (n - 1) / kTreeWidth * kTreeWidth);
    int at = 0;
    for (rank = best.left; rank >= bins.bin[best.axis][at].count; ++at) rank -= bins.bin[best.axis][at].count;
    for (const std::uint32_t s : soup_.listed(begin, end))
      if (bin_of(bins, best.axis, soup_.centre(s)[best.axis]) == at) near.push_back(s);
    return best;
  }

  Split best_of_all(std::uint32_t begin, std::uint32_t end) const {
    std::vector<std::uint32_t> order(soup_.order.begin() + begin, soup_.order.begin() + end);
    const auto n = static_cast<std::uint32_t>(order.size());
    std::vector<double> right_cost(n);
    Split best;
    best.left = kTreeWidth;
    for (int axis = 0; axis < 3; ++axis) {
      // Sweep from the right and record the costs of all right halves; then sweep from the left and add.
      std::sort(order.begin(), order.end(), soup_.order_on(axis));
      Box right, left;
      for (std::uint32_t i = n; i-- > 0;) {
        right.extend(soup_.box[order[i]]);
        right_cost[i] = box_cost(right) * leaves_for(n - i);
      }
      for (std::uint32_t i = 1; i < n; ++i) {
        left.extend(soup_.box[order[i - 1]]);
        if (i % kTreeWidth != 0) continue;
        const double cost = box_cost(left) * leaves_for(i) + right_cost[i];
        // Ties: the most balanced cut, so that coincident simplices are halved instead of peeled off.
        if (cost < best.cost || (cost == best.cost && larger_side(i, n) < larger_side(best.left, n)))
          best = {cost, axis, i};
      }
    }
    return best;
  }

  static void add_to(Bin& bin, const Bin& more) {
    for (int i = 0; i < 4; ++i) {
      bin.low_and[i] = std::min(bin.low_and[i], more.low_and[i]);
      bin.and_high[i] = std::max(bin.and_high[i], more.and_high[i]);
    }
    bin.count += more.count;
  }

  /// Replaces `best` if a cut between two bins of an axis costs less.
  static void try_axis(const Bin (&bins)[kBins], std::uint32_t count, int axis, Split& best) {
    // Pass 2, from the right: the cost of everything right of each boundary.
    std::array<double, kBins> right_cost{};
    const auto cost_of = [](const Bin& part) {
      return box_cost(Eigen::Vector3d(part.and_high[1] - part.low_and[0], part.and_high[2] - part.low_and[1],
                                      part.and_high[3] - part.low_and[2])) *
             leaves_for(part.count);
    };
    Bin right, left;
    for (int b = kBins - 1; b > 0; --b) {
      add_to(right, bins[b]);
      right_cost[b] = right.count ? cost_of(right) : 0;
    }
    // Pass 3, from the left: the cost of each cut, as box cost times number of leaves.
    for (int b = 1; b < kBins; ++b) {
      add_to(left, bins[b - 1]);
      if (left.count == 0 || left.count == count) continue;
      const double cost = cost_of(left) + right_cost[b];
      if (cost < best.cost) best = {cost, axis, left.count};
    }
  }

  Soup& soup_;
  Workers& workers_;
  const Splits splits_;
  std::vector<BinaryNode> nodes_;
};

}  // namespace

std::vector<BinaryNode> build_binary_tree(Soup& soup, Workers& workers, Splits splits) {
  return BinaryBuilder(soup, workers, splits).take();
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
