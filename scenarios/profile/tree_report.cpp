#include "scenarios/profile/tree_report.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::profile {

Subtrees::Subtrees(const capture::Tree& tree, const TreeIndex& index, std::size_t triangle_count)
    : position(tree.size(), kNull),
      end(tree.size(), 0),
      first_triangle(tree.size(), 0),
      last_triangle(tree.size(), 0) {
  // Numbers of nodes by subtree, from the leaves upward; then the places in preorder, from the root downward.
  std::vector<std::uint32_t> count(tree.size(), 1);
  for (auto i = index.from_root.rbegin(); i != index.from_root.rend(); ++i)
    if (index.parent[*i] != kNull) count[index.parent[*i]] += count[*i];
  std::vector<std::uint32_t> next(tree.size(), 0);  // place of the next child's subtree
  for (const std::uint32_t n : index.from_root) {
    const std::uint32_t parent = index.parent[n];
    position[n] = parent == kNull ? 0 : next[parent];
    if (parent != kNull) next[parent] += count[n];
    next[n] = position[n] + 1;
    end[n] = position[n] + count[n];
  }
  nodes.resize(index.from_root.size());
  for (const std::uint32_t n : index.from_root) nodes[position[n]] = n;
  for (const std::uint32_t n : nodes) {
    first_triangle[n] = static_cast<std::uint32_t>(triangles.size());
    for (const std::uint32_t t : tree.triangles(n))
      if (t < triangle_count) triangles.push_back(t);
    last_triangle[n] = static_cast<std::uint32_t>(triangles.size());
  }
  for (auto i = nodes.rbegin(); i != nodes.rend(); ++i)
    if (const std::uint32_t p = index.parent[*i]; p != kNull)
      last_triangle[p] = std::max(last_triangle[p], last_triangle[*i]);
}

