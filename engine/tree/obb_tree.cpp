// Construction of the 8-wide OBB tree (principal axes: Gottschalk, Lin and Manocha 1996; quantized child
// boxes: Ylitie, Karras and Laine 2017).
// 1. Choose the unit, a power of two, so that coordinates are at most about 1.
// 2. Build a binary tree, and collapse it to eight children per node (binary_tree.hpp).
// 3. Lay out nodes and blocks depth first.
// 4. Fill the nodes independently, in parallel: fit a frame, compute the boxes in it, quantize them outwards.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/binary_tree.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/simplex_view.hpp>

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Splits of trees of bodies. More tries gain nothing, fewer cost 2 % of a query (docs/measurements.md).
constexpr Splits kBodySplits{.fitted = 2048, .effort = {.principal = 1, .tried = 3}, .all_cuts = false};
/// Splits of trees of wrappers, whose faces are few and long: more tries are worthwhile.
constexpr Splits kWrapperSplits{.fitted = 512, .effort = {.principal = 3, .tried = 32}, .all_cuts = true};

}  // namespace

/// Collapses the binary tree to eight children per node and quantizes the boxes. Lays out all nodes first,
/// then fills them independently.
class ObbTreeBuilder {
 public:
  /// Builds an empty tree over the listed simplices.
  static void build(ObbTree& tree, const SimplexView& body, std::span<const SimplexId> simplices,
                    Splits splits, unsigned threads) {
    tree.measure(body, simplices);
    if (simplices.empty()) return;
    Workers workers(threads);
    Soup soup(body, simplices, tree.unit_, workers);
    ObbTreeBuilder(tree, soup, workers, splits);
  }

 private:
  ObbTreeBuilder(ObbTree& tree, Soup& soup, Workers& workers, Splits splits)
      : tree_(tree), soup_(soup), binary_(build_binary_tree(soup, workers, splits)) {
    soup_.follow_order(workers);
    places_.resize(1);
    lay_out(Collapse(binary_), 0, 0, 1);
    tree_.nodes_.resize(places_.size());
    tree_.blocks_.resize(block_count_);
    // Nodes per task: enough simplices to be worth distributing.
    constexpr std::size_t kNodes = 32;
    workers.for_each((tree_.nodes_.size() + kNodes - 1) / kNodes, [&](std::size_t i, unsigned) {
      const std::size_t end = std::min(tree_.nodes_.size(), (i + 1) * kNodes);
      for (std::size_t n = i * kNodes; n < end; ++n) fill(static_cast<std::uint32_t>(n));
    });
  }

  /// Assigns the indices of children and blocks, depth first.
  void lay_out(const Collapse& collapse, std::uint32_t wide, std::uint32_t binary, std::uint32_t height) {
    tree_.height_ = std::max(tree_.height_, height);
    // A leaf: `first` is the number of its block.
    if (binary_[binary].is_leaf()) {
      places_[wide] = {binary, block_count_++, 0};
      return;
    }
    // Children are contiguous: their indices are reserved before those of any subtree.
    const std::vector<std::uint32_t> children = collapse.children(binary);
    const auto first = static_cast<std::uint32_t>(places_.size());
    places_[wide] = {binary, first, static_cast<std::uint32_t>(children.size())};
    places_.resize(first + children.size());
    for (std::uint32_t k = 0; k < children.size(); ++k) lay_out(collapse, first + k, children[k], height + 1);
  }

