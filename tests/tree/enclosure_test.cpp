// Boxes and balls of a tree contain the simplices below them, and whatever the query leaves out is exactly
// apart: the boxes of every pair of tree nodes, as the kernel turns them from one body's axes to the other's
// and grows them, against exact arithmetic on the world coordinates that the answer is about.
#include <cmath>

#include <doctest/doctest.h>

#include "bench/cases/families.hpp"
#include "engine/collide/tree_query.hpp"
#include "scenarios/bodies/shapes.hpp"

#define LRB_TREE_KERNEL_NAME run_tree_kernel_for_enclosure
namespace lrb {
void run_tree_kernel_for_enclosure(TreeKernel& k);
}
#include "engine/tree/tree_kernel.inl"
#include "tests/support/bodies.hpp"
#include "tests/support/exact_boxes.hpp"
#include "tests/support/margins.hpp"

using namespace lrb;

namespace {

/// World coordinates of one body seen on A's axes, in query units: r_a^T (w - t_a) / unit.
class Seen {
 public:
  Seen(const LrbRep& rep, const Pose& pose, const Pose& pose_a, double unit) {
    const int e = -std::ilogb(unit);
    for (const auto& v : rep.vertices()) {
      const Eigen::Vector3d w = pose.apply(v);
      Exact3 x;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          x[j] = x[j] + (Exact(pose_a.r(i, j)) * (Exact(w[i]) - Exact(pose_a.t[i]))).times_power_of_two(e);
      on_a_.push_back(x);
    }
  }
  /// To B's axes: m^T (x - t), with the kernel's m and t.
  void turn(const TreeKernel& k) {
    for (Exact3& x : on_a_) {
      Exact3 y;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) y[j] = y[j] + Exact(k.m[j][i]) * (x[i] - Exact(k.t[i]));
      x = y;
    }
  }
  /// In a node's coordinates.
  std::vector<Exact3> in_node(const TreeNode& n, float ratio) const {
    std::vector<Exact3> y(on_a_.size());
    for (std::size_t v = 0; v < y.size(); ++v)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          y[v][i] = y[v][i] + Exact(n.frame[i][j]) * (on_a_[v][j] - Exact(n.origin[j]) * Exact(ratio));
    return y;
  }

 private:
  std::vector<Exact3> on_a_;
};

/// Edges of A's (side 0) or B's simplices on the axes of A's nodes. Doubles are exact enough, since the
/// kernel has floats.
template <std::size_t kSide, int kFar>
double share_of_edges(std::span<const double> genes) {
  static const LrbRep body = test::closed(shapes::bumpy_sphere(1, 3));
  const auto vector = [](std::span<const double> g) {
    return Eigen::Vector3d(2 * g[0] - 1, 2 * g[1] - 1, 2 * g[2] - 1);
  };
  const Pose a = Pose::rotation(vector(genes), 6 * genes[3]),
             b = Pose::rotation(vector(genes.subspan(4)), 6 * genes[7],
                                std::exp2(kFar * genes[8] - 20) * vector(genes.subspan(9)));
  const TreeKernel k = set_up_kernel(body.tree(), a, body.tree(), b);
  std::vector<const TreeNode*> leaves;
  for (const TreeNode& n : body.tree().nodes())
    if (n.is_leaf) leaves.push_back(&n);
  const auto pick = [](double gene, std::size_t n) {
    return static_cast<std::size_t>(gene * static_cast<double>(n));
  };
  const TreeNode* const node[] = {leaves[pick(genes[12], leaves.size())],
                                  leaves[pick(genes[13], leaves.size())]};
  const Between w = between(k, *node[0], *node[1]);
  const LeafBlock& block = body.tree().blocks()[node[kSide]->first];
  const std::size_t lane = pick(genes[14], node[kSide]->count);
  VertexId v[3];
  body.simplex(block.simplex[lane], v);
  double most = 0;
  for (std::size_t corner = 0; corner < 2; ++corner) {
    Eigen::Vector3d exact =
        (body.vertices()[v[corner + 1]] - body.vertices()[v[corner]]) / body.tree().unit();
    if (kSide == 1) exact = a.r.transpose() * (b.r * exact);
    for (int i = 0; i < 3; ++i) {
      float at[2];
      for (std::size_t end = 0; end < 2; ++end) {
        const auto& x = block.corner[corner + end];
        at[end] = kSide == 0
                      ? x[i][lane]
                      : w.t[i] + w.r[i][0] * x[0][lane] + w.r[i][1] * x[1][lane] + w.r[i][2] * x[2][lane];
      }
      const auto& axis = node[0]->frame[i];
      most = std::max(most, std::abs(axis[0] * exact[0] + axis[1] * exact[1] + axis[2] * exact[2] -
                                     double{at[1] - at[0]}));
    }
  }
  return most / w.edge_error[kSide];
}