double diagonal_of(const capture::Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

namespace {

using capture::VolumeKind;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::size_t kWorst = 10;

AlignedBox3d coordinate_box(const trace::ShapeBox& box) {
  const Vector3d reach = box.half[0].cwiseAbs() + box.half[1].cwiseAbs() + box.half[2].cwiseAbs();
  return {box.centre - reach, box.centre + reach};
}

double triangle_area(const std::array<Vector3d, 3>& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
}

/// Finds the nodes whose volumes contain parts of the surface. A child need not lie in its parent's volume,
/// so that a branch is left out only if the box of all its volumes is missed.
class Surface {
 public:
  Surface(const Volumes& of_nodes, const capture::Mesh& of_mesh, const TreeIndex& of_tree)
      : volumes(of_nodes),
        tree(of_nodes.tree()),
        mesh(of_mesh),
        index(of_tree),
        subtrees(tree, index, mesh.triangles.size()),
        slack(kSlack * diagonal_of(mesh)),
        cost(tree.size(), 0),
        reach_(tree.size()) {
    for (auto i = index.from_root.rbegin(); i != index.from_root.rend(); ++i) {
      const std::uint32_t n = *i;
      reach_[n].extend(coordinate_box(volumes.box(n)));
      if (const std::uint32_t p = index.parent[n]; p != kNull) reach_[p].extend(reach_[n]);
      cost[n] = tree.is_leaf(n) ? kTriangleCost * static_cast<double>(tree.triangles(n).size()) : kInnerCost;
    }
    for (AlignedBox3d& box : reach_)
      if (!box.isEmpty()) box = AlignedBox3d(box.min().array() - slack, box.max().array() + slack);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      area += triangle_area(corners_of(mesh, t));
      area_up_to.push_back(area);
    }
  }

  /// Calls `at` with each node other than the triangle's own whose branch the box may touch. Returns the
  /// number of nodes looked at.
  template <class At>
  std::uint64_t visit(std::uint32_t triangle, const AlignedBox3d& box, const At& at) const {
    std::uint64_t looked = 0;
    for (std::uint32_t i = 0; i < subtrees.nodes.size(); ++looked) {
      const std::uint32_t n = subtrees.nodes[i];
      const bool is_near = reach_[n].intersects(box);
      if (is_near) {
        bool is_own = false;
        index.for_each_leaf(triangle,
                            [&](std::uint32_t leaf) { is_own = is_own || subtrees.contains(n, leaf); });
        if (!is_own) at(n);
      }
      i = is_near ? i + 1 : subtrees.end[n];
    }
    return looked;
  }

  /// Surfaces that lie in the side of a flat volume belong to it, whatever rounding errors say.
  static constexpr double kSlack = 1e-9;  // relative to the mesh's diagonal

  const Volumes& volumes;
  const capture::Tree& tree;
  const capture::Mesh& mesh;
  const TreeIndex& index;
  const Subtrees subtrees;
  const double slack;
  std::vector<double> cost;  ///< by node
  double area = 0;
  std::vector<double> area_up_to;  ///< by triangle: area of those up to it, inclusive

 private:
  std::vector<AlignedBox3d> reach_;  ///< by node: box of all volumes below
};

SiblingFigures siblings_of(const Volumes& volumes, const TreeIndex& index, std::span<const double> volume) {
  SiblingFigures out;
  const capture::Tree& tree = volumes.tree();
  double shared = 0;
  std::uint64_t measured = 0;
  for (const std::uint32_t n : index.from_root) {
    const auto children = tree.children(n);
    if (children.size() > SiblingFigures::kMaxChildren) {
      ++out.nodes_left_out;
      continue;
    }
    for (std::size_t i = 0; i < children.size(); ++i)
      for (std::size_t j = i + 1; j < children.size(); ++j) {
        ++out.pairs;
        const bool met = overlap(volumes, children[i], {}, volumes, children[j], {});
        out.overlapping += met;
        const double smaller = std::min(volume[children[i]], volume[children[j]]);
        if (!(smaller > 0) || tree.volume == VolumeKind::rss) continue;
        ++measured;
        if (met) shared += std::min(1.0, *volumes.shared_volume(children[i], children[j]) / smaller);
      }
  }
  if (measured > 0) out.shared = shared / static_cast<double>(measured);
  return out;
}

std::optional<LoosenessFigures> looseness_of(const Volumes& volumes, const capture::Mesh& mesh,
                                             const TreeIndex& index, std::span<const double> volume) {
  constexpr double kFlat = 1e-9;  // extents below this share of the node's largest are rounding errors
  const Subtrees subtrees(volumes.tree(), index, mesh.triangles.size());
  std::vector<std::pair<double, std::uint32_t>> all;
  for (const std::uint32_t n : index.from_root) {
    const trace::ShapeBox box = volumes.box(n);
    Eigen::Matrix3d axes;  // rows
    bool is_flat = false;
    for (int k = 0; k < 3; ++k) {
      const Vector3d& half = box.half[static_cast<std::size_t>(k)];
      is_flat = is_flat || half.isZero(0);
      axes.row(k) = half.stableNormalized();
    }
    if (is_flat) continue;
    AlignedBox3d tight;
    for (const std::uint32_t t : subtrees.triangles_of(n))
      for (const std::uint32_t v : mesh.triangles[t]) tight.extend(axes * (mesh.vertices[v] - box.centre));
    if (tight.isEmpty() || tight.sizes().minCoeff() <= kFlat * tight.sizes().maxCoeff()) continue;
    all.emplace_back(volume[n] / tight.volume(), n);
  }
  if (all.empty()) return {};
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))].first;
  };
  constexpr double kMedian = 0.5, kP90 = 0.9;
  return LoosenessFigures{at(kMedian), at(kP90), all.back().first, all.back().second};
}

/// Returns the ten nodes with the largest positive EPO, the largest first.
std::vector<NodeFigures> worst_of(const std::vector<NodeFigures>& nodes) {
  std::vector<NodeFigures> out;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(out),
               [](const NodeFigures& n) { return n.epo > 0; });
  const auto end = out.begin() + static_cast<std::ptrdiff_t>(std::min(kWorst, out.size()));
  std::partial_sort(out.begin(), end, out.end(), [](const NodeFigures& x, const NodeFigures& y) {
    return x.epo != y.epo ? x.epo > y.epo : x.node < y.node;
  });
  out.erase(end, out.end());
  return out;
}

}  // namespace

