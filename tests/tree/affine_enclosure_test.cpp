// Pairs that the affine kernel culls are exactly disjoint: boxes of every pair of tree nodes, on the axes of
// either body, against exact arithmetic on the world coordinates. Also pairs that it decides.
#include <cmath>

#include <doctest/doctest.h>

#include "bench/cases/families.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/tree/kernel_setup.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/affine_maps.hpp"

#define LRB_AFFINE_KERNEL_NAME run_affine_kernel_under_test
namespace lrb {
void run_affine_kernel_under_test(TreeKernel& k);
}
#include "engine/tree/affine_kernel.inl"
#include "tests/support/exact_boxes.hpp"

using namespace lrb;

namespace {

struct AffineScene {
  Scene bodies;
  AffineTerms terms;
  TreeKernel k;

  explicit AffineScene(const Scene& s)
      : bodies(s), k(set_up_affine_kernel(s.a->tree(), s.pose_a, s.b->tree(), s.pose_b, s.a->dim(), terms)) {}
};

/// Vertices of a body in the world, seen on the axes of one of the bodies: G (w - t) / L.
std::vector<Exact3> seen(const LrbRep& rep, const Pose& pose, const Pose& axes, const AffineMap& map,
                         int exponent) {
  std::vector<Exact3> out;
  for (const auto& v : rep.vertices()) {
    const Eigen::Vector3d w = pose.apply(v);
    Exact3 x;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        x[i] =
            x[i] + (Exact(map.back(i, j)) * (Exact(w[j]) - Exact(axes.t[j]))).times_power_of_two(-exponent);
    out.push_back(x);
  }
  return out;
}

/// Of every real simplex on a node's axes: frame (x - own origin).
std::vector<Range3> on_node(const LrbRep& rep, const std::vector<Exact3>& x, const TreeNode& n,
                            const KernelMap& own, float ratio) {
  Exact3 origin;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      origin[i] = origin[i] + Exact(own.columns[j][i]) * Exact(n.origin[j]) * Exact(ratio);
  std::vector<Exact3> y(x.size());
  for (std::size_t v = 0; v < y.size(); ++v)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) y[v][i] = y[v][i] + Exact(n.frame[i][j]) * (x[v][j] - origin[j]);
  return ranges(rep, y);
}

std::vector<Range3> of_boxes(const LrbRep& rep, std::uint32_t node, const std::vector<Range3>& simplices) {
  std::vector<Range3> r;
  for (const auto& list : contents(rep, node)) r.push_back(united(simplices, list));
  return r;
}

/// On the axes of one body, of all of its nodes against all of the other's.
void check_on(const AffineScene& scene, Side side, Share& share) {
  const Scene& s = scene.bodies;
  const bool on_a = side == Side::a;
  const LrbRep &self = on_a ? *s.a : *s.b, &other = on_a ? *s.b : *s.a;
  const Pose &own_pose = on_a ? s.pose_a : s.pose_b, &other_pose = on_a ? s.pose_b : s.pose_a;
  const AffineMap map(own_pose, self.tree(), self.dim());
  const AffineTerms::Axes& axes = scene.terms.axes[static_cast<int>(side)];
  const float ratio = on_a ? scene.k.ratio_a : scene.k.ratio_b,
              other_ratio = on_a ? scene.k.ratio_b : scene.k.ratio_a;
  const auto own_x = seen(self, own_pose, own_pose, map, scene.terms.exponent),
             other_x = seen(other, other_pose, own_pose, map, scene.terms.exponent);
  const auto &nodes = self.tree().nodes(), &other_nodes = other.tree().nodes();
  for (std::uint32_t p = 0; p < nodes.size(); ++p) {
    const auto home = of_boxes(self, p, on_node(self, own_x, nodes[p], axes.own, ratio));
    const auto guests = on_node(other, other_x, nodes[p], axes.own, ratio);
    for (std::uint32_t q = 0; q < other_nodes.size(); ++q) {
      const Skewed w = on_a ? between_skewed(scene.k, nodes[p], other_nodes[q])
                            : between_skewed(scene.k, other_nodes[q], nodes[p]);
      const OnAxes& on = w.on[static_cast<int>(side)];
      if (!(on.error < 1e30F)) continue;  // overflow: nothing is culled
      check_axes(home, of_boxes(other, q, guests), boxes_on_own(decode(nodes[p], ratio), side, w),
                 turn(decode(other_nodes[q], other_ratio), on), on.error, share);
    }
  }
}