Share check_nodes(const Scene& s) {
  Share share;
  const TreeKernel k = set_up_kernel(*s.a, s.pose_a, *s.b, s.pose_b);
  const double unit = std::max(s.a->tree().unit(), s.b->tree().unit());
  Seen a(*s.a, s.pose_a, s.pose_a, unit), b(*s.b, s.pose_b, s.pose_a, unit);
  Seen a_turned = a, b_turned = b;
  a_turned.turn(k);
  b_turned.turn(k);
  const auto &nodes_a = s.a->tree().nodes(), &nodes_b = s.b->tree().nodes();
  struct View {
    std::vector<Exact3> a, b;  ///< vertices
    std::vector<Range3> of_a, of_b;
  };
  const auto view = [&](const Seen& of_a, const Seen& of_b, const TreeNode& n, float ratio) {
    View out{of_a.in_node(n, ratio), of_b.in_node(n, ratio), {}, {}};
    out.of_a = ranges(*s.a, out.a);
    out.of_b = ranges(*s.b, out.b);
    return out;
  };
  std::vector<View> on_a, on_b;
  for (const TreeNode& n : nodes_a) on_a.push_back(view(a, b, n, k.ratio_a));
  for (const TreeNode& n : nodes_b) on_b.push_back(view(a_turned, b_turned, n, k.ratio_b));
  for (std::uint32_t p = 0; p < nodes_a.size(); ++p)
    for (std::uint32_t q = 0; q < nodes_b.size(); ++q) {
      const Between w = between(k, nodes_a[p], nodes_b[q]);
      if (!(w.error < 1e30f)) continue;  // overflow: nothing is culled
      const Boxes boxes_a = decode(nodes_a[p], k.ratio_a), boxes_b = decode(nodes_b[q], k.ratio_b);
      std::vector<Range3> a_on_a, b_on_a, a_on_b, b_on_b;
      for (const auto& list : contents(*s.a, p)) {
        a_on_a.push_back(united(on_a[p].of_a, list));
        a_on_b.push_back(united(on_b[q].of_a, list));
      }
      for (const auto& list : contents(*s.b, q)) {
        b_on_a.push_back(united(on_a[p].of_b, list));
        b_on_b.push_back(united(on_b[q].of_b, list));
      }
      check_axes(a_on_a, b_on_a, boxes_a, turn_b<false>(boxes_b, w), w.error, share);
      check_axes(b_on_b, a_on_b, boxes_b, turn_a<false>(boxes_a, w), w.error, share);
    }
  return share;
}

/// Pairs that boxes or planes have dropped do not meet, says the rational oracle.
void check_dropped(const Scene& s, RandomEngine& random, int most, Checked& checked) {
  TreeKernel k = set_up_kernel(*s.a, s.pose_a, *s.b, s.pose_b);
  check_outcome(s, candidates_of(s, k, run_tree_kernel_for_enclosure), random, most, checked);
}

using test::closed;

/// Moves that strain the error terms: far off, an ulp from each other, no rotations.
void spoil(Scene& s, RandomEngine& random, int kind) {
  const Eigen::Vector3d far = std::pow(10, cases::pick(random, 0, 16)) * shapes::random_direction(random);
  if (kind == 1) s.pose_b = s.pose_a;
  if (kind == 2 || kind == 3) {
    s.pose_a.t += far;
    s.pose_b.t += far;
  }
  if (kind == 3) s.pose_b = s.pose_a;
  if (kind == 4) s.pose_b.t += far;
  if (kind == 5 || kind == 6)
    for (Pose* p : {&s.pose_a, &s.pose_b}) {
      p->r *= std::pow(10, shapes::uniform(random, -3, 3));
      if (kind == 6) p->r(0, 1) += shapes::uniform(random, -1, 1);
    }
  if (kind == 7) s.pose_a.r = shapes::random_rotation(random) * Eigen::Vector3d(1, 1, 0).asDiagonal();
  if (kind % 2)
    for (int i = 0; i < 3; ++i) s.pose_b.t[i] = cases::nudged(s.pose_b.t[i], cases::pick(random, -1, 1));
}

}  // namespace

