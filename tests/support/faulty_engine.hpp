#pragma once
/// A small collision engine whose queries are captured in memory, with faults on request.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "scenarios/profile/query_walk.hpp"
#include "scenarios/profile/volumes.hpp"
#include "tests/support/captured_trees.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::test {

using NumberPair = std::array<std::uint32_t, 2>;

enum class OpeningOrder : std::uint8_t { a_first, b_first, larger, both };

struct FaultyQuery {
  capture::QueryKind kind = capture::QueryKind::all_pairs;
  OpeningOrder order = OpeningOrder::larger;
  bool wide = false;  ///< compare all children, and visit pairs of children that overlap
  double reach = 0;   ///< volumes up to this far apart pass for overlapping
  // Faults.
  std::set<NumberPair> lies = {};            ///< pairs of triangles whose test gives the opposite answer
  std::optional<NumberPair> forgetful = {};  ///< a pair of nodes whose last pair of children is not visited
};

/// The exact test of two triangles in the world.
inline bool triangles_meet(const capture::Mesh& a, std::uint32_t f, const Pose& pose_a,
                           const capture::Mesh& b, std::uint32_t g, const Pose& pose_b) {
  Eigen::Vector3d corners[2][3];
  const double* points[2][3];
  for (std::size_t i = 0; i < 3; ++i) {
    corners[0][i] = pose_a.apply(a.vertices[a.triangles[f][i]]);
    corners[1][i] = pose_b.apply(b.vertices[b.triangles[g][i]]);
    for (std::size_t side = 0; side < 2; ++side) points[side][i] = corners[side][i].data();
  }
  return exact::meet_triangles(points[0], points[1]) != exact::Meet::disjoint;
}

class FaultyEngine {
 public:
  capture::Capture capture;

  FaultyEngine() { capture.engine = "faulty"; }

  std::uint32_t add(capture::Mesh mesh) {
    capture.meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(capture.meshes.size() - 1);
  }

