/// lrbscope-xray-cgal: like lrbscope-xray-fcl, for CGAL's AABB_tree (xray_form.hpp: input and output).
/// Queries the tree over B's triangles with each triangle of A, transformed to B's frame. The traits work
/// like CGAL's own and report each test. A's tree is a root with a leaf for each triangle. A separate
/// program, because CGAL's licence is the GPL.
#include <cstdio>
#include <map>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "bench/programs/xray_form.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
using Tree = CGAL::AABB_tree<Traits>;
using Node = CGAL::AABB_node<Traits>;

Triangles read_triangles(std::istream& in) {
  const xray_form::Triangles t = xray_form::read_triangles(in);
  std::vector<Point> points;
  for (const auto& v : t.vertices) points.emplace_back(v[0], v[1], v[2]);
  Triangles out;
  for (const auto& c : t.corners) out.emplace_back(points[c[0]], points[c[1]], points[c[2]]);
  return out;
}

Kernel::Aff_transformation_3 read_pose(std::istream& in) {
  const auto m = xray_form::next_numbers<12, double>(in);
  return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11]};
}

void print_box(const CGAL::Bbox_3& box) {
  xray_form::print_box([&](int k) { return (box.min(k) + box.max(k)) / 2; },
                       [&](int axis, int k) { return k == axis ? (box.max(k) - box.min(k)) / 2 : 0.0; });
}

/// Numbers of a tree's nodes; leaves for single triangles, for which CGAL has no nodes, follow them. CGAL's
/// traversal exposes the nodes below the root; it neither exposes nor tests the root itself.
class Numbers {
 public:
  Numbers(const Tree& tree, const Triangles& triangles) : triangles_(triangles), root_box_(tree.bbox()) {
    nodes_.push_back({});
    tree.traversal(triangles.front(), *this);
    nodes_[0].children = beneath_root_;
  }

  // Interface required of traits by CGAL's traversal. It is passed the root's children, and does not descend.
  bool go_further() const { return true; }
  void intersection(const Triangle&, const Primitive& p) { beneath_root_.push_back(leaf(p)); }
  bool do_intersect(const Triangle&, const Node& node) {
    const std::size_t all = triangles_.size();
    beneath_root_.push_back(add(node, all == 3 ? 2 : beneath_root_.empty() ? all / 2 : all - all / 2));
    return false;
  }

  std::size_t of(const Node& node) const { return numbers_.at(&node); }

  void print() const {
    std::printf("tree %zu\n", nodes_.size() + triangles_.size());
    for (const Entry& e : nodes_) {
      std::printf("node 2 %zu %zu", e.children.at(0), e.children.at(1));
      print_box(e.node == nullptr ? root_box_ : e.node->bbox());
    }
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      std::printf("leaf 1 %zu", i);
      print_box(triangles_[i].bbox());
    }
  }

 private:
  struct Entry {
    const Node* node = nullptr;  ///< null: the root
    std::vector<std::size_t> children;
  };

  /// Adds a node with `count` triangles below it, divided as CGAL does. Returns its number.
  std::size_t add(const Node& node, std::size_t count) {
    const std::size_t number = nodes_.size();
    numbers_[&node] = number;
    nodes_.push_back({&node, {}});
    const std::size_t left = count <= 3 ? leaf(node.left_data()) : add(node.left_child(), count / 2);
    const std::size_t right =
        count == 2 ? leaf(node.right_data()) : add(node.right_child(), count - count / 2);
    nodes_[number].children = {left, right};
    return number;
  }
  /// The tree over n triangles has n - 1 nodes.
  std::size_t leaf(const Primitive& p) const {
    return triangles_.size() - 1 + static_cast<std::size_t>(p.id() - triangles_.cbegin());
  }

  const Triangles& triangles_;
  CGAL::Bbox_3 root_box_;
  std::vector<Entry> nodes_;
  std::vector<std::size_t> beneath_root_;
  std::map<const Node*, std::size_t> numbers_;
};

/// Works like CGAL's Listing_primitive_traits for triangle i of A, and reports each test.
struct Told {
  const Tree& tree;
  const Numbers& numbers;
  const Triangles& triangles;
  std::size_t i, box_tests = 0, leaf_tests = 0;

  bool go_further() const { return true; }
  void intersection(const Triangle& query, const Primitive& primitive) {
    const bool meet = tree.traits().do_intersect_object()(query, primitive);
    std::printf("t %zu %zu %d\n", i, static_cast<std::size_t>(primitive.id() - triangles.cbegin()),
                static_cast<int>(meet));
    ++leaf_tests;
  }
  bool do_intersect(const Triangle& query, const Node& node) {
    const bool meet = tree.traits().do_intersect_object()(query, node.bbox());
    std::printf("b %zu %zu %d\n", i + 1, numbers.of(node), static_cast<int>(meet));
    ++box_tests;
    return meet;
  }
};

void print_flat_tree(const Triangles& triangles) {
  CGAL::Bbox_3 whole;
  for (const Triangle& t : triangles) whole += t.bbox();
  std::printf("tree %zu\nnode %zu", triangles.size() + 1, triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) std::printf(" %zu", i + 1);
  print_box(whole);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::printf("leaf 1 %zu", i);
    print_box(triangles[i].bbox());
  }
}

int run(std::istream& in) {
  const Triangles a = read_triangles(in), b = read_triangles(in);
  if (a.empty() || b.size() < 2) throw xray_form::BadInput();
  Tree tree(b.cbegin(), b.cend());
  tree.build();
  const Numbers numbers(tree, b);
  std::printf("title CGAL %s, AABB_tree\n", CGAL_VERSION_STR);
  print_flat_tree(a);
  numbers.print();
  const auto poses = xray_form::next<int>(in);
  for (int p = 0; p < poses; ++p) {
    const auto pose_a = read_pose(in), pose_b = read_pose(in);
    const auto relative = pose_b.inverse() * pose_a;
    std::printf("pose\n");
    std::size_t box_tests = 0, leaf_tests = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      Told reported{tree, numbers, b, i};
      tree.traversal(a[i].transform(relative), reported);
      box_tests += reported.box_tests;
      leaf_tests += reported.leaf_tests;
    }
    std::printf("end %zu %zu\n", box_tests, leaf_tests);
  }
  return 0;
}

}  // namespace

int main() {
  return xray_form::exit_code_of(run);
}
