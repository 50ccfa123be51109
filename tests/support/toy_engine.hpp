#pragma once
/// A collision engine of a few lines that fills a capture: trees of AABBs split in the median, exact tests of
/// triangles. Poses must be translations.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <lrbscope/contact.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::test {

/// Returns a mesh of triangles as an engine would describe it.
inline capture::Mesh captured(const Mesh& mesh, std::string name = "body") {
  capture::Mesh out;
  out.name = std::move(name);
  out.vertices = mesh.vertices;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    out.triangles.push_back({corners[0].value(), corners[1].value(), corners[2].value()});
  }
  return out;
}

class ToyEngine {
 public:
  explicit ToyEngine(std::string name = "Toy 1.0") { capture.engine = std::move(name); }

  capture::Capture capture;
  /// Changes the result of a test of two triangles; empty: none.
  std::function<bool(std::uint32_t a, std::uint32_t b, bool meets)> wrong;

  /// Adds a mesh with its tree, and returns the tree's index.
  std::uint32_t add(capture::Mesh mesh, std::size_t leaf_size = 2) {
    const auto index = static_cast<std::uint32_t>(capture.meshes.size());
    capture.meshes.push_back(std::move(mesh));
    capture::Tree tree;
    tree.mesh = index;
    tree.id = index + 1;
    std::vector<std::uint32_t> all(capture.meshes.back().triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    std::vector<Node> nodes;
    build(capture.meshes.back(), all, leaf_size, nodes);
    tree.first_child = tree.first_triangle = {0};
    for (const Node& node : nodes) {
      tree.child.insert(tree.child.end(), node.children.begin(), node.children.end());
      tree.triangle.insert(tree.triangle.end(), node.triangles.begin(), node.triangles.end());
      tree.first_child.push_back(static_cast<std::uint32_t>(tree.child.size()));
      tree.first_triangle.push_back(static_cast<std::uint32_t>(tree.triangle.size()));
      tree.volumes.insert(tree.volumes.end(), node.low.data(), node.low.data() + 3);
      tree.volumes.insert(tree.volumes.end(), node.high.data(), node.high.data() + 3);
    }
    capture.trees.push_back(std::move(tree));
    return static_cast<std::uint32_t>(capture.trees.size() - 1);
  }

  /// Performs a query with B at a translation, and returns the number of pairs found.
  std::uint64_t query(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& translation,
                      capture::QueryKind kind = capture::QueryKind::all_pairs) {
    capture::Query q;
    q.number = static_cast<std::uint32_t>(capture.queries.size() + 1);
    q.kind = kind;
    q.trees = {a, b};
    q.poses[1] = Pose::translation(translation);
    q.begin_ns = 1000.0 * q.number;
    q.duration_ns = 500;
    q.ended = true;
    walk(q, 0, 0, translation);
    q.verdict = q.pairs > 0 ? capture::Verdict::intersecting : capture::Verdict::separate;
    q.events_seen = q.events.size();
    q.parts = {{0, 0, q.events.size()}};
    capture.queries.push_back(std::move(q));
    return capture.queries.back().pairs;
  }

 private:
  struct Node {
    std::vector<std::uint32_t> children, triangles;
    Eigen::Vector3d low, high;
  };

  static std::uint32_t build(const capture::Mesh& mesh, std::vector<std::uint32_t> triangles,
                             std::size_t leaf_size, std::vector<Node>& nodes) {
    const auto number = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back();
    Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL), high = -low;
    for (const std::uint32_t t : triangles)
      for (const std::uint32_t v : mesh.triangles[t])
        low = low.cwiseMin(mesh.vertices[v]), high = high.cwiseMax(mesh.vertices[v]);
    nodes[number].low = low, nodes[number].high = high;
    if (triangles.size() <= leaf_size) {
      nodes[number].triangles = triangles;
      return number;
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const auto key = [&](std::uint32_t t) {
      const auto& c = mesh.triangles[t];
      return mesh.vertices[c[0]][axis] + mesh.vertices[c[1]][axis] + mesh.vertices[c[2]][axis];
    };
    std::stable_sort(triangles.begin(), triangles.end(),
                     [&](std::uint32_t x, std::uint32_t y) { return key(x) < key(y); });
    const auto median = triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2);
    const std::uint32_t left = build(mesh, {triangles.begin(), median}, leaf_size, nodes);
    const std::uint32_t right = build(mesh, {median, triangles.end()}, leaf_size, nodes);
    nodes[number].children = {left, right};
    return number;
  }

  void walk(capture::Query& q, std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& by) const {
    const capture::Tree &tree_a = capture.trees[q.trees[0]], &tree_b = capture.trees[q.trees[1]];
    const auto volume_a = tree_a.volume_of(a), volume_b = tree_b.volume_of(b);
    std::uint8_t axis = capture::kNoAxis;
    for (std::uint8_t k = 0; k < 3; ++k)
      if (volume_a[k] > volume_b[k + 3u] + by[k] || volume_b[k] + by[k] > volume_a[k + 3u]) axis = k;
    const bool met = axis == capture::kNoAxis;
    q.events.push_back({a, b, capture::EventKind::nodes, static_cast<std::uint8_t>(met), 1, axis});
    if (!met) return;
    if (tree_a.is_leaf(a) && tree_b.is_leaf(b)) return leaves(q, a, b, by);
    const bool opens_a = !tree_a.is_leaf(a) && (tree_b.is_leaf(b) || a <= b);
    if (opens_a)
      for (const std::uint32_t child : tree_a.children(a)) walk(q, child, b, by);
    else
      for (const std::uint32_t child : tree_b.children(b)) walk(q, a, child, by);
  }

  void leaves(capture::Query& q, std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& by) const {
    const capture::Tree &tree_a = capture.trees[q.trees[0]], &tree_b = capture.trees[q.trees[1]];
    for (const std::uint32_t s : tree_a.triangles(a))
      for (const std::uint32_t t : tree_b.triangles(b)) {
        bool meets = meet(capture.meshes[tree_a.mesh], s, capture.meshes[tree_b.mesh], t, by);
        if (wrong) meets = wrong(s, t, meets);
        q.events.push_back(
            {s, t, capture::EventKind::triangles, static_cast<std::uint8_t>(meets), 1, capture::kNoAxis});
        q.pairs += meets;
      }
  }

 public:
  /// Returns true if two triangles have a common point: exact.
  static bool meet(const capture::Mesh& a, std::uint32_t s, const capture::Mesh& b, std::uint32_t t,
                   const Eigen::Vector3d& by) {
    std::array<Eigen::Vector3d, 3> x, y;
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = a.vertices[a.triangles[s][k]], y[k] = b.vertices[b.triangles[t][k]] + by;
    const double* const p[3] = {x[0].data(), x[1].data(), x[2].data()};
    const double* const r[3] = {y[0].data(), y[1].data(), y[2].data()};
    return exact::meet_triangles(p, r) != exact::Meet::disjoint;
  }
};

}  // namespace lrb::test