  /// Adds a tree of AABBs over the triangles of a mesh: splits them at random into 2 to `width` parts, down
  /// to leaves of at most `leaf` triangles. Returns its index.
  std::uint32_t grow(std::uint32_t mesh, std::mt19937_64& random, std::uint32_t leaf = 1,
                     std::uint32_t width = 2) {
    const capture::Mesh& m = capture.meshes[mesh];
    capture::Tree tree = tree_of(m, capture::VolumeKind::aabb, [&](std::vector<std::uint32_t>& all) {
      std::vector<std::vector<std::uint32_t>> groups;
      if (all.size() <= leaf) return groups;
      // Ordered along a random axis, and cut at random places.
      const int axis = static_cast<int>(random() % 3);
      std::stable_sort(all.begin(), all.end(), [&](std::uint32_t x, std::uint32_t y) {
        return m.vertices[m.triangles[x][0]][axis] < m.vertices[m.triangles[y][0]][axis];
      });
      const std::size_t parts = std::min<std::size_t>(all.size(), 2 + random() % (width - 1));
      std::set<std::size_t> cuts{0, all.size()};
      while (cuts.size() < parts + 1) cuts.insert(1 + random() % (all.size() - 1));
      for (auto cut = cuts.begin(); std::next(cut) != cuts.end(); ++cut)
        groups.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(*cut),
                            all.begin() + static_cast<std::ptrdiff_t>(*std::next(cut)));
      return groups;
    });
    tree.id = static_cast<std::uint32_t>(capture.trees.size() + 1);
    tree.mesh = mesh;
    capture.trees.push_back(std::move(tree));
    return static_cast<std::uint32_t>(capture.trees.size() - 1);
  }

  /// Runs a query and captures it. Its answer is that of the recorded tests.
  capture::Query& ask(std::uint32_t a, const Pose& pose_a, std::uint32_t b, const Pose& pose_b,
                      const FaultyQuery& how = {}) {
    capture::Query q;
    q.number = static_cast<std::uint32_t>(capture.queries.size() + 1);
    q.kind = how.kind;
    q.trees = {a, b};
    q.poses = {pose_a, pose_b};
    q.ended = true;
    found_.clear();
    descend(q, how, 0, 0);
    q.pairs = found_.size();
    q.verdict = found_.empty() ? capture::Verdict::separate : capture::Verdict::intersecting;
    close(q);
    capture.queries.push_back(std::move(q));
    return capture.queries.back();
  }

  /// Runs a query of a tree with a probe. A box hits triangles as a solid.
  capture::Query& ask(std::uint32_t a, const Pose& pose, const capture::Probe& probe,
                      const FaultyQuery& how) {
    capture::Query described;
    described.trees[0] = a, described.poses = {pose, capture::pose_of(probe)}, described.probe = probe;
    profile::CapturedBodies bodies(capture);
    capture::Tree tree = bodies.tree(bodies.trees_of(described).value()[1]);
    const capture::Mesh body = bodies.mesh_of(profile::CapturedBodies::kProbe);
    const std::uint32_t mesh_a = capture.trees[a].mesh, b = static_cast<std::uint32_t>(capture.trees.size());
    tree.mesh = add(body);
    capture.trees.push_back(tree);
    capture::Query& q = ask(a, pose, b, described.poses[1], how);
    const Eigen::Map<const Eigen::Array3d> least(probe.numbers.data()), greatest(probe.numbers.data() + 3);
    q.pairs = 0;
    for (capture::Event& e : q.events) {
      if (e.kind != capture::EventKind::triangles) continue;
      const Eigen::Array3d x = pose.apply(profile::corners_of(capture.meshes[mesh_a], e.a)[0]).array();
      bool hit = probe.shape == capture::ProbeShape::box && (x > least).all() && (x < greatest).all();
      for (std::uint32_t g = 0; g < body.triangles.size(); ++g)
        hit = hit || triangles_meet(capture.meshes[mesh_a], e.a, pose, body, g, q.poses[1]);
      q.pairs += e.met = hit != (how.lies.count({e.a, 0}) > 0);
    }
    q.verdict = q.pairs > 0 ? capture::Verdict::intersecting : capture::Verdict::separate;
    q.probe = probe;
    q.trees[1] = kNull;
    capture.trees.pop_back();
    capture.meshes.pop_back();
    return q;
  }

  /// Makes a query complete after its events have been changed.
  static void close(capture::Query& q) {
    q.events_seen = q.events.size();
    q.parts = {{0, 0, q.events.size()}};
  }

  bool volumes_overlap(const capture::Query& q, std::uint32_t i, std::uint32_t j, double reach = 0) const {
    const profile::Volumes a(capture.trees[q.trees[0]]), b(capture.trees[q.trees[1]]);
    return profile::overlap(a, i, q.poses[0], b, j, q.poses[1]) ||
           profile::gap(a, i, q.poses[0], b, j, q.poses[1]) < reach;
  }

 private:
  double size(std::uint32_t tree, std::uint32_t node) const {
    const auto n = capture.trees[tree].volume_of(node);
    return n[3] - n[0] + n[4] - n[1] + n[5] - n[2];
  }

  /// Visits a pair. Returns true if the query is answered.
  bool descend(capture::Query& q, const FaultyQuery& how, std::uint32_t i, std::uint32_t j) {
    const capture::Tree &a = capture.trees[q.trees[0]], &b = capture.trees[q.trees[1]];
    const bool leaves = a.is_leaf(i) && b.is_leaf(j);
    const bool both = how.order == OpeningOrder::both && !a.is_leaf(i) && !b.is_leaf(j);
    const bool prefers_a = how.order == OpeningOrder::a_first || how.order == OpeningOrder::both ||
                           (how.order == OpeningOrder::larger && size(q.trees[0], i) >= size(q.trees[1], j));
    const bool opens_a = !a.is_leaf(i) && (both || b.is_leaf(j) || prefers_a);
    const bool opens_b = !b.is_leaf(j) && (both || !opens_a);
    std::vector<NumberPair> next;
    const std::vector<std::uint32_t> only_i{i}, only_j{j};
    for (const std::uint32_t x : opens_a ? a.children(i) : std::span<const std::uint32_t>(only_i))
      for (const std::uint32_t y : opens_b ? b.children(j) : std::span<const std::uint32_t>(only_j))
        next.push_back({x, y});
    capture::Event e{.a = i, .b = j, .kind = capture::EventKind::nodes};
    if (how.wide && !leaves) {
      e.tests = static_cast<std::uint8_t>(next.size());
      std::erase_if(next, [&](const NumberPair& p) { return !volumes_overlap(q, p[0], p[1], how.reach); });
      e.met = static_cast<std::uint8_t>(next.size());
    } else {
      e.met = volumes_overlap(q, i, j, how.reach);
    }
    q.events.push_back(e);
    if (e.met == 0) return false;
    if (leaves) return test_leaves(q, how, i, j);
    if (how.forgetful == NumberPair{i, j}) next.pop_back();
    for (const NumberPair& p : next)
      if (descend(q, how, p[0], p[1])) return true;
    return false;
  }

  bool test_leaves(capture::Query& q, const FaultyQuery& how, std::uint32_t i, std::uint32_t j) {
    const capture::Tree &a = capture.trees[q.trees[0]], &b = capture.trees[q.trees[1]];
    for (const std::uint32_t f : a.triangles(i))
      for (const std::uint32_t g : b.triangles(j)) {
        const bool exact =
            triangles_meet(capture.meshes[a.mesh], f, q.poses[0], capture.meshes[b.mesh], g, q.poses[1]);
        const bool met = exact != (how.lies.count({f, g}) > 0);
        q.events.push_back({.a = f, .b = g, .kind = capture::EventKind::triangles, .met = met});
        if (!met) continue;
        found_.insert({f, g});
        if (how.kind == capture::QueryKind::any) return true;
      }
    return false;
  }

  std::set<NumberPair> found_;
};

