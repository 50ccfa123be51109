// Boxes and balls of a tree contain the simplices below them, and whatever the query leaves out is exactly
// apart: the boxes of every pair of tree nodes, as the kernel turns them from one body's axes to the other's
// and grows them, against exact arithmetic on the world coordinates that the answer is about.
#include <cmath>

#include <doctest/doctest.h>

#include "bench/cases/families.hpp"
#include "engine/collide/tree_query.hpp"
#include "scenarios/bodies/shapes.hpp"

#define LRB_TREE_KERNEL_NAME run_tree_kernel_for_enclosure
#define LRB_DISTANCE_KERNEL_NAME run_distance_kernel_for_enclosure
namespace lrb {
struct DistanceKernel;
void run_tree_kernel_for_enclosure(TreeKernel& k);
void run_distance_kernel_for_enclosure(DistanceKernel& k);
}  // namespace lrb
#include "engine/distance/distance_kernel.inl"
#include "engine/tree/tree_kernel.inl"
#include "tests/support/exact_boxes.hpp"

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

/// Two leaves of a body at two poses, which are exact enough in doubles, since the kernels have floats.
template <int kFar>
struct PosedLeaves : LeafPair {
  Pose a, b;

  explicit PosedLeaves(std::span<const double> genes)
      : LeafPair(genes),
        a(Pose::rotation(test::vector_of(genes.subspan(3)), 6 * genes[6])),
        b(Pose::rotation(test::vector_of(genes.subspan(7)), 6 * genes[10],
                         std::exp2(kFar * genes[11] - 20) * test::vector_of(genes.subspan(12)))) {}
};

/// Edges of A's (side 0) or B's simplices on the axes of A's nodes.
template <std::size_t kSide, int kFar>
double share_of_edges(std::span<const double> genes) {
  const PosedLeaves<kFar> at(genes);
  const Between w = between(set_up_kernel(at.tree, at.a, at.tree, at.b), at.node(0), at.node(1));
  Eigen::Matrix3d axes;
  for (int i = 0; i < 9; ++i) axes(i / 3, i % 3) = at.node(0).frame[i / 3][i % 3];
  if (kSide == 1) axes *= at.a.r.transpose() * at.b.r;
  return at.share(kSide, axes / at.tree.unit(), w, [&](const LeafBlock& block, int corner, int i, int lane) {
    const auto& x = block.corner[corner];
    return kSide == 0 ? x[i][lane]
                      : w.t[i] + w.r[i][0] * x[0][lane] + w.r[i][1] * x[1][lane] + w.r[i][2] * x[2][lane];
  });
}

/// Slab between the contents of two leaves, along the direction that the distance query keeps.
double share_of_slab(std::span<const double> genes) {
  const PosedLeaves<40> at(genes);
  DistanceKernel k{};
  k.tree = set_up_kernel(at.tree, at.a, at.tree, at.b);
  std::vector<NodeEnd> ends[2];
  for (std::size_t side = 0; side < 2; ++side) {
    ends[side].resize(at.tree.nodes().size());
    k.ends[side] = ends[side].data();
  }
  const Eigen::Vector3f direction = test::vector_of(genes.subspan(15)).normalized().cast<float>();
  turn_to(k, direction.data());
  const float width = end_of<Side::b>(k, at.index[1]) - end_of<Side::a>(k, at.index[0]) + k.ahead;
  // The same exactly, and the offset of the roots' origins, in B's coordinates and then in A's.
  const Eigen::Vector3d d = direction.cast<double>() / at.tree.unit(),
                        d_b = at.b.r.transpose() * (at.a.r * d);
  const double apart = d.dot(at.a.r.transpose() * at.b.t);
  const auto& root = at.tree.nodes()[0].origin;
  const Eigen::Vector3d origin = at.tree.unit() * Eigen::Vector3d(root[0], root[1], root[2]);
  const double errors = apart + (d_b - d).dot(origin) - double{k.ahead};
  return 1 + (width - (apart - at.end(1, -d_b) - at.end(0, d))) / errors;
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

TEST_CASE("margins of edges and slabs are needed, and suffice") {
  const test::Margin rows[] = {{"own edges", 15, share_of_edges<0, 0>, 0.08},
                               {"turned edges", 15, share_of_edges<1, 0>, 0.029},
                               {"far edges", 15, share_of_edges<1, 40>, 0.35},
                               {"slabs", 18, share_of_slab, 0.01}};
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