  void fill(std::uint32_t wide) {
    const BinaryNode& b = binary_[places_[wide].binary];
    TreeNode& node = tree_.nodes_[wide];
    const std::uint32_t first = places_[wide].first,
                        count = b.is_leaf() ? b.end - b.begin : places_[wide].count;
    // The boxes of children are recomputed from the simplices in the node's frame: a box of a box would be
    // looser.
    Frame frame = principal_frame(soup_, soup_.listed(b.begin, b.end), b.spread, b.box);
    std::array<Box, kTreeWidth> boxes;
    Box all;
    for (std::uint32_t k = 0; k < count; ++k) {
      const auto [begin, end] = child_range(b, first, k);
      all.extend(boxes[k] = box_in_frame(soup_, soup_.listed(begin, end), frame));
    }
    // Principal axes are not always best: those of a cube are arbitrary. Otherwise use the coordinate axes.
    if (!(half_area(all) < half_area(b.box))) {
      frame.axes.setIdentity();
      for (std::uint32_t k = 0; k < count; ++k) {
        const Box& box =
            b.is_leaf() ? soup_.box_of(soup_.order[b.begin + k]) : binary_[places_[first + k].binary].box;
        boxes[k] = Box(box.min() - frame.origin, box.max() - frame.origin);
      }
    }
    if (b.is_leaf()) fill_block(tree_.blocks_[first], b, frame);
    // quantize() overwrites the entire node.
    quantize(node, frame, std::span(boxes).first(count));
    node.first = first;
    node.is_leaf = b.is_leaf();
  }

  /// Returns the range of simplices in box `k` of a node.
  std::pair<std::uint32_t, std::uint32_t> child_range(const BinaryNode& node, std::uint32_t first,
                                                      std::uint32_t k) const {
    if (node.is_leaf()) return {node.begin + k, node.begin + k + 1};
    const BinaryNode& child = binary_[places_[first + k].binary];
    return {child.begin, child.end};
  }

  void fill_block(LeafBlock& block, const BinaryNode& b, const Frame& frame) const {
    std::fill(std::begin(block.simplex), std::end(block.simplex), kNull);
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      // Absent simplices repeat the last one, so that all eight lanes contain valid coordinates.
      const std::uint32_t s = soup_.order[std::min(b.begin + k, b.end - 1)];
      for (int corner = 0; corner < 3; ++corner) {
        const Vector3d x = product3(frame.axes, soup_.corner(s, corner) - frame.origin);
        for (int axis = 0; axis < 3; ++axis) block.corner[corner][axis][k] = static_cast<float>(x[axis]);
      }
      if (b.begin + k < b.end) block.simplex[k] = soup_.simplices[s];
    }
  }

  static void quantize(TreeNode& node, const Frame& frame, std::span<const Box> boxes) {
    node = {};
    Box all;
    for (const Box& b : boxes) all.extend(b);
    // Covers the rounding of the projection above, with room for the float arithmetic below.
    const double margin =
        kTreeRounding * (all.min().cwiseAbs().cwiseMax(all.max().cwiseAbs()).maxCoeff()) + kTreeRoundingUnits;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) node.frame[i][j] = static_cast<float>(frame.axes(i, j));
      node.origin[i] = frame.origin[i];
      // The range is widened by twice the margin: boxes are enlarged by one margin, and the codes must still
      // cover them.
      const double lo = all.min()[i] - 2 * margin, hi = all.max()[i] + 2 * margin;
      node.base[i] = std::nextafter(static_cast<float>(lo), -INFINITY);
      node.scale[i] = std::nextafter(static_cast<float>((hi - node.base[i]) / kQuantizedMost), INFINITY);
      const double per_unit = 1 / static_cast<double>(node.scale[i]);
      for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
        // Absent children have lo > hi.
        node.lo[i][k] =
            k < boxes.size() ? quantize_down(node, i, per_unit, boxes[k].min()[i] - margin) : kQuantizedMost;
        node.hi[i][k] = k < boxes.size() ? quantize_up(node, i, per_unit, boxes[k].max()[i] + margin) : 0;
      }
    }
    node.count = static_cast<std::uint8_t>(boxes.size());
    // The origin is 0 in this frame, so the farthest corner of the common box bounds the radius.
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner)
      farthest = std::max(farthest, norm3(all.corner(static_cast<Box::CornerType>(corner))));
    node.radius = std::nextafter(static_cast<float>(farthest + 2 * margin), INFINITY);
  }

  static float decode(const TreeNode& node, int axis, int q) {
    return node.base[axis] + node.scale[axis] * static_cast<float>(q);
  }
  static std::uint8_t quantize_down(const TreeNode& node, int axis, double per_unit, double x) {
    // Start one code too high and step down until the decoded value is at or below x. The float decoding
    // itself decides, so its rounding need not be estimated.
    int q = std::clamp(static_cast<int>((x - node.base[axis]) * per_unit) + 1, 0, kQuantizedMost);
    while (q > 0 && decode(node, axis, q) > x) --q;
    return static_cast<std::uint8_t>(q);
  }
  static std::uint8_t quantize_up(const TreeNode& node, int axis, double per_unit, double x) {
    // The mirror image: the decoded value is at or above x.
    int q = std::clamp(static_cast<int>((x - node.base[axis]) * per_unit) - 1, 0, kQuantizedMost);
    while (q < kQuantizedMost && decode(node, axis, q) < x) ++q;
    return static_cast<std::uint8_t>(q);
  }

  ObbTree& tree_;
  Soup& soup_;
  const std::vector<BinaryNode> binary_;
  /// Where a wide node is.
  struct Place {
    std::uint32_t binary;        ///< the same node of the binary tree
    std::uint32_t first, count;  ///< as in TreeNode; a leaf's count is 0 here
  };
  std::vector<Place> places_;  ///< (|nodes|)
  std::uint32_t block_count_ = 0;
};

