// Construction of the 8-wide OBB tree (principal axes: Gottschalk, Lin and Manocha 1996; quantized child
// boxes: Ylitie, Karras and Laine 2017).
// 1. Choose the unit, a power of two, so that coordinates are at most about 1.
// 2. Split the simplices down to ranges of kSmallRange (binary_tree.hpp), and these, in parallel, down to
// leaves,
//    which are filled at once (divide_kernel.inl).
// 3. Collapse the binary tree to eight children per node, and lay out the nodes depth first.
// 4. Fill the inner nodes independently, in parallel: fit a frame to the moments of the leaves beneath,
// compute
//    the boxes of the leaves' vertices in it, quantize them outwards (node_kernel.inl).

#include <algorithm>
#include <cmath>
#include <memory>
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

/// Returns the smallest power of two above the extent, clamped to the range of normal doubles.
double unit_above(double extent) {
  int exponent = 0;
  std::frexp(extent, &exponent);
  return std::ldexp(1.0, std::clamp(exponent, -1022, 1023));
}

}  // namespace

class ObbTreeBuilder {
 public:
  /// Builds an empty tree over the listed simplices.
  static void build(ObbTree& tree, const SimplexView& body, std::span<const SimplexId> simplices,
                    unsigned threads) {
    if (simplices.empty()) return;
    Workers workers(threads);
    ObbTreeBuilder(tree, body, simplices, workers);
  }

 private:
  ObbTreeBuilder(ObbTree& tree, const SimplexView& body, std::span<const SimplexId> simplices,
                 Workers& workers)
      : tree_(tree), workers_(workers) {
    const auto count = static_cast<std::uint32_t>(simplices.size());
    const std::vector<VertexId> corners = read(body, simplices);
    // The unit is a power of two, at least 2^-1022. The inverse of 2^1023 is subnormal, but exact.
    const BuildInput in{body.vertices.data()->data(), corners.data(), simplices.data(), 1 / tree.unit_};
    binary_ = split_large_ranges(in, count, workers);
    leaves_.resize(leaves_for(count));
    leaf_nodes_.resize(leaves_.size());
    tree_.blocks_.resize(leaves_.size());
    divide(in);
    places_.reserve(leaves_.size() * 5 / 4 + kTreeWidth);
    places_.resize(1);
    lay_out(Collapse(binary_.nodes), 0, 0, 1);
    tree_.nodes_.resize(places_.size());
    sum_up();
    // Nodes per task: enough simplices to be worth distributing.
    constexpr std::size_t kNodes = 32;
    workers.for_each((places_.size() + kNodes - 1) / kNodes, [&](std::size_t i, unsigned) {
      const std::size_t end = std::min(places_.size(), (i + 1) * kNodes);
      for (std::size_t n = i * kNodes; n < end; ++n) fill(static_cast<std::uint32_t>(n));
    });
  }

  /// Reads the corners of the simplices, and sets the tree's extent and unit.
  std::vector<VertexId> read(const SimplexView& body, std::span<const SimplexId> simplices) {
    std::vector<VertexId> corners(3 * simplices.size());
    std::vector<double> extents(shares_of(simplices.size()));
    for_each_share(simplices.size(), workers_,
                   [&](std::uint32_t begin, std::uint32_t end, std::size_t share) {
                     double extent = 0;
                     for (std::uint32_t s = begin; s < end; ++s) {
                       VertexId* const v = corners.data() + std::size_t{3} * s;
                       body.simplex(simplices[s], v);
                       // A segment is a triangle whose last two corners coincide.
                       if (body.dim == 2) v[2] = v[1];
                       for (int k = 0; k < body.dim; ++k)
                         for (int i = 0; i < 3; ++i)
                           extent = std::max(extent, std::abs(body.vertices[v[k]][i]));
                     }
                     extents[share] = extent;
                   });
    tree_.extent_ = *std::ranges::max_element(extents);
    tree_.unit_ = unit_above(tree_.extent_);
    return corners;
  }

  /// Divides the small ranges and fills the leaves.
  void divide(const BuildInput& in) {
    std::vector<std::uint32_t> ranges;
    for (std::uint32_t i = 0; i < binary_.nodes.size(); ++i)
      if (binary_.nodes[i].is_leaf() && binary_.nodes[i].end > 0) ranges.push_back(i);
    packets_.resize(ranges.size());
    std::vector<std::unique_ptr<DivideMemory>> memories(workers_.count());
    workers_.for_each(ranges.size(), [&](std::size_t i, unsigned worker) {
      std::unique_ptr<DivideMemory>& memory = memories[worker];
      if (!memory) memory.reset(new DivideMemory);
      const BinaryNode range = binary_.nodes[ranges[i]];
      DivideKernel k{in,
                     binary_.order.data(),
                     binary_.nodes.data(),
                     ranges[i],
                     leaf_nodes_.data(),
                     tree_.blocks_.data(),
                     leaves_.data(),
                     memory.get(),
                     0};
      run_divide_kernel(k);
      packets_[i].assign(memory->packets, memory->packets + k.packet_count);
      for (std::uint32_t leaf = range.begin / kTreeWidth; leaf < leaves_for(range.end); ++leaf)
        leaves_[leaf].packets = packets_[i].data() + (leaves_[leaf].packets - memory->packets);
    });
  }