std::optional<Epo> sample_epo(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index,
                              std::uint64_t samples, std::uint64_t seed) {
  constexpr std::uint64_t kMaxTests = 30'000'000, kFewest = 100;
  const Surface surface(volumes, mesh, index);
  if (!(surface.area > 0)) return {};
  Epo out;
  out.by_node.assign(volumes.tree().size(), 0);
  Random random(seed);
  double sum = 0, sum_of_squares = 0;
  for (std::uint64_t tests = 0; out.samples < samples && (tests < kMaxTests || out.samples < kFewest);
       ++out.samples) {
    // A triangle by area, and a point of it.
    const auto place = std::upper_bound(surface.area_up_to.begin(), surface.area_up_to.end() - 1,
                                        random.in(0, surface.area));
    const auto triangle = static_cast<std::uint32_t>(place - surface.area_up_to.begin());
    const auto [x, y, z] = corners_of(mesh, triangle);
    double s = random.in(0, 1), t = random.in(0, 1);
    if (s + t > 1) s = 1 - s, t = 1 - t;
    const Vector3d p = x + s * (y - x) + t * (z - x);
    double current = 0;
    tests += surface.visit(triangle, AlignedBox3d(p, p), [&](std::uint32_t n) {
      if (volumes.outside(n, p) > surface.slack) return;
      current += surface.cost[n];
      out.by_node[n] += surface.cost[n];
    });
    sum += current;
    sum_of_squares += current * current;
  }
  const auto count = static_cast<double>(out.samples);
  out.value = sum / count;
  if (count > 1)
    out.error = std::sqrt(std::max(0.0, sum_of_squares / count - out.value * out.value) / (count - 1));
  for (double& of_node : out.by_node) of_node /= count;
  return out;
}

std::optional<Epo> exact_epo(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index) {
  if (volumes.tree().volume == VolumeKind::sphere || volumes.tree().volume == VolumeKind::rss) return {};
  const Surface surface(volumes, mesh, index);
  if (!(surface.area > 0)) return {};
  std::vector<std::vector<HalfSpace>> half(volumes.tree().size());
  for (const std::uint32_t n : index.from_root) {
    half[n] = volumes.half_spaces(n);
    for (HalfSpace& h : half[n]) h.offset += surface.slack;
  }
  Epo out;
  out.by_node.assign(volumes.tree().size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = corners_of(mesh, t);
    AlignedBox3d box;
    for (const Vector3d& p : corners) box.extend(p);
    surface.visit(t, box, [&](std::uint32_t n) {
      std::vector<Vector3d> polygon(corners.begin(), corners.end());
      for (const HalfSpace& h : half[n]) {
        clip(polygon, h);
        if (polygon.empty()) return;
      }
      out.by_node[n] += surface.cost[n] * area_of(polygon) / surface.area;
    });
  }
  out.value = std::accumulate(out.by_node.begin(), out.by_node.end(), 0.0);
  return out;
}

std::optional<double> TreeFigures::sah() const {
  if (!sah_inner) return {};
  return kInnerCost * *sah_inner + kTriangleCost * *sah_leaves;
}

TreeFaults faults_of(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index) {
  return find_faults(volumes, mesh, index, NodeMeasures(volumes, index), TreeOptions{}.tolerance);
}

