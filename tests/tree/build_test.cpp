// How trees are built: over bodies of every kind and scale, with every instruction set, on any number of
// threads.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "engine/tree/binary_tree.hpp"
#include "engine/tree/kernel_choice.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/simplex_view.hpp>

using namespace lrb;
using Eigen::Vector3d;
using shapes::RandomEngine;

namespace {

/// Loose triangles, each with corners of its own; in 2D, their first edges.
struct Triangles {
  std::vector<Vector3d> points;
  int dim = 3;

  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    points.insert(points.end(), {a, b, c});
  }
  void add(const Triangles& more, double scale, const Vector3d& by) {
    for (const Vector3d& x : more.points) points.push_back(scale * x + by);
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(points.size() / 3); }

  /// Refers to these.
  SimplexView view() const {
    SimplexView view;
    view.dim = dim;
    view.vertices = points;
    view.real_count = size();
    view.corners_of = [](const void*, SimplexId s, VertexId* v) {
      for (std::uint32_t k = 0; k < 3; ++k) v[k] = static_cast<VertexId>(3 * s.value() + k);
    };
    return view;
  }
};

/// Triangles at random places in a cube, of a size relative to it.
Triangles scattered(int count, double size) {
  RandomEngine random(static_cast<std::uint64_t>(count));
  Triangles triangles;
  for (int i = 0; i < count; ++i) {
    Vector3d corner[3];
    const Vector3d centre = shapes::uniform(random, 0, 1) * shapes::random_direction(random);
    for (Vector3d& c : corner) c = centre + size * shapes::random_direction(random);
    triangles.add(corner[0], corner[1], corner[2]);
  }
  return triangles;
}

template <class Item>
bool same_bytes(const std::vector<Item>& x, const std::vector<Item>& y) {
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Item)) == 0;
}

void check(const Triangles& triangles) {
  const SimplexView view = triangles.view();
  const ObbTree tree(view, 1u);
  CHECK(tree.bounds_hold(view));
  // Every simplex is in one leaf.
  CHECK_NOTHROW(ObbTree(view, tree.nodes(), tree.blocks()));
  const ObbTree again(view, 3u);
  CHECK(same_bytes(tree.nodes(), again.nodes()));
  CHECK(same_bytes(tree.blocks(), again.blocks()));
}

/// Returns the sum of the areas of the boxes of leaves, mesh units squared.
double area_of_leaves(const ObbTree& tree) {
  double sum = 0;
  for (const TreeNode& n : tree.nodes()) {
    const double x = n.scale[0], y = n.scale[1], z = n.scale[2];
    if (n.is_leaf) sum += 2 * (x * y + y * z + z * x) * kQuantizedMost * kQuantizedMost;
  }
  return sum * tree.unit() * tree.unit();
}

}  // namespace

