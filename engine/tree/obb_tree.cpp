// Builds the 8-wide tree of oriented boxes (principal axes: Gottschalk, Lin and Manocha 1996; quantized child
// boxes: Ylitie, Karras and Laine 2017).
// 1. Choose the unit, a power of two, so that coordinates are at most about 1.
// 2. Build a binary tree (binary_tree.hpp), and collapse it to eight children per node (collapse.hpp).
// 3. Lay out nodes and blocks depth first.
// 4. Fill each node by itself, in parallel: fit a frame, compute the boxes in it, quantize them outwards.

#include "engine/tree/obb_tree.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/binary_tree.hpp"
#include "engine/tree/collapse.hpp"
#include "engine/tree/soup.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Splits of trees of bodies. More tries save nothing, fewer cost 2 % of a query (docs/measurements.md).
constexpr Splits kBodySplits{.fitted = 2048, .effort = {.principal = 1, .tried = 3}, .all_cuts = false};
/// Splits of trees of wrappers, whose faces are few and long: these are worth more tries.
constexpr Splits kWrapperSplits{.fitted = 512, .effort = {.principal = 3, .tried = 32}, .all_cuts = true};

}  // namespace

/// Collapses the binary tree to eight children per node and quantizes the boxes. First decides where
/// everything goes, then fills in each node by itself.
class ObbTreeBuilder {
 public:
  /// Builds an empty tree over the listed simplices.
  static void build(ObbTree& tree, const SimplexView& body, std::span<const SimplexId> simplices,
                    Splits splits, unsigned threads) {
    tree.measure(body, simplices);
    if (simplices.empty()) return;
    Workers workers(threads);
    Soup soup(body, simplices, tree.unit_);
    ObbTreeBuilder(tree, soup, workers, splits);
    tree.nodes_.shrink_to_fit();
    tree.blocks_.shrink_to_fit();
  }

 private:
  ObbTreeBuilder(ObbTree& tree, Soup& soup, Workers& workers, Splits splits)
      : tree_(tree), soup_(soup), binary_(build_binary_tree(soup, workers, splits)) {
    tree_.nodes_.resize(1);
    binary_of_.resize(1);
    lay_out(Collapse(binary_), 0, 0, 1);
    tree_.blocks_.resize(block_count_);
    // Nodes per task: a few of them hold enough simplices to be worth sharing.
    constexpr std::size_t kShare = 32;
    workers.for_each((tree_.nodes_.size() + kShare - 1) / kShare, [&](std::size_t i, unsigned) {
      const std::size_t end = std::min(tree_.nodes_.size(), (i + 1) * kShare);
      for (std::size_t n = i * kShare; n < end; ++n) fill(static_cast<std::uint32_t>(n));
    });
  }

  /// Decides where children and blocks go: depth first.
  void lay_out(const Collapse& collapse, std::uint32_t wide, std::uint32_t binary, std::uint32_t height) {
    tree_.height_ = std::max(tree_.height_, height);
    binary_of_[wide] = binary;
    // A leaf: `first` is the number of its block.
    if (binary_[binary].is_leaf()) {
      tree_.nodes_[wide].first = block_count_++;
      return;
    }
    // Children are contiguous. Their places are reserved before any of their subtrees.
    const std::vector<std::uint32_t> children = collapse.children(binary);
    const auto first = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.resize(first + children.size());
    binary_of_.resize(tree_.nodes_.size());
    tree_.nodes_[wide].first = first;
    tree_.nodes_[wide].count = static_cast<std::uint8_t>(children.size());
    for (std::uint32_t k = 0; k < children.size(); ++k) lay_out(collapse, first + k, children[k], height + 1);
  }

  void fill(std::uint32_t wide) {
    const BinaryNode& b = binary_[binary_of_[wide]];
    // The boxes of children are recomputed from the simplices in this frame: a box of a box would be looser.
    const Frame frame = fit_frame(soup_, soup_.listed(b.begin, b.end), b.box);
    TreeNode& node = tree_.nodes_[wide];
    const std::uint32_t first = node.first;
    std::vector<Box> boxes;
    if (b.is_leaf()) {
      boxes = fill_block(tree_.blocks_[first], b, frame);
    } else {
      for (std::uint32_t k = 0; k < node.count; ++k) {
        const BinaryNode& child = binary_[binary_of_[first + k]];
        boxes.push_back(box_in_frame(soup_, soup_.listed(child.begin, child.end), frame));
      }
    }
    // quantize() overwrites the whole node.
    quantize(node, frame, boxes);
    node.first = first;
    node.is_leaf = b.is_leaf();
  }