void ObbTree::measure(const SimplexView& body, std::span<const SimplexId> simplices) {
  for (const SimplexId s : simplices) {
    VertexId v[3];
    body.simplex(s, v);
    for (int k = 0; k < body.dim; ++k) extent_ = std::max(extent_, body.vertices[v[k]].cwiseAbs().maxCoeff());
  }
  if (simplices.empty()) return;
  // The smallest power of two above the extent, clamped to the range of normal doubles.
  int exponent = 0;
  std::frexp(extent_, &exponent);
  unit_ = std::ldexp(1.0, std::clamp(exponent, -1022, 1023));
}

ObbTree::ObbTree(const SimplexView& body, unsigned threads) {
  ObbTreeBuilder::build(*this, body, body.real_simplices(), kBodySplits, threads);
}

ObbTree::ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, unsigned threads) {
  constexpr std::size_t kFew = 8192;  // sorting them takes 10 ms
  ObbTreeBuilder::build(*this, body, simplices, simplices.size() <= kFew ? kWrapperSplits : kBodySplits,
                        threads);
}

// Checks of a tree loaded from a file.
// 1. check_structure(): every node except the root has exactly one parent, which comes before it. The nodes
//    then form a tree and every traversal terminates. Every simplex is in exactly one leaf.
// 2. bounds_hold(): each corner is in the box of its simplex and in those of all ancestors, and the leaf
//    contains a correct copy of it. The completeness of queries depends on this.

namespace {

[[noreturn]] void reject(std::size_t node, const char* what) {
  throw InputError("node " + std::to_string(node) + " of the tree " + what +
                   "; rebuild the LRB-rep from its mesh");
}

/// Checks a leaf and removes its simplices from `missing`.
void check_leaf(std::size_t i, const TreeNode& node, const std::vector<LeafBlock>& blocks,
                std::vector<bool>& block_seen, std::vector<bool>& missing) {
  // A block belongs to exactly one leaf.
  if (node.first >= blocks.size() || block_seen[node.first])
    reject(i, "shares its block with another leaf, or has none");
  block_seen[node.first] = true;
  for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
    const std::uint32_t s = blocks[node.first].simplex[k];
    // Absent simplices must be marked as such.
    if (k >= node.count) {
      if (s != kNull) reject(i, "has a block with more faces than its count");
      continue;
    }
    if (s >= missing.size() || !missing[s])
      reject(i, "contains a face that does not belong to the tree or is also in another leaf");
    missing[s] = false;
  }
}