TEST_CASE("trees hold their simplices at any number, size and distance, on any number of threads") {
  for (const int count : {1, 2, 7, 8, 9, 16, 17, 63, 255, 256, 257, 264, 265, 513, 2'049, 9'000}) {
    CAPTURE(count);
    check(scattered(count, 0.05));
  }
  const Triangles some = scattered(700, 0.05);
  for (const double size : {1e-320, 1e-305, 1e-150, 1e-12, 1e150, 1e300}) {
    CAPTURE(size);
    Triangles scaled, far, clusters, flat;
    scaled.add(some, size, {0, 0, 0});
    check(scaled);
    far.add(some, 1, {1 / size, -3 / size, 0});
    if (size > 1e-300) check(far);
    clusters.add(some, std::min(size, 1 / size), {0.2, 0.3, 0.4});
    clusters.add(some, std::min(size, 1 / size), {0, 0, 0});
    clusters.add(some, 1, {3, 0, 0});
    check(clusters);
    for (const Vector3d& x : some.points) flat.points.emplace_back(x[0], std::min(size, 1 / size) * x[1], 0);
    check(flat);
    flat.dim = 2;
    check(flat);
  }
  Triangles decades, equal, line;
  for (std::size_t i = 0; i < some.points.size(); ++i)
    decades.points.push_back(std::pow(10, -300.0 * static_cast<double>(i / 3) / some.size()) *
                             some.points[i]);
  check(decades);
  for (int i = 0; i < 20'000; ++i) equal.add({0.5, 0.1, 0.2}, {0.5, 0.1, 0.2}, {0.5, 0.1, 0.2});
  check(equal);
  for (int i = 0; i < 20'000; ++i)
    line.add({1e-5 * i, 0, 0.25}, {1e-5 * (i + 1), 0, 0.25}, {1e-5 * i, 0, 0.25});
  check(line);
  // Balanced.
  CHECK(ObbTree(equal.view(), 1u).height() <= 7);
  CHECK(ObbTree(line.view(), 1u).height() <= 7);
}

namespace lrb {
#define LRB_BUILD_KERNELS(set)                 \
  void run_split_kernel_##set(SplitKernel&);   \
  void run_divide_kernel_##set(DivideKernel&); \
  void run_node_kernel_##set(const NodeKernel&);
LRB_BUILD_KERNELS(baseline)
#if defined(__x86_64__)
LRB_BUILD_KERNELS(avx2)
LRB_BUILD_KERNELS(avx512)
#endif
}  // namespace lrb

namespace {

struct Kernels {
  void (*split)(SplitKernel&);
  void (*divide)(DivideKernel&);
  void (*node)(const NodeKernel&);
};

/// All that the kernels make of some triangles.
struct Made {
  std::vector<FloatBox> boxes;
  std::vector<TreeNode> nodes;
  std::vector<LeafBlock> blocks;

  Made(const Triangles& triangles, const Kernels& run) {
    const std::uint32_t n = triangles.size();
    std::vector<VertexId> corners(triangles.points.size());
    for (std::uint32_t i = 0; i < corners.size(); ++i) corners[i] = VertexId(i);
    std::vector<SimplexId> ids(n);
    std::vector<std::uint32_t> order(n);
    boxes.resize(n);
    for (std::uint32_t s = 0; s < n; ++s) {
      ids[s] = SimplexId(order[s] = s);
      Eigen::AlignedBox3f box;
      for (std::uint32_t k = 0; k < 3; ++k) box.extend(triangles.points[3 * s + k].cast<float>());
      boxes[s] = {
          {box.min()[0], box.min()[1], box.min()[2]}, s, {-box.max()[0], -box.max()[1], -box.max()[2]}, 0};
    }
    std::vector<FloatBox> buffer(n);
    SplitKernel split{boxes.data(), buffer.data(), n, {-2, -2, -2, 0, -2, -2, -2, 0}, 0, 0, 0, {}, 0, 0};
    run.split(split);
    std::vector<BinaryNode> binary(nodes_for(n));
    binary[0] = {0, n, kNull, kNull, 1};
    const std::uint32_t leaves = leaves_for(n);
    nodes.resize(leaves + 1);
    blocks.resize(leaves);
    std::vector<LeafSum> sums(leaves);
    const auto memory = std::make_unique<DivideMemory>();
    DivideKernel divide{{triangles.points[0].data(), corners.data(), ids.data(), 0.5},
                        order.data(),
                        binary.data(),
                        0,
                        nodes.data(),
                        blocks.data(),
                        sums.data(),
                        memory.get(),
                        0};
    run.divide(divide);
    NodeKernel node{&sums[0].sum, {}, std::min(leaves, kTreeWidth), &nodes[leaves]};
    for (std::uint32_t k = 0; k < node.count; ++k) node.children[k] = {&sums[k].sum, &sums[k], &sums[k] + 1};
    run.node(node);
  }
};

}  // namespace

TEST_CASE("the kernels of all instruction sets build the same nodes") {
#if defined(__x86_64__)
  std::vector<Kernels> others;
  if (best_instruction_set() >= InstructionSet::avx2)
    others.push_back({run_split_kernel_avx2, run_divide_kernel_avx2, run_node_kernel_avx2});
  if (best_instruction_set() >= InstructionSet::avx512)
    others.push_back({run_split_kernel_avx512, run_divide_kernel_avx512, run_node_kernel_avx512});
  for (int count = 1; count <= static_cast<int>(kSmallRange); count += 5) {
    const Triangles triangles = scattered(count, count % 2 == 0 ? 0.3 : 1e-9);
    const Made made(triangles,
                    {run_split_kernel_baseline, run_divide_kernel_baseline, run_node_kernel_baseline});
    for (const Kernels& other : others) {
      CAPTURE(count);
      const Made too(triangles, other);
      CHECK(same_bytes(made.boxes, too.boxes));
      CHECK(same_bytes(made.nodes, too.nodes));
      CHECK(same_bytes(made.blocks, too.blocks));
    }
  }
#endif
}

TEST_CASE("clusters that are far below the resolution of floats are divided as well as alone") {
  const Triangles some = scattered(3'000, 0.02);
  for (const double size : {1e-3, 1e-9, 1e-12}) {
    CAPTURE(size);
    Triangles alone, clusters;
    alone.add(some, size, {0, 0, 0});
    clusters.add(some, size, {0, 0, 0});
    for (int i = 0; i < 8; ++i) clusters.add({1, 0, 0}, {1, 0, 0}, {1, 0, 0});
    const ObbTree tree(clusters.view(), 1u);
    CHECK(tree.bounds_hold(clusters.view()));
    CHECK(area_of_leaves(tree) < 1.1 * area_of_leaves(ObbTree(alone.view(), 1u)));
  }
}

TEST_CASE("the box of a square plate is turned to its sides") {
  RandomEngine random(3);
  for (int round = 0; round < 50; ++round) {
    const Eigen::Matrix3d turn = shapes::random_rotation(random);
    Triangles plate;
    const auto at = [&](int x, int y) { return Vector3d(turn * Vector3d(x - 1, y - 1, 0)); };
    for (int x = 0; x < 2; ++x)
      for (int y = 0; y < 2; ++y) {
        plate.add(at(x, y), at(x + 1, y), at(x, y + 1));
        plate.add(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
      }
    // 16 angles of 90 degrees: off by at most 2.8. Any principal axes fit a square: up to 45 degrees off.
    CHECK(area_of_leaves(ObbTree(plate.view(), 1u)) < 2 * 4 * 1.11);
  }
}
