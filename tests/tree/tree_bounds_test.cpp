// Every bound of the tree and of its kernel, against arithmetic of 100 digits: boxes contain the simplices
// below them, and the kernel's margins cover the errors of transforms and rounding.
#include <cmath>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <doctest/doctest.h>

#include "engine/collide/tree_query.hpp"
#include "scenarios/bodies/shapes.hpp"

// The kernel itself, to look at what is inside it.
#define LRB_TREE_KERNEL_NAME run_tree_kernel_under_test
namespace lrb {
void run_tree_kernel_under_test(TreeKernel& k);
}
#include "engine/tree/tree_kernel.inl"
#include "tests/support/bodies.hpp"
#include "tests/support/tree_content.hpp"

using namespace lrb;
using shapes::RandomEngine;

namespace {

using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;
using Real3 = std::array<Real, 3>;

Real3 to_real(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}

Eigen::Vector3d vertex(const LrbRep& rep, SimplexId s, int corner) {
  VertexId v[3];
  rep.simplex(s, v);
  return rep.vertices()[v[std::min(corner, rep.dim() - 1)]];
}

/// A node's coordinates of a point in units.
Real3 in_node(const TreeNode& n, const Real3& x) {
  Real3 y;
  for (int i = 0; i < 3; ++i) {
    y[i] = 0;
    for (int j = 0; j < 3; ++j) y[i] += Real(n.frame[i][j]) * (x[j] - Real(n.origin[j]));
  }
  return y;
}

/// Box k of a node must hold the simplices beneath it, as the kernel decodes it; the ball everything.
void check_node(const LrbRep& rep, std::uint32_t index) {
  const ObbTree& t = rep.tree();
  const TreeNode& n = t.nodes()[index];
  const Boxes boxes = decode(n, 1);
  const Whole whole = whole_of(n, 1);
  for (std::uint32_t k = 0; k < n.count; ++k) {
    std::vector<SimplexId> below;
    if (n.is_leaf)
      below.push_back(t.blocks()[n.first].simplex[k]);
    else
      test::simplices_under(t, n.first + k, below);
    for (const SimplexId s : below)
      for (int corner = 0; corner < 3; ++corner) {
        Real3 x = to_real(vertex(rep, s, corner));
        for (Real& c : x) c /= t.unit();
        const Real3 y = in_node(n, x);
        Real square = 0;
        for (int i = 0; i < 3; ++i) {
          REQUIRE(abs(y[i] - Real(boxes.centre[i][k])) <= Real(boxes.half[i][k]));
          REQUIRE(abs(y[i] - Real(whole.centre[i])) <= Real(whole.half[i]));
          square += y[i] * y[i];
        }
        REQUIRE(square <= Real(n.radius) * n.radius);
      }
  }
}

void check_tree(const LrbRep& rep) {
  for (std::uint32_t i = 0; i < rep.tree().nodes().size(); ++i) check_node(rep, i);
}

/// r^T (w - t) / unit in a node's coordinates, as bounded by the kernel's boxes.
Real3 functional(const Pose& pose, const TreeNode& n, double own_unit, double unit,
                 const Eigen::Vector3d& world) {
  Real3 local;
  for (int j = 0; j < 3; ++j) {
    local[j] = 0;
    for (int i = 0; i < 3; ++i) local[j] += Real(pose.r(i, j)) * (Real(world[i]) - Real(pose.t[i]));
    local[j] /= own_unit;
  }
  Real3 y = in_node(n, local);
  for (Real& c : y) c *= Real(own_unit) / Real(unit);
  return y;
}

struct BoundsScene {
  LrbRep a, b;
  Pose pose_a, pose_b;
  bool rotations = true;  ///< then the kernel's way back to B's axes is r_b^T too, and can be compared
};

struct Shares {
  double corners = 0, edges = 0;
};

/// Greatest deviation of the differences of two corners of one body, on A's axes, over Between::edge_error.
double share_of_edges(const Real3* true_a, const float (*got_a)[3], const Real3* true_b,
                      const float (*got_b)[3], const Between& w) {
  const auto share = [](const Real3* x, const float(*got)[3], int axis, float error) {
    const float edge = got[1][axis] - got[0][axis];
    return static_cast<double>(abs(x[1][axis] - x[0][axis] - Real(edge)) / Real(error));
  };
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis)
    worst = std::max(
        {worst, share(true_a, got_a, axis, w.edge_error[0]), share(true_b, got_b, axis, w.edge_error[1])});
  return worst;
}

