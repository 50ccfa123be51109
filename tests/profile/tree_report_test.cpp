#include "scenarios/profile/tree_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/matrix/bodies.hpp"
#include "tests/support/captured_trees.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;
using capture::VolumeKind;
using Eigen::Vector3d;
using profile::TreeFault;

namespace {

constexpr VolumeKind kAll[] = {VolumeKind::aabb, VolumeKind::sphere, VolumeKind::obb, VolumeKind::rss,
                               VolumeKind::kdop};

capture::Mesh captured(Mesh mesh) {
  const bodies::LoadedBody body = bodies::faces_of_mesh(std::move(mesh));
  return profile::own_tree(body.rep, trace::TreeShape(body.rep.tree())).mesh;
}

std::vector<std::string> texts(const profile::TreeReport& report, const capture::Tree& tree,
                               const capture::Mesh& mesh) {
  std::vector<std::string> out;
  for (const profile::FoundFault& f : report.faults.first) out.push_back(text_of(f, tree, mesh));
  return out;
}

/// Four triangles in the plane z = 0, side by side along x: triangle i between x = i and i + 1.
capture::Mesh strip(std::uint32_t triangles = 4) {
  capture::Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const double x = i;
    for (const Vector3d& v : {Vector3d(x, 0, 0), Vector3d(x + 1, 0, 0), Vector3d(x, 1, 0)})
      mesh.vertices.push_back(v);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("faults of random graphs of nodes are those found by brute force") {
  shapes::RandomEngine random(31);
  const auto below = [&](std::size_t n) {
    return static_cast<std::uint32_t>(shapes::uniform(random, 0, static_cast<double>(n)));
  };
  const capture::Mesh mesh = strip();
  const std::size_t triangles = mesh.triangles.size();
  int broken_graphs = 0, broken_volumes = 0;
  for (int round = 0; round < 4000; ++round) {
    // Half of them are trees in which parents have lower numbers; the others have random children.
    const std::uint32_t size = 1 + below(9);
    const bool is_tree = round % 2 == 0;
    std::vector<std::vector<std::uint32_t>> children(size), of_leaf(size);
    for (std::uint32_t n = 1; n < size; ++n)
      if (is_tree || below(3) > 0) children[is_tree ? below(n) : below(size)].push_back(n);
    if (!is_tree && below(2) == 0) children[below(size)].push_back(below(size));
    for (std::uint32_t t = 0; t < triangles + (round % 5 == 0); ++t)
      if (below(8) > 0) of_leaf[below(size)].push_back(t);
    capture::Tree tree;
    tree.first_child = tree.first_triangle = {0};
    for (std::uint32_t n = 0; n < size; ++n) {
      tree.child.insert(tree.child.end(), children[n].begin(), children[n].end());
      tree.triangle.insert(tree.triangle.end(), of_leaf[n].begin(), of_leaf[n].end());
      tree.first_child.push_back(static_cast<std::uint32_t>(tree.child.size()));
      tree.first_triangle.push_back(static_cast<std::uint32_t>(tree.triangle.size()));
      // Mostly large enough; the numbers repeat, so that volumes are often nested.
      const double low = below(3) > 0 ? 0 : below(4), high = below(3) > 0 ? 5 : below(5);
      for (const double x : {low, 0.0, 0.0, high, 1.0, 0.0}) tree.volumes.push_back(x);
    }
    // Brute force: which node leads to which.
    std::vector<std::vector<char>> leads(size, std::vector<char>(size, 0));
    for (std::uint32_t n = 0; n < size; ++n)
      for (const std::uint32_t c : children[n]) leads[n][c] = 1;
    for (std::uint32_t k = 0; k < size; ++k)
      for (std::uint32_t i = 0; i < size; ++i)
        for (std::uint32_t j = 0; j < size; ++j) leads[i][j] |= leads[i][k] && leads[k][j];
    std::array<std::uint64_t, profile::kTreeFaults> expected{};
    const auto count = [&](TreeFault kind) -> std::uint64_t& {
      return expected[static_cast<std::size_t>(kind)];
    };
    std::uint32_t unreached = 0;
    bool has_cycle = false;
    std::vector<int> listed(triangles, 0);
    for (std::uint32_t n = 0; n < size; ++n) {
      has_cycle |= leads[n][n] != 0;
      count(TreeFault::no_parent) +=
          n != 0 && std::none_of(children.begin(), children.end(),
                                 [&](const auto& c) { return std::find(c.begin(), c.end(), n) != c.end(); });
      if (n != 0 && !leads[0][n]) {
        ++unreached;
        continue;
      }
      count(TreeFault::inner_node_with_triangles) += !children[n].empty() && !of_leaf[n].empty();
      count(TreeFault::leaf_without_triangles) += children[n].empty() && of_leaf[n].empty();
      for (const std::uint32_t t : of_leaf[n]) {
        if (t < triangles) ++listed[t];
        count(TreeFault::nonexistent_triangle) += t >= triangles;
      }
      const auto volume = tree.volume_of(n);
      if (volume[0] > volume[3]) {
        ++count(TreeFault::empty_volume);
        continue;
      }
      bool outside = false;
      for (std::uint32_t m = 0; m < size; ++m)
        for (const std::uint32_t t : of_leaf[m])
          outside |= (m == n || leads[n][m]) && t < triangles && (t < volume[0] || t + 1 > volume[3]);
      count(TreeFault::corner_outside) += outside;
    }
    for (const int times : listed) count(TreeFault::triangle_in_no_leaf) += times == 0;
    const profile::TreeReport report = profile::report_tree(tree, mesh, {.samples = 10});
    const auto& found = report.faults.totals;
    CHECK(report.figures.unreached == unreached);
    CHECK((found[static_cast<std::size_t>(TreeFault::cycle)] > 0) == has_cycle);
    for (const TreeFault kind :
         {TreeFault::no_parent, TreeFault::nonexistent_triangle, TreeFault::triangle_in_no_leaf,
          TreeFault::empty_volume, TreeFault::inner_node_with_triangles, TreeFault::leaf_without_triangles})
      CHECK(found[static_cast<std::size_t>(kind)] == count(kind));
    if (is_tree) {
      CHECK(found[static_cast<std::size_t>(TreeFault::two_parents)] == 0);
      CHECK(found[static_cast<std::size_t>(TreeFault::corner_outside)] == count(TreeFault::corner_outside));
      broken_volumes += count(TreeFault::corner_outside) > 0;
    }
    broken_graphs += has_cycle;
  }
  CHECK(broken_graphs > 200);
  CHECK(broken_volumes > 200);
}

TEST_CASE("a corner outside is found in every kind of volume, whatever the volumes above contain") {
  const capture::Mesh mesh = captured(shapes::bumpy_sphere(3, 2));
  for (const VolumeKind kind : kAll) {
    capture::Tree tree = test::halving_tree(mesh, kind, 2);
    const std::size_t numbers = tree.volumes.size() / tree.size();
    shapes::RandomEngine random(5);
    for (int i = 0; i < 20; ++i) {
      const auto n = static_cast<std::uint32_t>(shapes::uniform(random, 0, static_cast<double>(tree.size())));
      capture::Tree broken = tree;
      // Halves the volume about its centre: the outermost corners lie outside then.
      double* x = &broken.volumes[n * numbers];
      if (kind == VolumeKind::sphere || kind == VolumeKind::rss) x[numbers - 1] /= 2;
      if (kind == VolumeKind::aabb)
        for (int k = 0; k < 3; ++k) x[k] += (x[3 + k] - x[k]) / 2;
      if (kind == VolumeKind::obb)
        for (int k = 3; k < 12; ++k) x[k] /= 2;
      if (kind == VolumeKind::kdop) x[0] += (x[1] - x[0]) / 2;
      const profile::TreeReport report = profile::report_tree(broken, mesh, {.samples = 10});
      REQUIRE(report.faults.first.size() == 1);
      const profile::FoundFault& f = report.faults.first[0];
      CHECK(f.kind == TreeFault::corner_outside);
      CHECK(f.node == n);
      const profile::Volumes volumes(broken);
      CHECK(f.by == volumes.outside(
                        n, mesh.vertices[mesh.triangles[f.triangle][static_cast<std::size_t>(f.corner)]]));
    }
  }
}

TEST_CASE("the depths, leaf sizes and SAH of a tree are those counted directly") {
  const capture::Mesh mesh = captured(shapes::torus(20, 12));
  for (const VolumeKind kind : kAll) {
    const capture::Tree tree = test::halving_tree(mesh, kind, 3);
    const profile::TreeFigures f = profile::report_tree(tree, mesh).figures;
    const profile::Volumes volumes(tree);
    double inner = 0, leaves = 0, depths = 0;
    std::uint64_t leaf_count = 0;
    // Breadth first: parents come before children.
    std::vector<std::uint32_t> depth(tree.size(), 0);
    std::map<std::uint64_t, std::uint64_t> sizes;
    for (std::uint32_t n = 0; n < tree.size(); ++n) {
      for (const std::uint32_t c : tree.children(n)) depth[c] = depth[n] + 1;
      const double share = volumes.size(n).area / volumes.size(0).area;
      if (!tree.is_leaf(n)) {
        inner += share;
        continue;
      }
      leaves += share * static_cast<double>(tree.triangles(n).size());
      depths += depth[n];
      ++leaf_count;
      ++sizes[tree.triangles(n).size()];
    }
    CHECK(f.nodes == tree.size());
    CHECK(f.leaves == leaf_count);
    CHECK(f.unreached == 0);
    CHECK(f.depth == *std::max_element(depth.begin(), depth.end()));
    CHECK(f.mean_depth == doctest::Approx(depths / static_cast<double>(leaf_count)));
    CHECK(f.leaf_sizes == sizes);
    REQUIRE(f.sah());
    CHECK(*f.sah_inner == doctest::Approx(inner));
    CHECK(*f.sah_leaves == doctest::Approx(leaves));
    CHECK(*f.sah() == doctest::Approx(1.2 * inner + leaves));
    CHECK(f.volume_bytes == 8 * tree.volumes.size());
    double by_depth = 0;
    std::uint64_t nodes = 0;
    for (const profile::DepthFigures& d : f.by_depth) by_depth += d.epo, nodes += d.nodes;
    CHECK(nodes == tree.size());
    REQUIRE(f.epo);
    CHECK(by_depth == doctest::Approx(f.epo->value));
    REQUIRE(f.worst.size() == 10);
    CHECK(f.worst[0].epo == *std::max_element(f.epo->by_node.begin(), f.epo->by_node.end()));
  }
}

TEST_CASE("sampled EPO lies within three standard errors of that by clipping") {
  const std::vector<Mesh> meshes = {shapes::bumpy_sphere(3, 3), shapes::torus(30, 12), shapes::comb(6),
                                    shapes::bowl(24, 10)};
  int within_one = 0, all = 0;
  for (const Mesh& m : meshes) {
    const capture::Mesh mesh = captured(m);
    for (const VolumeKind kind : {VolumeKind::aabb, VolumeKind::obb, VolumeKind::kdop})
      for (const std::size_t leaf_size : {1, 4}) {
        const capture::Tree tree = test::halving_tree(mesh, kind, leaf_size);
        const profile::Volumes volumes(tree);
        const profile::TreeIndex index(tree, mesh.triangles.size());
        const auto sampled = sample_epo(volumes, mesh, index, 20'000, 1),
                   exact = exact_epo(volumes, mesh, index);
        REQUIRE(sampled);
        REQUIRE(exact);
        CHECK(sampled->error < 0.03 * exact->value);
        CHECK(std::abs(sampled->value - exact->value) < 3 * sampled->error);
        ++all;
        within_one += std::abs(sampled->value - exact->value) < sampled->error;
      }
  }
  CHECK(within_one > all * 0.4);  // expected: 68 %
}

TEST_CASE("lrbscope's own trees have no faults") {
  for (matrix::Kind& kind : matrix::make_matrix(1).kinds) {
    const bodies::LoadedBody body = bodies::faces_of_mesh(std::move(kind.mesh));
    const profile::OwnTree own = profile::own_tree(body.rep, trace::TreeShape(body.rep.tree()));
    CAPTURE(own.mesh.name);
    CHECK(own.mesh.triangles.size() == body.rep.real_simplex_count());
    const profile::TreeReport report = profile::report_tree(own.tree, own.mesh);
    CHECK(texts(report, own.tree, own.mesh) == Texts{});
    // The counts of the engine's own measures.
    const TreeQuality quality = tree_quality(body.rep.tree());
    CHECK(report.figures.nodes == quality.nodes);
    CHECK(report.figures.leaves == quality.leaves);
    const bool has_area = kind.name != "line" && !kind.name.ends_with("tiny");  // whose areas round to 0
    CHECK(report.figures.epo.has_value() == (body.rep.dim() == 3 && has_area));
  }
}

TEST_CASE("a chain of 100,000 nodes is measured without recursion") {
  constexpr std::uint32_t kLength = 100'000;
  const capture::Mesh mesh = strip(kLength + 1);
  capture::Tree tree;
  tree.first_child = tree.first_triangle = {0};
  // Nodes 0 to kLength - 1: inner; node i has the leaf kLength + i of triangle i, and the next one.
  for (std::uint32_t n = 0; n < 2 * kLength + 1; ++n) {
    const bool is_leaf = n >= kLength;
    const double from = is_leaf ? n - kLength : n, to = is_leaf ? from + 1 : kLength + 1;
    for (const double x : {from, 0.0, 0.0, to, 1.0, 0.0}) tree.volumes.push_back(x);
    if (is_leaf) tree.triangle.push_back(n - kLength);
    if (!is_leaf) {
      tree.child.push_back(kLength + n);
      tree.child.push_back(n + 1 < kLength ? n + 1 : 2 * kLength);
    }
    tree.first_child.push_back(static_cast<std::uint32_t>(tree.child.size()));
    tree.first_triangle.push_back(static_cast<std::uint32_t>(tree.triangle.size()));
  }
  const profile::TreeReport report = profile::report_tree(tree, mesh);
  CHECK(report.faults.total() == 0);
  CHECK(report.figures.depth == kLength);
  tree.child.back() = 0;  // the whole chain becomes a cycle
  const profile::TreeReport broken = profile::report_tree(tree, mesh);
  REQUIRE(broken.faults.first.size() == 3);
  CHECK(broken.faults.first[0].kind == TreeFault::no_parent);
  CHECK(broken.faults.first[1].kind == TreeFault::cycle);
  CHECK(broken.faults.first[1].count == kLength);
  CHECK(broken.faults.first[2].kind == TreeFault::triangle_in_no_leaf);
}

TEST_CASE("with spatial splits, every part of a triangle must be in the volumes of a leaf and above it") {
  // The first triangle of a strip is cut at x = 0.5: nodes 3 and 4 have a half of it each.
  const capture::Mesh mesh = strip(2);
  capture::Tree tree;
  tree.splits = true;
  tree.first_child = {0, 2, 4, 4, 4, 4}, tree.child = {1, 2, 3, 4};
  tree.first_triangle = {0, 0, 0, 1, 2, 3}, tree.triangle = {1, 0, 0};
  tree.volumes = {0, 0, 0, 2, 1, 0, 0,   0, 0, 1,   1, 0, 1, 0,   0,
                  2, 1, 0, 0, 0, 0, 0.5, 1, 0, 0.5, 0, 0, 1, 0.5, 0};
  const auto texts_of = [&] { return texts(profile::report_tree(tree, mesh), tree, mesh); };
  CHECK(texts_of() == Texts{});
  const capture::Tree good = tree;
  tree.volumes[4 * 6] = 0.75;  // a gap from x = 0.5 to 0.75
  tree.volumes[4 * 6 + 4] = 0.25;
  CHECK(texts_of() ==
        Texts{"a part of triangle 0 around (0.625, 0.1875, 0), 0.187 of its area, lies in the volumes of "
              "none of its leaves"});
  tree = good;
  tree.volumes[1 * 6 + 3] = 0.75;  // the node above cuts off the end
  CHECK(texts_of() ==
        Texts{"a part of triangle 0 around (0.833333, 0.0833333, 0), 0.0625 of its area, lies in the "
              "volumes of none of its leaves"});
  tree = good;
  tree.splits = false;
  CHECK(profile::report_tree(tree, mesh)
            .faults.totals[static_cast<std::size_t>(TreeFault::triangle_in_two_leaves)] == 1);
  // Any tree whose leaves contain whole triangles is one.
  for (const VolumeKind kind : {VolumeKind::aabb, VolumeKind::obb, VolumeKind::kdop}) {
    capture::Tree whole = test::halving_tree(strip(40), kind);
    whole.splits = true;
    CHECK(profile::report_tree(whole, strip(40)).faults.total() == 0);
  }
}

TEST_CASE("a mesh of one triangle, of none, and a tree of no nodes") {
  const capture::Mesh one = strip(1);
  for (const VolumeKind kind : kAll) {
    const capture::Tree tree = test::halving_tree(one, kind);
    const profile::TreeReport report = profile::report_tree(tree, one);
    CHECK(report.faults.total() == 0);
    CHECK(report.figures.nodes == 1);
    REQUIRE(report.figures.epo);
    CHECK(report.figures.epo->value == 0);
    CHECK(report.figures.worst.empty());
  }
  capture::Tree root = test::halving_tree(one, VolumeKind::aabb);
  root.triangle.clear();
  root.first_triangle[1] = 0;
  const profile::TreeReport empty = profile::report_tree(root, {});
  CHECK(empty.faults.total() == 0);
  CHECK_FALSE(empty.figures.epo);
  capture::Tree nothing;
  nothing.first_child = nothing.first_triangle = {0};
  CHECK_THROWS_AS(profile::report_tree(nothing, one), InputError);
}
