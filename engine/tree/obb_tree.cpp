#include "engine/tree/obb_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "engine/core/eigenvectors.hpp"
#include "engine/core/parallel.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/pose_bounds.hpp"
#include "engine/tree/simplex_view.hpp"

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

double half_area(const Box& b) {
  const Vector3d e = b.sizes();
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

/// The simplices in units, in the order in which they were given; `order` lists them in the order of the
/// tree's leaves.
struct Soup {
  std::span<const SimplexId> simplices;
  std::vector<std::array<Vector3d, 3>> corners;
  std::vector<Vector3d> centre;  ///< centre of the box
  std::vector<Box> box;
  std::vector<std::uint32_t> order;
};

Soup make_soup(const SimplexView& body, std::span<const SimplexId> simplices, double unit) {
  int exponent = 0;
  std::frexp(unit, &exponent);
  const auto to_units = [e = 1 - exponent](const Vector3d& x) -> Vector3d {
    return {std::ldexp(x.x(), e), std::ldexp(x.y(), e), std::ldexp(x.z(), e)};
  };
  Soup soup;
  soup.simplices = simplices;
  const auto n = static_cast<std::uint32_t>(simplices.size());
  soup.corners.resize(n);
  soup.box.resize(n);
  soup.centre.resize(n);
  soup.order.resize(n);
  std::iota(soup.order.begin(), soup.order.end(), 0u);
  for (std::uint32_t s = 0; s < n; ++s) {
    VertexId v[3];
    body.simplex(simplices[s], v);
    if (body.dim == 2) v[2] = v[1];
    for (int k = 0; k < 3; ++k) {
      soup.corners[s][k] = to_units(body.vertices[v[k]]);
      soup.box[s].extend(soup.corners[s][k]);
    }
    soup.centre[s] = 0.5 * (soup.box[s].min() + soup.box[s].max());
  }
  return soup;
}

/// A node of the binary tree, which is collapsed to width eight afterwards.
struct BinaryNode {
  std::uint32_t begin, end;  ///< range in Soup::order
  std::uint32_t left = kNull, right = kNull;
  Box box;
  bool is_leaf() const { return left == kNull; }
};

/// Which splits the surface area heuristic chooses from. If from all, trees of wrappers, whose faces are few
/// and long, take up to a tenth fewer node pairs; those of bodies 0 to 4 %, for three times the time to
/// build.
enum class Splits { binned, all };

/// Builds the binary tree top-down. Every split leaves a multiple of eight simplices on its left, so that all
/// blocks but the last are full; among those splits the surface area heuristic chooses, on bins of the
/// centres or in their order.
class BinaryBuilder {
 public:
  BinaryBuilder(Soup& soup, Workers& workers, Splits splits)
      : soup_(soup), workers_(workers), splits_(splits) {
    const auto n = static_cast<std::uint32_t>(soup.order.size());
    nodes.resize(nodes_for(n));
    build(0, 0, n);
  }
  std::vector<BinaryNode> nodes;

 private:
  static constexpr int kBins = 32;

  static constexpr std::uint32_t kWorthSharing = 2048;  ///< simplices

  /// Returns the number of nodes for some simplices: every leaf but the last is full.
  static std::uint32_t nodes_for(std::uint32_t simplices) {
    return 2 * ((simplices + kTreeWidth - 1) / kTreeWidth) - 1;
  }

  /// Builds a subtree; parents come before children, left before right.
  void build(std::uint32_t self, std::uint32_t begin, std::uint32_t end) {
    BinaryNode& node = nodes[self];
    node = {begin, end, kNull, kNull, {}};
    for (std::uint32_t i = begin; i < end; ++i) node.box.extend(soup_.box[soup_.order[i]]);
    if (end - begin <= kTreeWidth) return;
    const std::uint32_t middle = split(begin, end);
    node.left = self + 1;
    node.right = node.left + nodes_for(middle - begin);
    if (end - begin < kWorthSharing) {
      build(node.left, begin, middle);
      build(node.right, middle, end);
    } else {
      workers_.both([&] { build(node.left, begin, middle); }, [&] { build(node.right, middle, end); });
    }
  }

  /// Where to split a range: how many simplices go to the left, in the order of their centres on an axis.
  struct Split {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 0;
    std::uint32_t left = 0;
  };

  /// Returns a function that tells which of two simplices comes first on an axis.
  auto order_on(int axis) const {
    return [this, axis](std::uint32_t s, std::uint32_t t) {
      const double x = soup_.centre[s][axis], y = soup_.centre[t][axis];
      return x != y ? x < y : s < t;
    };
  }

  std::uint32_t split(std::uint32_t begin, std::uint32_t end) {
    const Split best = splits_ == Splits::all ? best_of_all(begin, end) : best_binned(begin, end);
    const auto first = soup_.order.begin() + begin;
    std::nth_element(first, first + best.left, first + (end - begin), order_on(best.axis));
    return begin + best.left;
  }

  Split best_binned(std::uint32_t begin, std::uint32_t end) const {
    Box centres;
    for (std::uint32_t i = begin; i < end; ++i) centres.extend(soup_.centre[soup_.order[i]]);
    Split best;
    for (int axis = 0; axis < 3; ++axis) try_axis(begin, end, centres, axis, best.cost, best.axis, best.left);
    const std::uint32_t n = end - begin;
    if (best.left == 0) best.left = n / 2;  // all centres coincide: any half will do
    best.left = (best.left + kTreeWidth / 2) / kTreeWidth * kTreeWidth;
    best.left = std::clamp(best.left, kTreeWidth, (n - 1) / kTreeWidth * kTreeWidth);
    return best;
  }

  Split best_of_all(std::uint32_t begin, std::uint32_t end) const {
    std::vector<std::uint32_t> order(soup_.order.begin() + begin, soup_.order.begin() + end);
    const auto n = static_cast<std::uint32_t>(order.size());
    std::vector<double> right_cost(n);
    Split best;
    best.left = kTreeWidth;
    for (int axis = 0; axis < 3; ++axis) {
      std::sort(order.begin(), order.end(), order_on(axis));
      Box right, left;
      for (std::uint32_t i = n; i-- > 0;) {
        right.extend(soup_.box[order[i]]);
        right_cost[i] = half_area(right) * blocks_for(n - i);
      }
      for (std::uint32_t i = 1; i < n; ++i) {
        left.extend(soup_.box[order[i - 1]]);
        if (i % kTreeWidth != 0) continue;
        const double cost = half_area(left) * blocks_for(i) + right_cost[i];
        if (cost < best.cost) best = {cost, axis, i};
      }
    }
    return best;
  }

  void try_axis(std::uint32_t begin, std::uint32_t end, const Box& centres, int axis, double& best_cost,
                int& best_axis, std::uint32_t& best_left) const {
    const double from = centres.min()[axis], width = centres.sizes()[axis];
    if (!(width > 0)) return;
    std::array<Box, kBins> bin_box;
    std::array<std::uint32_t, kBins> bin_count{};
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t s = soup_.order[i];
      const int b = std::min(kBins - 1, static_cast<int>(kBins * ((soup_.centre[s][axis] - from) / width)));
      bin_box[b].extend(soup_.box[s]);
      ++bin_count[b];
    }
    std::array<double, kBins> right_cost{};
    Box right;
    std::uint32_t right_count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      right.extend(bin_box[b]);
      right_count += bin_count[b];
      right_cost[b] = right_count ? half_area(right) * blocks_for(right_count) : 0;
    }
    Box left;
    std::uint32_t left_count = 0;
    for (int b = 1; b < kBins; ++b) {
      left.extend(bin_box[b - 1]);
      left_count += bin_count[b - 1];
      if (left_count == 0 || left_count == end - begin) continue;
      const double cost = half_area(left) * blocks_for(left_count) + right_cost[b];
      if (cost < best_cost) {
        best_cost = cost;
        best_axis = axis;
        best_left = left_count;
      }
    }
  }

  static double blocks_for(std::uint32_t simplices) { return (simplices + kTreeWidth - 1) / kTreeWidth; }

  Soup& soup_;
  Workers& workers_;
  const Splits splits_;
};