namespace {

/// Box k of a node must hold the simplices beneath it, as the kernel decodes it; the ball everything.
void check_tree(const LrbRep& rep) {
  const ObbTree& t = rep.tree();
  const Seen seen(rep, {}, {}, t.unit());
  for (std::uint32_t index = 0; index < t.nodes().size(); ++index) {
    const TreeNode& n = t.nodes()[index];
    const std::vector<Exact3> y = seen.in_node(n, 1);
    const std::vector<Range3> of = ranges(rep, y);
    const Boxes boxes = decode(n, 1);
    const Whole whole = whole_of(n, 1);
    const auto lists = contents(rep, index);
    const Exact radius(n.radius), zero(0.0);
    for (std::uint32_t k = 0; k < n.count; ++k) {
      const Range3 box = united(of, lists[k]);
      for (int i = 0; i < 3; ++i) {
        REQUIRE(!(zero < outside(box[i], boxes.centre[i][k], boxes.half[i][k], 0)));
        REQUIRE(!(zero < outside(box[i], whole.centre[i], whole.half[i], 0)));
      }
      for (const SimplexId s : lists[k]) {
        VertexId v[3];
        rep.simplex(s, v);
        for (int corner = 0; corner < rep.dim(); ++corner) {
          const Exact3& x = y[v[corner]];
          REQUIRE(!(radius * radius < x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("boxes and balls contain all simplices below them, at any scale, aspect and offset") {
  for (const Mesh& m : {shapes::bumpy_sphere(2, 1), shapes::comb(5), shapes::torus(12, 8), shapes::gear(20)})
    for (const double scale : {1.0, 1e-12, 1e120, 1e-120, 1e-310, 1e-320, 1e300}) {
      check_tree(closed(shapes::scaled(m, scale)));
      check_tree(closed(test::stretched(m, Eigen::Vector3d(1, 1e-8, m.dim == 2 ? 0 : 1e-4) * scale)));
      if (m.dim == 3) check_tree(closed(shapes::translated(m, {1e8, -1e16 * (scale < 1), 3})));
    }
  for (const Eigen::Vector3d& by : {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {0, 0, 1e-15}})  // a point, a line
    check_tree(closed(shapes::translated(test::stretched(shapes::icosphere(1), by), {1, 1, 1})));
}

TEST_CASE("margins of edges are needed, and suffice") {
  const test::Margin rows[] = {{"own edges", 15, share_of_edges<0, 0>, 0.08},
                               {"turned edges", 15, share_of_edges<1, 0>, 0.029},
                               {"far edges", 15, share_of_edges<1, 40>, 0.35}};
  test::check_margins(rows);
}

TEST_CASE("pairs culled by boxes are disjoint in exact arithmetic: random and adversarial poses") {
  RandomEngine random(31);
  const double kSizes[] = {1, 1, 1e-12, 1e12, 1e-60, 1e100, 1e-308};
  Share total;
  Checked checked;
  for (int i = 0; i < 56; ++i) {
    CAPTURE(i);
    const double size = kSizes[i % 7];
    const bool both = i % 3 != 0;
    const LrbRep a = closed(i % 2 ? shapes::bumpy_sphere(1, 3) : shapes::comb(3), both ? size : 1),
                 b = closed(i % 5 ? shapes::icosphere(1) : shapes::torus(6, 5), size);
    Scene s{&a, &b, cases::any_pose(random), {}};
    s.pose_a.t *= both ? size : 1;
    s.pose_b = shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1.1));
    s.pose_b.t = s.pose_a.apply(s.pose_b.t);
    s.pose_b.r = s.pose_a.r * s.pose_b.r;
    spoil(s, random, i % 8);
    const Share share = check_nodes(s);
    REQUIRE(share.too_small == 0);
    REQUIRE(share.wrong == 0);
    total += share;
    check_dropped(s, random, 20, checked);
  }
  check_extent(total, checked, 1'000'000, 0.05);
}