/// Checks that everything is reached once from the root, and that children come after their parents.
void check_structure(const std::vector<TreeNode>& nodes, const std::vector<LeafBlock>& blocks,
                     std::span<const SimplexId> simplices) {
  // `missing` starts as the set of listed simplices; leaves remove theirs.
  std::vector<bool> node_seen(nodes.size(), false), block_seen(blocks.size(), false);
  std::vector<bool> missing(
      simplices.empty() ? 0 : *std::max_element(simplices.begin(), simplices.end()) + std::size_t{1}, false);
  for (const SimplexId s : simplices) missing[s] = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const TreeNode& node = nodes[i];
    // Parents come before children, so one pass in ascending order reaches every node after its parent.
    if (i > 0 && !node_seen[i]) reject(i, "has no parent before it");
    if (node.count == 0 || node.count > kTreeWidth) reject(i, "has no children or too many");
    if (node.is_leaf > 1) reject(i, "is neither a leaf nor an inner node");
    if (node.is_leaf != 0) {
      check_leaf(i, node, blocks, block_seen, missing);
      continue;
    }
    // Written without a sum that could overflow.
    if (node.first <= i || node.first > nodes.size() || node.count > nodes.size() - node.first)
      reject(i, "has children that do not exist");
    for (std::uint32_t k = 0; k < node.count; ++k) {
      if (node_seen[node.first + k]) reject(i, "has a child that belongs to another node");
      node_seen[node.first + k] = true;
    }
  }
  // Every simplex and every block must have been reached.
  if (std::find(missing.begin(), missing.end(), true) != missing.end() ||
      std::find(block_seen.begin(), block_seen.end(), false) != block_seen.end())
    reject(0, "does not contain all faces");
}

Eigen::Vector3d in_frame(const TreeNode& node, const Eigen::Vector3d& x) {
  Eigen::Vector3d out;
  for (int i = 0; i < 3; ++i) {
    out[i] = 0;
    for (int j = 0; j < 3; ++j) out[i] += static_cast<double>(node.frame[i][j]) * (x[j] - node.origin[j]);
  }
  return out;
}

/// Returns true if box `k` of a node and its ball contain a point in units.
bool holds(const TreeNode& node, std::uint32_t k, const Eigen::Vector3d& x) {
  // The codes are decoded in double. Comparisons with NaN are false, so damaged numbers fail.
  const Eigen::Vector3d at = in_frame(node, x);
  for (int i = 0; i < 3; ++i) {
    const double base = node.base[i], scale = node.scale[i];
    if (!(at[i] >= base + scale * node.lo[i][k] && at[i] <= base + scale * node.hi[i][k])) return false;
  }
  return norm3(at) <= node.radius;
}

/// Returns true if a leaf's copy of a corner equals the corner, up to the rounding that the query allows for.
bool is_copy(const TreeNode& leaf, const LeafBlock& block, std::uint32_t k, int corner,
             const Eigen::Vector3d& x) {
  const Eigen::Vector3d at = in_frame(leaf, x);
  // The kernel's error bounds assume at most this error in the copies.
  const double rounding = kTreeRounding * leaf.radius + kTreeRoundingUnits;
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(at[i] - static_cast<double>(block.corner[corner][i][k])) <= rounding)) return false;
  return true;
}

bool is_orthonormal(const TreeNode& node) {
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes(i, j) = static_cast<double>(node.frame[i][j]);
  return rotation_defect(axes.transpose()) <= kFrameDefect;
}

}  // namespace

ObbTree::ObbTree(const SimplexView& body, std::vector<TreeNode> nodes, std::vector<LeafBlock> blocks)
    : ObbTree(body, body.real_simplices(), std::move(nodes), std::move(blocks)) {}