/// Returns triangles at random places in the unit cube: they cross each other, share no edges, and every
/// fifth is degenerate or a copy of another.
inline capture::Mesh soup_mesh(std::mt19937_64& random, std::uint32_t triangles, double size = 0.5) {
  capture::Mesh out;
  out.name = "soup";
  const auto coordinate = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    Eigen::Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = coordinate();
    for (int c = 0; c < 3; ++c) {
      Eigen::Vector3d y = x;
      for (int k = 0; k < 3; ++k) y[k] += size * (coordinate() - 0.5);
      out.vertices.push_back(y);
    }
    out.triangles.push_back({first, first + 1, first + 2});
    if (t % 5 != 4) continue;
    if (t % 2 == 0)
      out.triangles.back()[2] = first + 1;  // a segment
    else
      out.triangles.back() = out.triangles[t - 1];
  }
  return out;
}

/// Returns a sheet of n x n squares, two triangles each, in the plane z = 0 of the unit square.
inline capture::Mesh sheet_mesh(std::uint32_t n) {
  capture::Mesh out;
  out.name = "sheet";
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j)
      out.vertices.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, 0);
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t v = i * (n + 1) + j, w = v + n + 1;
      out.triangles.push_back({v, w, v + 1});
      out.triangles.push_back({w, w + 1, v + 1});
    }
  return out;
}

/// Returns two triangles across z at two heights, from an edge at x to 1 on the x axis.
inline capture::Mesh mesh_across_z(const Eigen::Vector2d& edge, const Eigen::Vector2d& height) {
  capture::Mesh out;
  for (std::uint32_t i = 0; i < 2; ++i) {
    for (const double y : {-1, 1, 0}) out.vertices.emplace_back(y == 0 ? 1 : edge[i], y, height[i]);
    out.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return out;
}

inline capture::Probe ray_along_z(double x = 0) {
  return {capture::ProbeShape::ray, {x, x, 0, 0, 0, 1, 0, std::numeric_limits<double>::infinity()}};
}

/// Returns a captured query of a mesh with a probe, near which all volumes are.
inline capture::Capture capture_of(const capture::Mesh& mesh, const capture::Probe& probe,
                                   capture::QueryKind kind, const std::set<NumberPair>& lies = {}) {
  FaultyEngine engine;
  std::mt19937_64 random(1);
  engine.ask(engine.grow(engine.add(mesh), random), {}, probe, {.kind = kind, .reach = 9, .lies = lies});
  return engine.capture;
}

/// Returns a mesh of one triangle.
inline capture::Mesh triangle_mesh(const std::array<Eigen::Vector3d, 3>& corners) {
  capture::Mesh out;
  out.name = "triangle";
  out.vertices.assign(corners.begin(), corners.end());
  out.triangles = {{0, 1, 2}};
  return out;
}

}  // namespace lrb::test