/// Greatest deviation of the corners that a leaf pair computes with from the functionals, over the error that
/// the kernel reckons with; and of edges.
Shares worst_shares(const BoundsScene& s, RandomEngine& random, int pairs) {
  const TreeKernel k = set_up_kernel(s.a, s.pose_a, s.b, s.pose_b);
  const double unit = std::max(s.a.tree().unit(), s.b.tree().unit());
  Shares worst;
  const auto leaf = [&](const LrbRep& rep) -> const TreeNode& {
    while (true) {
      const TreeNode& n = rep.tree().nodes()[random() % rep.tree().nodes().size()];
      if (n.is_leaf) return n;
    }
  };
  for (int i = 0; i < pairs; ++i) {
    const TreeNode &na = leaf(s.a), &nb = leaf(s.b);
    const Between w = between(k, na, nb);
    if (!(w.error < 1e30f)) continue;  // overflow: nothing is culled
    const auto ka = random() % na.count, kb = random() % nb.count;
    const LeafBlock &ba = s.a.tree().blocks()[na.first], &bb = s.b.tree().blocks()[nb.first];
    Real3 a_on_a[2], b_on_a[2];
    float a_got[2][3], b_turned[2][3];
    for (int corner = 0; corner < 2; ++corner) {
      const Eigen::Vector3d wa = s.pose_a.apply(vertex(s.a, ba.simplex[ka], corner)),
                            wb = s.pose_b.apply(vertex(s.b, bb.simplex[kb], corner));
      a_on_a[corner] = functional(s.pose_a, na, s.a.tree().unit(), unit, wa);
      b_on_a[corner] = functional(s.pose_a, na, s.a.tree().unit(), unit, wb);
      const Real3 a_on_b = functional(s.pose_b, nb, s.b.tree().unit(), unit, wa);
      const Real3 b_on_b = functional(s.pose_b, nb, s.b.tree().unit(), unit, wb);
      float b_got[3];
      for (int j = 0; j < 3; ++j) {
        a_got[corner][j] = ba.corner[corner][j][ka] * k.ratio_a;
        b_got[j] = bb.corner[corner][j][kb] * k.ratio_b;
      }
      for (int axis = 0; axis < 3; ++axis) {
        b_turned[corner][axis] =
            w.t[axis] + w.r[axis][0] * b_got[0] + w.r[axis][1] * b_got[1] + w.r[axis][2] * b_got[2];
        const float a_turned = w.back[axis] + w.r[0][axis] * a_got[corner][0] +
                               w.r[1][axis] * a_got[corner][1] + w.r[2][axis] * a_got[corner][2];
        // Both count: boxes are grown by the error once for the two of them.
        const Real on_a = abs(a_on_a[corner][axis] - Real(a_got[corner][axis])) +
                          abs(b_on_a[corner][axis] - Real(b_turned[corner][axis]));
        const Real on_b = abs(b_on_b[axis] - Real(b_got[axis])) + abs(a_on_b[axis] - Real(a_turned));
        const Real off = s.rotations && on_b > on_a ? on_b : on_a;
        worst.corners = std::max(worst.corners, static_cast<double>(off / Real(w.error)));
      }
    }
    worst.edges = std::max(worst.edges, share_of_edges(a_on_a, a_got, b_on_a, b_turned, w));
  }
  return worst;
}

using test::closed;
using test::stretched;

}  // namespace

TEST_CASE("boxes and balls contain all simplices below them, at any scale, aspect and offset") {
  const double kScales[] = {1, 1e-12, 1e120, 1e-120, 1e-310, 1e-320, 1e300};
  for (const Mesh& m : {shapes::bumpy_sphere(2, 1), shapes::comb(5), shapes::torus(12, 8), shapes::gear(20)})
    for (const double scale : kScales) {
      check_tree(closed(shapes::scaled(m, scale)));
      check_tree(closed(stretched(m, Eigen::Vector3d(1, 1e-8, m.dim == 2 ? 0 : 1e-4) * scale)));
      if (m.dim == 3) check_tree(closed(shapes::translated(m, {1e8, -1e16 * (scale < 1), 3})));
    }
}

TEST_CASE("a tree of coincident or collinear simplices") {
  check_tree(closed(shapes::scaled(shapes::icosphere(1), 0)));
  check_tree(closed(stretched(shapes::icosphere(1), {1, 0, 0})));
  check_tree(closed(shapes::translated(stretched(shapes::icosphere(1), {0, 0, 1e-15}), {1, 1, 1})));
}

TEST_CASE("the kernel's error covers rotation, translation, rounding and odd matrices") {
  RandomEngine random(7);
  Shares worst;
  for (int i = 0; i < 400; ++i) {
    const double kSizes[] = {1, 1, 1e-12, 1e12, 1e-60};
    const Mesh m = shapes::bumpy_sphere(1, static_cast<std::uint64_t>(i % 5));
    const double size = kSizes[i % 5];
    BoundsScene s{closed(m), closed(shapes::scaled(shapes::comb(3), size)), {}, {}, i % 7 != 0};
    s.pose_a.r = shapes::random_rotation(random);
    s.pose_b.r = shapes::random_rotation(random);
    const double far = std::pow(10, shapes::uniform(random, -2, 16));
    s.pose_b.t = 3 * shapes::random_direction(random);
    if (i % 2) {
      const Eigen::Vector3d away = far * shapes::random_direction(random);
      s.pose_a.t += away;
      s.pose_b.t += away;
    }
    if (i % 3 == 0) s.pose_b.t += far * shapes::random_direction(random);
    if (!s.rotations) {
      for (Pose* p : {&s.pose_a, &s.pose_b}) {
        p->r *= std::pow(10, shapes::uniform(random, -3, 3));
        p->r(0, 1) += shapes::uniform(random, -1, 1);
      }
    }
    CAPTURE(i);
    const Shares shares = worst_shares(s, random, 30);
    REQUIRE(shares.corners < 1);
    REQUIRE(shares.edges < 1);
    worst = {std::max(worst.corners, shares.corners), std::max(worst.edges, shares.edges)};
  }
  MESSAGE("largest share of the error bounds that was used: " << worst.corners << ", of edges "
                                                              << worst.edges);
  CHECK(worst.corners > 1e-3);  // else nothing was tested
  CHECK(worst.edges > 1e-3);
}
