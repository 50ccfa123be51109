#include "scenarios/profile/tree_faults.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "scenarios/profile/tree_report.hpp"
#include <lrbscope/core/strings.hpp>

namespace lrb::profile {

NodeMeasures::NodeMeasures(const Volumes& volumes, const TreeIndex& index) {
  const capture::Tree& tree = volumes.tree();
  area.assign(tree.size(), 0);
  volume = beyond_parent = area;
  empty.assign(tree.size(), 0);
  for (const std::uint32_t n : index.from_root) {
    const VolumeSize size = volumes.size(n);
    area[n] = size.area;
    volume[n] = size.volume;
    empty[n] = size.is_empty;
    if (const std::uint32_t p = index.parent[n]; p != kNull && !empty[n] && !empty[p])
      beyond_parent[n] = volumes.excess(n, p);
  }
}

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
  void find_in_parts(const NodeMeasures& measures, double tolerance);
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
  std::vector<std::uint32_t> last(triangles, kNull);  // by triangle: the last leaf that has it
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
      else if (index_.leaf[t] != n && !tree_.splits)
        add({TreeFault::triangle_in_two_leaves, n, {index_.leaf[t], n}, t});
      else if (last[t] == n)
        add({TreeFault::triangle_twice_in_leaf, n, {}, t});
      else
        last[t] = n;
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
          const bool is_inside = !half.empty() && std::ranges::all_of(half, [&](const HalfSpace& h) {
            return h.normal.dot(p) <= h.offset;
          });
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
  std::ranges::stable_sort(outside, [](const FoundFault& x, const FoundFault& y) { return x.by > y.by; });
  for (FoundFault& fault : outside) add(std::move(fault));
}

/// A traversal reaches a point of a triangle through a leaf if all volumes from the root to the leaf contain
/// it. Cuts the part that lies in them off the triangle, for one leaf after the other, until nothing is left.
void Finder::find_in_parts(const NodeMeasures& measures, double tolerance) {
  using Polygon = std::vector<Vector3d>;
  const double most = std::max(tolerance, 1e-12) * diagonal_of(mesh_);
  std::vector<std::vector<HalfSpace>> sides(tree_.size());  // of the volumes, larger by the tolerance
  std::vector<HalfSpace> around;                            // those of a leaf and of the nodes above it
  for (const std::uint32_t n : index_.from_root) {
    if (measures.empty[n]) add({TreeFault::empty_volume, n});
    sides[n] = volumes_.half_spaces(n);
    for (HalfSpace& side : sides[n]) side.offset += most;
  }
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (index_.leaf[t] == kNull) continue;
    const std::array<Vector3d, 3> corners = corners_of(mesh_, t);
    const Polygon all(corners.begin(), corners.end());
    const double area = area_of(all);
    std::vector<Polygon> left = {all}, outside;
    index_.for_each_leaf(t, [&](std::uint32_t leaf) {
      around.clear();
      for (std::uint32_t n = leaf; n != kNull; n = index_.parent[n])
        around.insert(around.end(), sides[n].begin(), sides[n].end());
      outside.clear();
      for (Polygon& part : left) {
        // A part that is beyond one side is not cut up.
        const bool is_beyond = std::ranges::any_of(around, [&](const HalfSpace& side) {
          return std::ranges::all_of(part,
                                     [&](const Vector3d& p) { return side.normal.dot(p) > side.offset; });
        });
        if (is_beyond) {
          outside.push_back(std::move(part));
          continue;
        }
        for (const HalfSpace& side : around) {
          Polygon beyond = part;
          clip(beyond, {-side.normal, -side.offset});
          if (area_of(beyond) > 0) outside.push_back(std::move(beyond));
          clip(part, side);
        }
      }
      left.swap(outside);
    });
    if (left.empty()) continue;
    FoundFault fault{TreeFault::part_outside, index_.leaf[t], {}, t};
    const Polygon& largest = *std::ranges::max_element(left, {}, area_of);
    fault.point = std::accumulate(largest.begin(), largest.end(), Vector3d(0, 0, 0)) /
                  static_cast<double>(largest.size());
    for (const Polygon& part : left) fault.by += area_of(part);
    fault.by_share = fault.by / area;
    add(std::move(fault));
  }
}

}  // namespace

TreeFaults find_faults(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index,
                       const NodeMeasures& measures, double tolerance) {
  Finder finder(volumes, mesh, index);
  finder.find_in_graph();
  finder.find_in_leaves();
  if (volumes.tree().splits)
    finder.find_in_parts(measures, tolerance);
  else
    finder.find_in_volumes(measures, tolerance);
  return finder.result();
}

std::uint64_t TreeFaults::total() const {
  return std::accumulate(totals.begin(), totals.end(), std::uint64_t{0});
}

std::string text_of(const FoundFault& fault, const capture::Tree& tree, const capture::Mesh& mesh) {
  const auto id = [&](std::uint32_t n) { return tree.name_of_node(n); };
  const std::string node = fault.node == kNull ? "" : "node " + id(fault.node);
  const std::string leaf = fault.node == kNull ? "" : "leaf " + id(fault.node);
  const std::string triangle = "triangle " + tree.name_of_triangle(fault.triangle);
  const auto list = [&](const char* between, const char* last) {
    std::string out;
    for (std::size_t i = 0; i < fault.nodes.size(); ++i)
      out += (i == 0 ? "" : i + 1 == fault.nodes.size() ? last : between) + id(fault.nodes[i]);
    return out;
  };
  switch (fault.kind) {
    case TreeFault::two_parents:
      if (fault.node == 0) return node + ", the root, is a child of " + list(", ", " and of ");
      if (std::ranges::all_of(fault.nodes, [&](std::uint32_t n) { return n == fault.nodes[0]; }))
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
    case TreeFault::part_outside: {
      const auto number = [](double x) { return io::number_text(x, 6); };
      return "a part of " + triangle + " around (" + number(fault.point.x()) + ", " +
             number(fault.point.y()) + ", " + number(fault.point.z()) + "), " +
             io::number_text(fault.by_share, 3) + " of its area, lies in the volumes of none of its leaves";
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

}  // namespace lrb::profile