struct Frame {
  Matrix3d axes;  ///< rows; rounded to float, so that what is measured is what the query uses
  Vector3d origin;
};

Matrix3d rounded_to_float(const Matrix3d& m) {
  return m.cast<float>().cast<double>();
}

/// Returns true if the rows are as orthonormal as kKernelRounding assumes; false for NaN.
bool is_orthonormal(const Matrix3d& axes) {
  return rotation_defect(axes.transpose()) <= kFrameDefect;
}

/// Returns the box of a range of simplices in a frame.
Box box_in_frame(const Soup& soup, std::uint32_t begin, std::uint32_t end, const Frame& f) {
  Box box;
  for (std::uint32_t i = begin; i < end; ++i)
    for (const Vector3d& x : soup.corners[soup.order[i]]) box.extend(f.axes * (x - f.origin));
  return box;
}

/// Returns the principal axes of the simplices (weighted by area, with a little for every corner so that
/// segments and points count), or the coordinate axes where those give the smaller box.
Frame fit_frame(const Soup& soup, std::uint32_t begin, std::uint32_t end, const Box& bounds) {
  Frame frame{Matrix3d::Identity(), 0.5 * (bounds.min() + bounds.max())};
  const double size = bounds.sizes().norm();
  if (!(size > 0)) return frame;
  double weight = 0;
  Vector3d mean = Vector3d::Zero();
  Matrix3d moment = Matrix3d::Zero();
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& c = soup.corners[soup.order[i]];
    const Vector3d p = (c[0] - frame.origin) / size, q = (c[1] - frame.origin) / size,
                   r = (c[2] - frame.origin) / size;
    const double w = (q - p).cross(r - p).norm() + kFrameCornerWeight;
    weight += w;
    mean += w / 3 * (p + q + r);
    moment +=
        w / 12 *
        ((p + q + r) * (p + q + r).transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
  }
  mean /= weight;
  const Matrix3d covariance = moment / weight - mean * mean.transpose();
  Frame principal{rounded_to_float(eigenvectors_of_symmetric(covariance).transpose()), frame.origin};
  if (!principal.axes.allFinite() || !is_orthonormal(principal.axes)) return frame;
  const Box turned = box_in_frame(soup, begin, end, principal);
  return half_area(turned) < half_area(bounds) ? principal : frame;
}

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
    Soup soup = make_soup(body, simplices, tree.unit_);
    ObbTreeBuilder(tree, soup, workers, splits);
    tree.nodes_.shrink_to_fit();
    tree.blocks_.shrink_to_fit();
  }

 private:
  ObbTreeBuilder(ObbTree& tree, Soup& soup, Workers& workers, Splits splits)
      : tree_(tree), soup_(soup), binary_(soup, workers, splits) {
    tree_.nodes_.resize(1);
    binary_of_.resize(1);
    lay_out(0, 0, 1);
    tree_.blocks_.resize(block_count_);
    // Nodes per task: a few of them hold enough simplices to be worth sharing.
    constexpr std::size_t kShare = 32;
    workers.for_each((tree_.nodes_.size() + kShare - 1) / kShare, [&](std::size_t i, unsigned) {
      const std::size_t end = std::min(tree_.nodes_.size(), (i + 1) * kShare);
      for (std::size_t n = i * kShare; n < end; ++n) fill(static_cast<std::uint32_t>(n));
    });
  }

  /// Decides where children and blocks go: depth first.
  void lay_out(std::uint32_t wide, std::uint32_t binary, std::uint32_t height) {
    tree_.height_ = std::max(tree_.height_, height);
    binary_of_[wide] = binary;
    if (binary_.nodes[binary].is_leaf()) {
      tree_.nodes_[wide].first = block_count_++;
      return;
    }
    const std::vector<std::uint32_t> children = widest_children(binary);
    const auto first = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_.resize(first + children.size());
    binary_of_.resize(tree_.nodes_.size());
    tree_.nodes_[wide].first = first;
    tree_.nodes_[wide].count = static_cast<std::uint8_t>(children.size());
    for (std::uint32_t k = 0; k < children.size(); ++k) lay_out(first + k, children[k], height + 1);
  }

  void fill(std::uint32_t wide) {
    const BinaryNode& b = binary_.nodes[binary_of_[wide]];
    const Frame frame = fit_frame(soup_, b.begin, b.end, b.box);
    TreeNode& node = tree_.nodes_[wide];
    const std::uint32_t first = node.first;
    std::vector<Box> boxes;
    if (b.is_leaf()) {
      boxes = fill_block(tree_.blocks_[first], b, frame);
    } else {
      for (std::uint32_t k = 0; k < node.count; ++k) {
        const BinaryNode& child = binary_.nodes[binary_of_[first + k]];
        boxes.push_back(box_in_frame(soup_, child.begin, child.end, frame));
      }
    }
    quantize(node, frame, boxes);
    node.first = first;
    node.is_leaf = b.is_leaf();
  }

  /// Returns a wide node's children: opens the child with the largest box until there are eight.
  std::vector<std::uint32_t> widest_children(std::uint32_t binary) const {
    std::vector<std::uint32_t> children = {binary_.nodes[binary].left, binary_.nodes[binary].right};
    while (children.size() < kTreeWidth) {
      std::size_t largest = children.size();
      double largest_area = -1;
      for (std::size_t k = 0; k < children.size(); ++k) {
        const BinaryNode& c = binary_.nodes[children[k]];
        if (!c.is_leaf() && half_area(c.box) > largest_area) {
          largest_area = half_area(c.box);
          largest = k;
        }
      }
      if (largest == children.size()) break;
      const BinaryNode& opened = binary_.nodes[children[largest]];
      children[largest] = opened.left;
      children.insert(children.begin() + static_cast<std::ptrdiff_t>(largest) + 1, opened.right);
    }
    return children;
  }

  std::vector<Box> fill_block(LeafBlock& block, const BinaryNode& b, const Frame& frame) const {
    std::vector<Box> boxes;
    block = {};
    std::fill(std::begin(block.simplex), std::end(block.simplex), kNull);
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      const std::uint32_t s = soup_.order[std::min(b.begin + k, b.end - 1)];
      for (int corner = 0; corner < 3; ++corner) {
        const Vector3d x = frame.axes * (soup_.corners[s][corner] - frame.origin);
        for (int axis = 0; axis < 3; ++axis) block.corner[corner][axis][k] = static_cast<float>(x[axis]);
      }
      if (b.begin + k < b.end) {
        block.simplex[k] = soup_.simplices[s];
        boxes.push_back(box_in_frame(soup_, b.begin + k, b.begin + k + 1, frame));
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
      const double lo = all.min()[i] - 2 * margin, hi = all.max()[i] + 2 * margin;
      node.base[i] = std::nextafter(static_cast<float>(lo), -INFINITY);
      node.scale[i] = std::nextafter(static_cast<float>((hi - node.base[i]) / kQuantizedMost), INFINITY);
      for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
        node.lo[i][k] =
            k < boxes.size() ? quantize_down(node, i, boxes[k].min()[i] - margin) : kQuantizedMost;
        node.hi[i][k] = k < boxes.size() ? quantize_up(node, i, boxes[k].max()[i] + margin) : 0;
      }
    }
    node.count = static_cast<std::uint8_t>(boxes.size());
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner)
      farthest = std::max(farthest, all.corner(static_cast<Box::CornerType>(corner)).norm());
    node.radius = std::nextafter(static_cast<float>(farthest + 2 * margin), INFINITY);
  }

  static float decode(const TreeNode& node, int axis, int q) {
    return node.base[axis] + node.scale[axis] * static_cast<float>(q);
  }
  static std::uint8_t quantize_down(const TreeNode& node, int axis, double x) {
    int q = std::clamp(static_cast<int>((x - node.base[axis]) / node.scale[axis]) + 1, 0, kQuantizedMost);
    while (q > 0 && decode(node, axis, q) > x) --q;
    return static_cast<std::uint8_t>(q);
  }
  static std::uint8_t quantize_up(const TreeNode& node, int axis, double x) {
    int q = std::clamp(static_cast<int>((x - node.base[axis]) / node.scale[axis]) - 1, 0, kQuantizedMost);
    while (q < kQuantizedMost && decode(node, axis, q) < x) ++q;
    return static_cast<std::uint8_t>(q);
  }

  ObbTree& tree_;
  Soup& soup_;
  BinaryBuilder binary_;
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
  int exponent = 0;
  std::frexp(extent_, &exponent);
  unit_ = std::ldexp(1.0, std::clamp(exponent, -1022, 1023));
}

ObbTree::ObbTree(const SimplexView& body, unsigned threads) {
  ObbTreeBuilder::build(*this, body, body.real_simplices(), Splits::binned, threads);
}

ObbTree::ObbTree(const SimplexView& body, std::span<const SimplexId> simplices, unsigned threads) {
  constexpr std::size_t kFew = 8192;  // sorting them takes a hundredth of a second
  ObbTreeBuilder::build(*this, body, simplices, simplices.size() <= kFew ? Splits::all : Splits::binned,
                        threads);
}

}  // namespace lrb
