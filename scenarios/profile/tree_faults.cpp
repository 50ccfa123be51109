#include "scenarios/profile/tree_faults.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <Eigen/Geometry>

#include <lrbscope/core/strings.hpp>

namespace lrb::profile {
namespace {

using Eigen::Vector3d;

class Finder {
 public:
  Finder(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index)
      : volumes_(volumes), tree_(volumes.tree()), mesh_(mesh), index_(index) {}

  void find_in_graph() {
    find_cycles();
    find_parents();
  }
  void find_in_leaves();
  void find_in_volumes(const NodeMeasures& measures, double tolerance);
  TreeFaults result() {
    for (std::vector<FoundFault>& some : found_)
      std::move(some.begin(), some.end(), std::back_inserter(out_.first));
    return std::move(out_);
  }

 private:
  void add(FoundFault fault) {
    const auto kind = static_cast<std::size_t>(fault.kind);
    ++out_.totals[kind];
    if (found_[kind].size() < TreeFaults::kShown) found_[kind].push_back(std::move(fault));
  }
  void find_cycles();
  void find_parents();
  void search_from(std::uint32_t start);
  bool reached(std::uint32_t node) const { return index_.depth[node] != kNull; }

  const Volumes& volumes_;
  const capture::Tree& tree_;
  const capture::Mesh& mesh_;
  const TreeIndex& index_;
  std::vector<char> closes_cycle_;    ///< by place in Tree::child
  std::vector<char> state_;           ///< by node: 0 not visited, 1 on the path, 2 visited
  std::vector<std::uint32_t> below_;  ///< by node: nodes that the search found first from here
  std::array<std::vector<FoundFault>, kTreeFaults> found_;
  TreeFaults out_;
};

/// Depth-first search with its own stack: an edge to a node of the current path closes a cycle.
void Finder::search_from(std::uint32_t start) {
  struct Open {
    std::uint32_t node, next;  ///< next: place in Tree::child
  };
  std::vector<Open> path = {{start, tree_.first_child[start]}};
  state_[start] = 1;
  while (!path.empty()) {
    Open& top = path.back();
    if (top.next == tree_.first_child[top.node + 1]) {
      state_[top.node] = 2;
      const std::uint32_t nodes = below_[top.node] + 1;
      path.pop_back();
      if (!path.empty()) below_[path.back().node] += nodes;
      continue;
    }
    const std::uint32_t place = top.next++, child = tree_.child[place];
    if (state_[child] == 0) {
      state_[child] = 1;
      path.push_back({child, tree_.first_child[child]});
    } else if (state_[child] == 1) {
      closes_cycle_[place] = 1;
      FoundFault fault{TreeFault::cycle, child};
      const auto from =
          std::find_if(path.rbegin(), path.rend(), [&](const Open& o) { return o.node == child; });
      for (auto i = from.base() - 1; i != path.end() && fault.nodes.size() < TreeFaults::kShown; ++i)
        fault.nodes.push_back(i->node);
      fault.count = static_cast<std::uint64_t>(path.end() - (from.base() - 1));
      add(std::move(fault));
    }
  }
}

void Finder::find_cycles() {
  closes_cycle_.assign(tree_.child.size(), 0);
  state_.assign(tree_.size(), 0);
  below_.assign(tree_.size(), 0);
  std::vector<char> is_child(tree_.size(), 0);
  for (const std::uint32_t c : tree_.child) is_child[c] = 1;
  search_from(0);
  for (std::uint32_t n = 1; n < tree_.size(); ++n) {
    if (is_child[n]) continue;
    search_from(n);
    FoundFault fault{TreeFault::no_parent, n};
    fault.count = below_[n];
    add(std::move(fault));
  }
  // The remaining nodes are below a cycle that is not reached from the root.
  for (std::uint32_t n = 0; n < tree_.size(); ++n)
    if (state_[n] == 0) search_from(n);
}

void Finder::find_parents() {
  std::vector<std::uint32_t> parent(tree_.size(), kNull);
  std::map<std::uint32_t, std::vector<std::uint32_t>> several;
  for (std::uint32_t n = 0; n < tree_.size(); ++n)
    for (std::uint32_t place = tree_.first_child[n]; place < tree_.first_child[n + 1]; ++place) {
      const std::uint32_t child = tree_.child[place];
      if (closes_cycle_[place]) continue;
      if (child != 0 && parent[child] == kNull) {
        parent[child] = n;
        continue;
      }
      std::vector<std::uint32_t>& all = several[child];
      if (all.empty() && child != 0) all.push_back(parent[child]);
      all.push_back(n);
    }
  for (auto& [node, parents] : several) add({TreeFault::two_parents, node, std::move(parents)});
}

void Finder::find_in_leaves() {
  const std::size_t triangles = mesh_.triangles.size();
  std::vector<char> seen(triangles, 0);  // in its first leaf
  for (std::uint32_t n = 0; n < tree_.size(); ++n) {
    if (!reached(n)) continue;
    const auto listed = tree_.triangles(n);
    if (!tree_.is_leaf(n) && !listed.empty()) {
      FoundFault fault{TreeFault::inner_node_with_triangles, n};
      fault.count = listed.size();
      add(std::move(fault));
    }
    if (tree_.is_leaf(n) && listed.empty() && triangles > 0) add({TreeFault::leaf_without_triangles, n});
    for (const std::uint32_t t : listed) {
      if (t >= triangles)
        add({TreeFault::nonexistent_triangle, n, {}, t});
      else if (index_.leaf[t] != n)
        add({TreeFault::triangle_in_two_leaves, n, {index_.leaf[t], n}, t});
      else if (seen[t])
        add({TreeFault::triangle_twice_in_leaf, n, {}, t});
      else
        seen[t] = 1;
    }
  }
  for (std::uint32_t t = 0; t < triangles; ++t)
    if (index_.leaf[t] == kNull) add({TreeFault::triangle_in_no_leaf, kNull, {}, t});
}

void Finder::find_in_volumes(const NodeMeasures& measures, double tolerance) {
  const double diagonal = diagonal_of(mesh_), most = tolerance * diagonal;
  const Subtrees subtrees(tree_, index_, mesh_.triangles.size());
  const auto& order = index_.from_root;
  // From the leaves upward: a volume contains a subtree if it contains volumes that do, and then no corner is
  // tested. This also holds with the tolerance, because distances from convex volumes do not grow outward.
  std::vector<char> contains(tree_.size(), 0), children_do(tree_.size(), 1);
  std::vector<FoundFault> outside;
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    const std::uint32_t n = *i;
    if (measures.empty[n]) {
      add({TreeFault::empty_volume, n});
    } else if (!tree_.is_leaf(n) && children_do[n] && tree_.triangles(n).empty()) {
      contains[n] = 1;
    } else {
      const std::vector<HalfSpace> half = volumes_.half_spaces(n);
      FoundFault fault{TreeFault::corner_outside, n};
      for (const std::uint32_t t : subtrees.triangles_of(n))
        for (std::size_t c = 0; c < 3; ++c) {
          const Vector3d& p = mesh_.vertices[mesh_.triangles[t][c]];
          const bool is_inside =
              !half.empty() && std::all_of(half.begin(), half.end(),
                                           [&](const HalfSpace& h) { return h.normal.dot(p) <= h.offset; });
          if (is_inside) continue;
          const double by = volumes_.outside(n, p);
          if (!(by > most)) continue;
          ++fault.count;
          if (by <= fault.by) continue;
          fault.by = by;
          fault.triangle = t;
          fault.corner = static_cast<int>(c);
          fault.point = p;
        }
      contains[n] = fault.count == 0;
      fault.depth = index_.depth[n];
      fault.by_share = diagonal > 0 ? fault.by / diagonal : 0;
      if (fault.count > 0) outside.push_back(std::move(fault));
    }
    if (const std::uint32_t p = index_.parent[n];
        p != kNull && !(contains[n] && measures.beyond_parent[n] == 0))
      children_do[p] = 0;
  }
  // The worst first.
  std::stable_sort(outside.begin(), outside.end(),
                   [](const FoundFault& x, const FoundFault& y) { return x.by > y.by; });
  for (FoundFault& fault : outside) add(std::move(fault));
}

}  // namespace