TreeReport report_tree(const capture::Tree& tree, const capture::Mesh& mesh, const TreeOptions& options) {
  if (tree.first_child.size() < 2)
    throw InputError("tree " + std::to_string(tree.id) +
                     ": expected nodes, found none; report its root at least");
  const Volumes volumes(tree);
  const TreeIndex index(tree, mesh.triangles.size());
  TreeReport out;
  TreeFigures& f = out.figures;
  f.nodes = static_cast<std::uint32_t>(tree.size());
  f.unreached = static_cast<std::uint32_t>(tree.size() - index.from_root.size());
  f.volume_bytes = tree.volumes.size() * sizeof(double);

  const double diagonal = diagonal_of(mesh);
  const NodeMeasures measures(volumes, index);
  for (const std::uint32_t n : index.from_root) {
    const std::uint32_t parent = index.parent[n];
    if (parent == kNull || measures.empty[n] || measures.empty[parent]) continue;
    ++f.beyond.of;
    if (measures.beyond_parent[n] <= options.tolerance * diagonal) continue;
    ++f.beyond.count;
    if (diagonal > 0 && measures.beyond_parent[n] / diagonal > f.beyond.share) {
      f.beyond.share = measures.beyond_parent[n] / diagonal;
      f.beyond.node = n;
    }
  }
  out.faults = find_faults(volumes, mesh, index, measures, options.tolerance);

  if (options.exact) f.epo = exact_epo(volumes, mesh, index);
  if (!f.epo) f.epo = sample_epo(volumes, mesh, index, options.samples, options.seed);

  // Sums over nodes, by depth.
  std::vector<NodeFigures> nodes;
  const double root_area = measures.area[0];
  double inner = 0, leaves = 0, leaf_depths = 0;
  for (const std::uint32_t n : index.from_root) {
    NodeFigures node{n, index.depth[n], index.triangles_below[n]};
    if (root_area > 0) node.area = measures.area[n] / root_area;
    if (f.epo) node.epo = f.epo->by_node[n];
    nodes.push_back(node);
    f.depth = std::max(f.depth, node.depth);
    if (node.depth >= f.by_depth.size()) f.by_depth.resize(node.depth + std::size_t{1});
    DepthFigures& d = f.by_depth[node.depth];
    ++d.nodes;
    d.area += node.area;
    d.epo += node.epo;
    if (!tree.is_leaf(n)) {
      inner += node.area;
      continue;
    }
    const std::size_t size = tree.triangles(n).size();
    ++f.leaves;
    ++d.leaves;
    ++f.leaf_sizes[size];
    leaf_depths += node.depth;
    leaves += node.area * static_cast<double>(size);
  }
  if (f.leaves > 0) f.mean_depth = leaf_depths / f.leaves;
  if (root_area > 0) f.sah_inner = inner, f.sah_leaves = leaves;
  f.worst = worst_of(nodes);
  f.siblings = siblings_of(volumes, index, measures.volume);
  f.looseness = looseness_of(volumes, mesh, index, measures.volume);
  f.area = measures.area;
  return out;
}

OwnTree own_tree(const LrbRep& rep, const trace::TreeShape& shape) {
  OwnTree out;
  out.mesh.name = rep.name();
  out.mesh.vertices.assign(rep.vertices().begin(), rep.vertices().end());
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    std::array<VertexId, 3> corners{};
    rep.simplex(s, corners.data());
    if (rep.simplex_size() == 2) corners[2] = corners[1];
    out.mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  out.tree.volume = VolumeKind::obb;
  out.tree.first_child = out.tree.first_triangle = {0};
  for (std::uint32_t n = 0; n < shape.size(); ++n) {
    const auto children = shape.children(n);
    out.tree.child.insert(out.tree.child.end(), children.begin(), children.end());
    out.tree.first_child.push_back(static_cast<std::uint32_t>(out.tree.child.size()));
    for (const SimplexId s : shape.simplices(n)) out.tree.triangle.push_back(s);
    out.tree.first_triangle.push_back(static_cast<std::uint32_t>(out.tree.triangle.size()));
    const trace::ShapeBox& box = shape.box(n);
    for (const Vector3d& v : {box.centre, box.half[0], box.half[1], box.half[2]})
      out.tree.volumes.insert(out.tree.volumes.end(), v.data(), v.data() + 3);
  }
  return out;
}

}  // namespace lrb::profile