  std::vector<Box> fill_block(LeafBlock& block, const BinaryNode& b, const Frame& frame) const {
    std::vector<Box> boxes;
    block = {};
    std::fill(std::begin(block.simplex), std::end(block.simplex), kNull);
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      // Absent simplices repeat the last one, so that all eight lanes contain valid coordinates.
      const std::uint32_t s = soup_.order[std::min(b.begin + k, b.end - 1)];
      for (int corner = 0; corner < 3; ++corner) {
        const Vector3d x = frame.axes * (soup_.corners[s][corner] - frame.origin);
        for (int axis = 0; axis < 3; ++axis) block.corner[corner][axis][k] = static_cast<float>(x[axis]);
      }
      if (b.begin + k < b.end) {
        block.simplex[k] = soup_.simplices[s];
        boxes.push_back(box_in_frame(soup_, soup_.listed(b.begin + k, b.begin + k + 1), frame));
      }
    }
    return boxes;
  }

  static void quantize(TreeNode& node, const Frame& frame, const std::vector<Box>& boxes) {
    node = {};
    Box all;
    for (const Box& b : boxes) all.extend(b);
    // Covers the rounding in the projection above, and leaves room for the float arithmetic below.
    const double margin =
        kTreeRounding * (all.min().cwiseAbs().cwiseMax(all.max().cwiseAbs()).maxCoeff()) + kTreeRoundingUnits;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) node.frame[i][j] = static_cast<float>(frame.axes(i, j));
      node.origin[i] = frame.origin[i];
      // The range is widened by twice the margin: the boxes grow by one, and the codes must still cover them.
      const double lo = all.min()[i] - 2 * margin, hi = all.max()[i] + 2 * margin;
      node.base[i] = std::nextafter(static_cast<float>(lo), -INFINITY);
      node.scale[i] = std::nextafter(static_cast<float>((hi - node.base[i]) / kQuantizedMost), INFINITY);
      for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
        // Absent children have lo > hi.
        node.lo[i][k] =
            k < boxes.size() ? quantize_down(node, i, boxes[k].min()[i] - margin) : kQuantizedMost;
        node.hi[i][k] = k < boxes.size() ? quantize_up(node, i, boxes[k].max()[i] + margin) : 0;
      }
    }
    node.count = static_cast<std::uint8_t>(boxes.size());
    // The origin is 0 in this frame, so the farthest corner of the common box bounds the radius.
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner)
      farthest = std::max(farthest, all.corner(static_cast<Box::CornerType>(corner)).norm());
    node.radius = std::nextafter(static_cast<float>(farthest + 2 * margin), INFINITY);
  }

  static float decode(const TreeNode& node, int axis, int q) {
    return node.base[axis] + node.scale[axis] * static_cast<float>(q);
  }
  static std::uint8_t quantize_down(const TreeNode& node, int axis, double x) {
    // Start one code too high and step down until the decoded value is at or below x. The float decoding
    // itself decides, so no estimate of its rounding is needed here.
    int q = std::clamp(static_cast<int>((x - node.base[axis]) / node.scale[axis]) + 1, 0, kQuantizedMost);
    while (q > 0 && decode(node, axis, q) > x) --q;
    return static_cast<std::uint8_t>(q);
  }
  static std::uint8_t quantize_up(const TreeNode& node, int axis, double x) {
    // The mirror image: the decoded value is at or above x.
    int q = std::clamp(static_cast<int>((x - node.base[axis]) / node.scale[axis]) - 1, 0, kQuantizedMost);
    while (q < kQuantizedMost && decode(node, axis, q) < x) ++q;
    return static_cast<std::uint8_t>(q);
  }

  ObbTree& tree_;
  Soup& soup_;
  const std::vector<BinaryNode> binary_;
  std::vector<std::uint32_t> binary_of_;  ///< (|nodes|) the binary tree's node for each wide one
  std::uint32_t block_count_ = 0;
};

void ObbTree::measure(const SimplexView& body, std::span<const SimplexId> simplices) {
  for (const SimplexId s : simplices) {
    VertexId v[3];
    body.simplex(s, v);
    for (int k = 0; k < body.dim; ++k) extent_ = std::max(extent_, body.vertices[v[k]].cwiseAbs().maxCoeff());
  }
  if (simplices.empty()) return;
  // The least power of two above the extent, kept inside the range of normal doubles.
  int exponent = 0;
  std::frexp(extent_, &exponent);
  unit_ = std::ldexp(1.0, std::clamp(exponent, -1022, 1023));
}

ObbTree::ObbTree(const SimplexView& body, unsigned threads) {
  ObbTreeBuilder::build(*this, body, body.real_simplices(), kBodySplits, threads);
}

ObbTree::ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, unsigned threads) {
  constexpr std::size_t kFew = 8192;  // sorting them takes a hundredth of a second
  ObbTreeBuilder::build(*this, body, simplices, simplices.size() <= kFew ? kWrapperSplits : kBodySplits,
                        threads);
}

}  // namespace lrb