  /// Assigns the indices of children and blocks, depth first.
  void lay_out(const Collapse& collapse, std::uint32_t wide, std::uint32_t binary, std::uint32_t height) {
    tree_.height_ = std::max(tree_.height_, height);
    const BinaryNode& node = binary_.nodes[binary];
    const std::uint32_t begin = node.begin / kTreeWidth, end = leaves_for(node.end);
    // A leaf: `first` is the number of its block.
    if (node.is_leaf()) {
      places_[wide] = {begin, end, begin, 0};
      return;
    }
    // Children are contiguous: their indices are reserved before those of any subtree.
    const std::vector<std::uint32_t> children = collapse.children(binary);
    const auto first = static_cast<std::uint32_t>(places_.size());
    places_[wide] = {begin, end, first, static_cast<std::uint32_t>(children.size())};
    places_.resize(first + children.size());
    for (std::uint32_t k = 0; k < children.size(); ++k) lay_out(collapse, first + k, children[k], height + 1);
  }

  const NodeSum& sum_of(std::uint32_t wide) const {
    return places_[wide].count == 0 ? leaves_[places_[wide].first].sum : sums_[wide];
  }

  /// Computes the sums of inner nodes from those of their children, which come after them.
  void sum_up() {
    sums_.resize(places_.size());
    for (auto wide = static_cast<std::uint32_t>(places_.size()); wide-- > 0;) {
      const Place& place = places_[wide];
      if (place.count == 0) continue;
      NodeSum& all = sums_[wide];
      all = {0,
             {0, 0, 0},
             {0, 0, 0, 0, 0, 0},
             {kInfinity, kInfinity, kInfinity},
             {-kInfinity, -kInfinity, -kInfinity}};
      for (std::uint32_t k = place.first; k < place.first + place.count; ++k) {
        const NodeSum& x = sum_of(k);
        all.weight += x.weight;
        for (int i = 0; i < 3; ++i) {
          all.mean[i] += x.weight * x.mean[i];
          all.low[i] = std::min(all.low[i], x.low[i]);
          all.high[i] = std::max(all.high[i], x.high[i]);
        }
      }
      // Without weight (underflow) there are no principal axes.
      if (!(all.weight > 0)) continue;
      for (double& x : all.mean) x /= all.weight;
      for (std::uint32_t k = place.first; k < place.first + place.count; ++k) {
        const NodeSum& x = sum_of(k);
        const double d[3] = {x.mean[0] - all.mean[0], x.mean[1] - all.mean[1], x.mean[2] - all.mean[2]};
        for (int i = 0; i < 3; ++i) {
          all.second[i] += x.second[i] + x.weight * d[i] * d[i];
          all.second[3 + i] += x.second[3 + i] + x.weight * d[(i + 1) % 3] * d[(i + 2) % 3];
        }
      }
    }
  }

  void fill(std::uint32_t wide) {
    const Place& place = places_[wide];
    TreeNode& node = tree_.nodes_[wide];
    if (place.count == 0) {
      node = leaf_nodes_[place.first];
      return;
    }
    NodeKernel k;
    k.sum = &sums_[wide];
    k.count = place.count;
    k.node = &node;
    for (std::uint32_t i = 0; i < place.count; ++i) {
      const Place& child = places_[place.first + i];
      k.children[i] = {&sum_of(place.first + i), leaves_.data() + child.begin, leaves_.data() + child.end};
    }
    run_node_kernel(k);
    node.first = place.first;
  }

  ObbTree& tree_;
  Workers& workers_;
  BinaryTree binary_;
  std::vector<TreeNode> leaf_nodes_;  ///< (|leaves|)
  std::vector<LeafSum> leaves_;
  std::vector<std::vector<VertexPacket>> packets_;  ///< of each small range
  /// Where a wide node is.
  struct Place {
    std::uint32_t begin, end;    ///< leaves beneath it
    std::uint32_t first, count;  ///< as in TreeNode; a leaf's count is 0 here
  };
  std::vector<Place> places_;  ///< (|nodes|)
  std::vector<NodeSum> sums_;  ///< (|nodes|) of inner nodes
};

void ObbTree::measure(const SimplexView& body, std::span<const SimplexId> simplices) {
  for (const SimplexId s : simplices) {
    VertexId v[3];
    body.simplex(s, v);
    for (int k = 0; k < body.dim; ++k) extent_ = std::max(extent_, body.vertices[v[k]].cwiseAbs().maxCoeff());
  }
  if (!simplices.empty()) unit_ = unit_above(extent_);
}

ObbTree::ObbTree(const SimplexView& body, unsigned threads) : ObbTree(body, body.real_simplices(), threads) {}

ObbTree::ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, unsigned threads) {
  ObbTreeBuilder::build(*this, body, simplices, threads);
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