std::uint64_t TreeFaults::total() const {
  return std::accumulate(totals.begin(), totals.end(), std::uint64_t{0});
}

TreeFaults find_faults(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index,
                       const NodeMeasures& measures, double tolerance) {
  Finder finder(volumes, mesh, index);
  finder.find_in_graph();
  finder.find_in_leaves();
  finder.find_in_volumes(measures, tolerance);
  return finder.result();
}

std::string text_of(const FoundFault& fault, const capture::Tree& tree, const capture::Mesh& mesh) {
  const auto id = [&](std::uint32_t n) { return std::to_string(tree.id_of(n)); };
  const std::string node = fault.node == kNull ? "" : "node " + id(fault.node);
  const std::string leaf = fault.node == kNull ? "" : "leaf " + id(fault.node);
  const std::string triangle = "triangle " + std::to_string(fault.triangle);
  const auto list = [&](const char* between, const char* last) {
    std::string out;
    for (std::size_t i = 0; i < fault.nodes.size(); ++i)
      out += (i == 0 ? "" : i + 1 == fault.nodes.size() ? last : between) + id(fault.nodes[i]);
    return out;
  };
  switch (fault.kind) {
    case TreeFault::two_parents:
      if (fault.node == 0) return node + ", the root, is a child of " + list(", ", " and of ");
      if (std::all_of(fault.nodes.begin(), fault.nodes.end(),
                      [&](std::uint32_t n) { return n == fault.nodes[0]; }))
        return node + " is " + std::to_string(fault.nodes.size()) + " times a child of node " +
               id(fault.nodes[0]);
      return node + " has " + std::to_string(fault.nodes.size()) + " parents: " + list(", ", " and ");
    case TreeFault::no_parent:
      return node + " has no parent: the root does not reach it" +
             (fault.count == 0 ? std::string() : " nor the " + std::to_string(fault.count) + " below it");
    case TreeFault::cycle:
      return node + " is below itself: " + list(" - ", " - ") +
             (fault.count > fault.nodes.size()
                  ? " and " + std::to_string(fault.count - fault.nodes.size()) + " more"
                  : " - " + id(fault.node));
    case TreeFault::nonexistent_triangle:
      return leaf + " has " + triangle + "; the mesh has " + std::to_string(mesh.triangles.size());
    case TreeFault::triangle_in_two_leaves:
      return triangle + " is in leaf " + list("", " and in leaf ");
    case TreeFault::triangle_twice_in_leaf:
      return triangle + " is twice in " + leaf;
    case TreeFault::triangle_in_no_leaf:
      return triangle + " is in no leaf";
    case TreeFault::corner_outside: {
      const auto number = [](double x) { return io::number_text(x, 6); };
      std::string out = triangle + ", corner " + std::to_string(fault.corner) + " (" +
                        number(fault.point.x()) + ", " + number(fault.point.y()) + ", " +
                        number(fault.point.z()) + "), lies outside " + node + " (depth " +
                        std::to_string(fault.depth) + ") by " + io::number_text(fault.by, 3) + ", " +
                        io::number_text(fault.by_share, 3) + " of the diagonal";
      if (fault.count > 1) out += "; and " + std::to_string(fault.count - 1) + " other corners, by less";
      return out;
    }
    case TreeFault::empty_volume:
      return node +
             " has an empty volume: its greatest numbers are below its least, or its radius is negative";
    case TreeFault::inner_node_with_triangles:
      return node + " has both children and " + std::to_string(fault.count) + " triangles";
    case TreeFault::leaf_without_triangles:
      return leaf + " has no triangles";
  }
  return {};
}

