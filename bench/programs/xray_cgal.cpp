/// lrbscope-xray-cgal: like lrbscope-xray-fcl, for CGAL's AABB_tree (xray_form.hpp: input and output).
/// Queries the tree over B's triangles with each triangle of A, transformed to B's frame. The traits work
/// like CGAL's own and report each test. A's tree is a root with a leaf for each triangle. A separate
/// program, because CGAL's licence is the GPL.
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

Triangles triangles_of(const xray_form::Triangles& t) {
  std::vector<Point> points;
  for (const auto& v : t.vertices) points.emplace_back(v[0], v[1], v[2]);
  Triangles out;
  for (const auto& c : t.corners) out.emplace_back(points[c[0]], points[c[1]], points[c[2]]);
  return out;
}

Kernel::Aff_transformation_3 transform_of(const std::array<double, 12>& m) {
  return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11]};
}

using Indices = std::vector<std::uint32_t>;

std::array<double, 6> numbers_of(const CGAL::Bbox_3& box) {
  return {box.min(0), box.min(1), box.min(2), box.max(0), box.max(1), box.max(2)};
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

  void add_to(xray_form::TreeNodes& out) const {
    for (const Entry& e : nodes_) {
      const CGAL::Bbox_3 box = e.node == nullptr ? root_box_ : e.node->bbox();
      out.add(Indices(e.children.begin(), e.children.end()), Indices{}, numbers_of(box));
    }
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      out.add(Indices{}, Indices{static_cast<std::uint32_t>(i)}, numbers_of(triangles_[i].bbox()));
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
struct Reporter {
  const Tree& tree;
  const Numbers& numbers;
  const Triangles& triangles;
  std::size_t i, box_tests = 0, leaf_tests = 0, pairs = 0;

  bool go_further() const { return true; }
  void intersection(const Triangle& query, const Primitive& primitive) {
    const bool meet = tree.traits().do_intersect_object()(query, primitive);
    LRBCAP_PRIM(i, primitive.id() - triangles.cbegin(), meet);
    ++leaf_tests;
    pairs += meet;
  }
  bool do_intersect(const Triangle& query, const Node& node) {
    const bool meet = tree.traits().do_intersect_object()(query, node.bbox());
    LRBCAP_NODE(i + 1, numbers.of(node), meet, LRBCAP_NO_AXIS);
    ++box_tests;
    return meet;
  }
};

/// The tree of A: a root with a leaf for each triangle.
std::uint32_t capture_flat_tree(const Triangles& triangles, std::uint32_t mesh) {
  xray_form::TreeNodes nodes(LRBCAP_AABB);
  CGAL::Bbox_3 whole;
  for (const Triangle& t : triangles) whole += t.bbox();
  Indices all;
  for (std::size_t i = 0; i < triangles.size(); ++i) all.push_back(static_cast<std::uint32_t>(i + 1));
  nodes.add(all, Indices{}, numbers_of(whole));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    nodes.add(Indices{}, Indices{static_cast<std::uint32_t>(i)}, numbers_of(triangles[i].bbox()));
  return nodes.capture(mesh);
}

void run(std::istream& in, const char* file) {
  const xray_form::Triangles given[] = {xray_form::read_triangles(in), xray_form::read_triangles(in)};
  const Triangles a = triangles_of(given[0]), b = triangles_of(given[1]);
  if (a.empty() || b.size() < 2) throw xray_form::BadInput();
  Tree tree(b.cbegin(), b.cend());
  tree.build();
  const Numbers numbers(tree, b);
  LRBCAP_OPEN("CGAL " CGAL_VERSION_STR ", AABB_tree", file);
  const std::uint32_t tree_a = capture_flat_tree(a, xray_form::capture_mesh(given[0], "A"));
  xray_form::TreeNodes nodes(LRBCAP_AABB);
  numbers.add_to(nodes);
  const std::uint32_t tree_b = nodes.capture(xray_form::capture_mesh(given[1], "B"));
  const std::uint32_t volume_tests = LRBCAP_NAME("box tests"), leaf_tests = LRBCAP_NAME("triangle tests");
  const auto poses = xray_form::next<int>(in);
  for (int p = 0; p < poses; ++p) {
    const auto pose_a = xray_form::next_numbers<12, double>(in);
    const auto pose_b = xray_form::next_numbers<12, double>(in);
    const auto relative = transform_of(pose_b).inverse() * transform_of(pose_a);
    std::size_t box_count = 0, leaf_count = 0, pairs = 0;
    LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, tree_a, pose_a.data(), tree_b, pose_b.data());
    for (std::size_t i = 0; i < a.size(); ++i) {
      Reporter reported{tree, numbers, b, i};
      tree.traversal(a[i].transform(relative), reported);
      box_count += reported.box_tests;
      leaf_count += reported.leaf_tests;
      pairs += reported.pairs;
    }
    LRBCAP_COUNT(volume_tests, box_count);
    LRBCAP_COUNT(leaf_tests, leaf_count);
    LRBCAP_END(pairs > 0 ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, pairs);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return xray_form::exit_code_of(argc, argv, run);
}