/// Checks culled and decided pairs with the rational oracle.
void check_verdicts(AffineScene scene, RandomEngine& random, Checked& checked) {
  const Scene& s = scene.bodies;
  TreeKernel& k = scene.k;
  k.affine = &scene.terms;
  check_outcome(s, candidates_of(s, k, run_affine_kernel_under_test), random, 20, checked);
}

/// Edges of A's (side 0) or B's simplices on the world's axes, under any two maps.
template <std::size_t kSide>
double share_of_edges(std::span<const double> genes) {
  const LeafPair at(genes);
  Pose pose[2];
  for (std::size_t i = 0; i < 18; ++i)
    pose[i / 9].r(static_cast<int>(i % 9 / 3), static_cast<int>(i % 3)) = 2 * genes[3 + i] - 1;
  pose[1].t = std::exp2(40 * genes[21] - 20) * test::vector_of(genes.subspan(22));
  AffineTerms terms;
  const TreeKernel k = set_up_affine_kernel(at.tree, pose[0], at.tree, pose[1], 3, terms);
  Corners corners[2];
  const Between w = corners_of(k, at.node(0), at.node(1), Skewed{}, corners[0], corners[1]);
  return at.share(
      kSide, pose[kSide].r * std::ldexp(1, -terms.exponent), w,
      [&](const LeafBlock&, int corner, int i, int lane) { return corners[kSide].x[corner][i][lane]; });
}

using test::closed;

Pose sized(Pose pose, double r, double t) {
  pose.r *= r;
  pose.t *= t;
  return pose;
}

}  // namespace

TEST_CASE("pairs culled by boxes under affine maps are disjoint in exact arithmetic") {
  RandomEngine random(17);
  const double sizes[] = {1, 1, 1e-150, 1e150, 1e-12};
  Share total;
  Checked checked;
  for (int i = 0; i < 5 * test::kMapKinds; ++i) {
    CAPTURE(i);
    const double size_a = sizes[i % 5], size_b = sizes[i / 2 % 5], world = i % 3 ? 1 : sizes[i % 4];
    const LrbRep a = closed(i % 2 ? shapes::bumpy_sphere(1, 3) : shapes::comb(3), size_a),
                 b = closed(i % 5 ? shapes::icosphere(1) : shapes::torus(6, 5), size_b);
    const auto kind = static_cast<test::MapKind>(i % test::kMapKinds),
               other_kind = static_cast<test::MapKind>(random() % test::kMapKinds);
    Pose pose_a{test::random_map(random, kind), {0, 0, 0}},
        pose_b{test::random_map(random, other_kind), {0, 0, 0}};
    pose_b.t = shapes::uniform(random, 0, 1.2) * shapes::random_direction(random);
    if (i % 7 == 3) {  // far off, together
      const Eigen::Vector3d far =
          std::pow(10, shapes::uniform(random, 0, 14)) * shapes::random_direction(random);
      pose_a.t += far;
      pose_b.t += far;
    }
    if (i % 11 == 5) pose_b.t *= 1e30;
    if (i % 4 == 1) std::swap(pose_a.r, pose_b.r);
    const AffineScene s(
        Scene{&a, &b, sized(pose_a, world / size_a, world), sized(pose_b, world / size_b, world)});
    Share share;
    check_on(s, Side::a, share);
    check_on(s, Side::b, share);
    REQUIRE(share.too_small == 0);
    REQUIRE(share.wrong == 0);
    total += share;
    check_verdicts(s, random, checked);
  }
  check_extent(total, checked, 500'000, 0.1);
}

TEST_CASE("margins of edges under affine maps are needed, and suffice") {
  const test::Margin rows[] = {{"edges of A", 25, share_of_edges<0>, 0.02, 6000},
                               {"edges of B", 25, share_of_edges<1>, 0.18, 6000}};
  test::check_margins(rows);
}