ObbTree::ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, std::vector<TreeNode> nodes,
                 std::vector<LeafBlock> blocks)
    : nodes_(std::move(nodes)), blocks_(std::move(blocks)) {
  measure(body, simplices);
  check_structure(nodes_, blocks_, simplices);
  // Depths from the root downwards, in one pass, because parents come first.
  std::vector<std::uint32_t> height(nodes_.size(), 1);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    height_ = std::max(height_, height[i]);
    for (std::uint32_t k = 0; nodes_[i].is_leaf == 0 && k < nodes_[i].count; ++k)
      height[nodes_[i].first + k] = height[i] + 1;
  }
}

bool ObbTree::bounds_hold(const SimplexView& body) const {
  int exponent = 0;
  std::frexp(unit_, &exponent);
  // Record each node's parent and its index there on the way down.
  std::vector<std::uint32_t> parent(nodes_.size(), kNull), place(nodes_.size(), 0);
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const TreeNode& node = nodes_[i];
    if (!is_orthonormal(node)) return false;
    if (node.is_leaf == 0) {
      for (std::uint32_t k = 0; k < node.count; ++k) {
        parent[node.first + k] = i;
        place[node.first + k] = k;
      }
      continue;
    }
    for (std::uint32_t k = 0; k < node.count; ++k) {
      VertexId v[3];
      body.simplex(blocks_[node.first].simplex[k], v);
      for (int corner = 0; corner < body.dim; ++corner) {
        const Eigen::Vector3d& world = body.vertices[v[corner]];
        // The same scaling as in Soup: a power of two, exact except for underflow.
        const Eigen::Vector3d x(std::ldexp(world.x(), 1 - exponent), std::ldexp(world.y(), 1 - exponent),
                                std::ldexp(world.z(), 1 - exponent));
        if (!holds(node, k, x) || !is_copy(node, blocks_[node.first], k, corner, x)) return false;
        // Climb to the root: one test per ancestor, so the time is the number of corners times the height.
        for (std::uint32_t n = i; parent[n] != kNull; n = parent[n])
          if (!holds(nodes_[parent[n]], place[n], x)) return false;
      }
    }
  }
  return true;
}

namespace {

bool children_overlap(const TreeNode& n, int x, int y) {
  // Codes on the parent's axes. Boxes that only touch do not count.
  for (int axis = 0; axis < 3; ++axis)
    if (n.lo[axis][x] >= n.hi[axis][y] || n.lo[axis][y] >= n.hi[axis][x]) return false;
  return true;
}

/// Returns the surface area of a node's box, tree units squared.
double area_of(const TreeNode& n) {
  double side[3];
  for (int i = 0; i < 3; ++i) side[i] = static_cast<double>(n.scale[i]) * kQuantizedMost;
  return 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
}

}  // namespace

TreeQuality tree_quality(const ObbTree& tree) {
  TreeQuality q;
  if (tree.empty()) return q;
  q.height = tree.height();
  std::uint64_t children = 0, pairs = 0, overlapping = 0;
  // A random line that hits the root hits a node with probability area / root area (Goldsmith and Salmon
  // 1987).
  const double root = area_of(tree.nodes()[0]);
  for (const TreeNode& n : tree.nodes()) {
    const double share = root > 0 ? area_of(n) / root : 0;
    ++q.nodes;
    if (n.is_leaf) {
      ++q.leaves;
      q.simplices += n.count;
      q.sah_leaves += share;
      continue;
    }
    q.sah_inner += share;
    children += n.count;
    // At most 28 pairs of siblings per node.
    for (int x = 0; x < n.count; ++x)
      for (int y = 0; y < x; ++y) {
        ++pairs;
        overlapping += children_overlap(n, x, y);
      }
  }
  const std::uint32_t inner = q.nodes - q.leaves;
  if (inner > 0) q.child_fill = static_cast<double>(children) / (inner * double{kTreeWidth});
  q.leaf_fill = static_cast<double>(q.simplices) / (q.leaves * double{kTreeWidth});
  if (pairs > 0) q.sibling_overlap = static_cast<double>(overlapping) / static_cast<double>(pairs);
  q.bytes_per_simplex = static_cast<double>(tree.memory_bytes()) / q.simplices;
  return q;
}

}  // namespace lrb