NodeMeasures::NodeMeasures(const Volumes& volumes, const TreeIndex& index) {
  const capture::Tree& tree = volumes.tree();
  area.assign(tree.size(), 0);
  volume = beyond_parent = area;
  empty.assign(tree.size(), 0);
  for (const std::uint32_t n : index.from_root) {
    if (tree.volume == capture::VolumeKind::kdop) {
      const Polytope solid = volumes.polytope(n);
      area[n] = solid.area;
      volume[n] = solid.volume;
      empty[n] = solid.corners.empty();
    } else {
      area[n] = volumes.area(n);
      volume[n] = volumes.volume(n);
      empty[n] = volumes.empty(n);
    }
    if (const std::uint32_t p = index.parent[n]; p != kNull && !empty[n] && !empty[p])
      beyond_parent[n] = volumes.excess(n, p);
  }
}

Subtrees::Subtrees(const capture::Tree& tree, const TreeIndex& index, std::size_t triangle_count)
    : position(tree.size(), kNull),
      end(tree.size(), 0),
      first_triangle(tree.size(), 0),
      last_triangle(tree.size(), 0) {
  // Numbers of nodes by subtree, from the leaves upward; then the places in preorder, from the root downward.
  std::vector<std::uint32_t> nodes(tree.size(), 1);
  for (auto i = index.from_root.rbegin(); i != index.from_root.rend(); ++i)
    if (index.parent[*i] != kNull) nodes[index.parent[*i]] += nodes[*i];
  std::vector<std::uint32_t> next(tree.size(), 0);  // place of the next child's subtree
  for (const std::uint32_t n : index.from_root) {
    const std::uint32_t parent = index.parent[n];
    position[n] = parent == kNull ? 0 : next[parent];
    if (parent != kNull) next[parent] += nodes[n];
    next[n] = position[n] + 1;
    end[n] = position[n] + nodes[n];
  }
  std::vector<std::uint32_t> preorder(index.from_root.size());
  for (const std::uint32_t n : index.from_root) preorder[position[n]] = n;
  for (const std::uint32_t n : preorder) {
    first_triangle[n] = static_cast<std::uint32_t>(triangles.size());
    for (const std::uint32_t t : tree.triangles(n))
      if (t < triangle_count) triangles.push_back(t);
    last_triangle[n] = static_cast<std::uint32_t>(triangles.size());
  }
  for (auto i = preorder.rbegin(); i != preorder.rend(); ++i)
    if (const std::uint32_t p = index.parent[*i]; p != kNull)
      last_triangle[p] = std::max(last_triangle[p], last_triangle[*i]);
}

double diagonal_of(const capture::Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace lrb::profile
