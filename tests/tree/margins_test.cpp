// Derived bounds on rounding: of a filter, of moving bodies, and of kernels, against arithmetic of 60 digits.
#include "tests/support/margins.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "engine/construct/embed_check.hpp"
#include "engine/core/geometry.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/motion/motion_bounds.hpp"
#include "engine/tree/kernel_setup.hpp"
#include "tests/support/bodies.hpp"

namespace lrb::margins {
namespace {

using Eigen::Vector3d;
using test::vector_of;
using Real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>, boost::multiprecision::et_off>;
using Genes = std::span<const double>;

/// Coordinates of 0 and 1.
const LrbRep& body() {
  static const LrbRep rep = test::closed(shapes::tetrahedron());
  return rep;
}

/// Up to 1e12.
Vector3d far(Genes genes) {
  return std::exp2(40 * genes[3]) * vector_of(genes);
}

/// A coordinate of a point at a pose, exactly.
Real placed(const Pose& pose, const Vector3d& x, int i) {
  Real out = pose.t[i];
  for (int j = 0; j < 3; ++j) out += Real(pose.r(i, j)) * Real(x[j]);
  return out;
}

double share_of_determinant(Genes genes) {
  const Vector3d p[] = {vector_of(genes), vector_of(genes.subspan(3)), vector_of(genes.subspan(6)),
                        vector_of(genes.subspan(9))};
  const auto found = exact::PlaneSide(p[0].data(), p[1].data(), p[2].data()).determinant(p[3].data());
  Real d[3][3], det = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) d[i][k] = Real(p[i + 1][k]) - Real(p[0][k]);
  for (int k = 0; k < 3; ++k)
    det += d[2][k] * (d[0][(k + 1) % 3] * d[1][(k + 2) % 3] - d[0][(k + 2) % 3] * d[1][(k + 1) % 3]);
  return static_cast<double>(abs(Real(found.value) - det) / Real(found.error));
}

/// Two triangles far from the origin that turn about the x axis and travel across it, so that exactly, B's
/// corners stay ahead of A's along x by the same amount.
double share_of_separation(Genes genes) {
  const Vector3d centre = far(genes), x = Vector3d::UnitX();
  Motion motion[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const Genes g = genes.subspan(4 + 7 * side);
    motion[side] =
        Motion::turning(Pose::rotation(vector_of(g), 6 * g[3], centre + vector_of(genes.subspan(20))),
                        3 * g[4] * x, centre, {0, g[5], g[6]});
  }
  const MovingBody a(body(), motion[0].pieces()[0]), b(body(), motion[1].pieces()[0]);
  PairMotion pair(a, b, {SimplexId(0), SimplexId(0)});
  pair.place(a.at(genes[18]), b.at(genes[18]));
  VertexId v[3];
  body().simplex(SimplexId(0), v);
  Real most = 0;
  for (const VertexId i : v)
    for (const VertexId j : v) {
      const Vector3d &of_a = body().vertices()[i], &of_b = body().vertices()[j];
      const auto ahead = [&](double t) {
        return Real(b.at(t).pose.apply(of_b).x()) - Real(a.at(t).pose.apply(of_a).x());
      };
      const Real exact = placed(b.piece().first, of_b, 0) + Real(b.piece().from.x()) -
                         placed(a.piece().first, of_a, 0) - Real(a.piece().from.x());
      const Real now = ahead(genes[18]);
      most = std::max({most, Real(abs(now - exact)), Real(abs(now - ahead(genes[19])))});
    }
  return static_cast<double>(most / Real(pair.places_rounding(x)));
}

/// Points of two bodies under any maps that have the same world coordinates, on A's axes.
double share_of_affine_slack(Genes genes) {
  Pose pose[2];
  for (int k = 0; k < 18; ++k) pose[k / 9].r(k % 9 / 3, k % 3) = 2 * genes[static_cast<std::size_t>(k)] - 1;
  const Vector3d x[2] = {vector_of(genes.subspan(18)), vector_of(genes.subspan(21))};
  pose[0].t = far(genes.subspan(24));
  pose[1].t = pose[0].apply(x[0]) - pose[1].r * x[1];
  AffineTerms terms;
  const ObbTree& tree = body().tree();
  const TreeKernel k = set_up_affine_kernel(tree, pose[0], tree, pose[1], 3, terms);
  const AffineMap map(pose[0], tree, 3);
  const AffineTerms::Axes& axes = terms.axes[0];
  // Their world coordinates still differ by rounding: A's point is moved by that.
  const Vector3d w[2] = {pose[0].apply(x[0]), pose[1].apply(x[1])};
  Real most = 0;
  for (int i = 0; i < 3; ++i) {
    Real off = -Real(axes.origin[i]);
    for (int j = 0; j < 3; ++j)
      off += (Real(axes.flat ? axes.own.columns[j][i] : i == j) * Real(x[0][j]) * k.ratio_a -
              Real(axes.other.columns[j][i]) * Real(x[1][j]) * k.ratio_b) /
                 Real(tree.unit()) -
             Real(map.back(i, j)) * ldexp(Real(w[0][j]) - Real(w[1][j]), -terms.exponent);
    most = std::max(most, Real(abs(off)));
  }
  return static_cast<double>(most / Real(axes.slack));
}

/// Rounding moves corners of two bodies relative to each other by less than what wrappers add to the slack.
double share_of_wrapper_slack(Genes genes) {
  const Vector3d x[2] = {body().vertices()[1], body().vertices()[2]};
  Pose pose[2];
  for (std::size_t side = 0; side < 2; ++side)
    pose[side] =
        Pose::rotation(vector_of(genes.subspan(4 * side)), 6 * genes[3 + 4 * side], far(genes.subspan(8)));
  const ObbTree& tree = body().tree();
  TreeKernel k = set_up_kernel(tree, pose[0], tree, pose[1]);
  const double before = k.slack;
  allow_for_wrappers(k);
  Real square = 0;
  for (int i = 0; i < 3; ++i) {
    const Real off = (Real(pose[0].apply(x[0])[i]) - placed(pose[0], x[0], i)) -
                     (Real(pose[1].apply(x[1])[i]) - placed(pose[1], x[1], i));
    square += off * off;
  }
  return static_cast<double>(sqrt(square)) / tree.unit() / (k.slack - before);
}

/// Points in the plane of a triangle, with whole coordinates.
double share_of_triangle_plane(Genes genes) {
  const auto whole = [&](Genes g) { return Vector3d((0x1p40 * vector_of(g)).array().round()); };
  const Vector3d a = whole(genes), u = whole(genes.subspan(3)), v = u + whole(genes.subspan(6)), b = a + u,
                 c = a + v;
  construct::CheckedTriangle triangle;
  triangle.x = {a.data(), b.data(), c.data()};
  const Vector3d way = std::round(9 * genes[9] - 4) * u + std::round(9 * genes[10] - 4) * v;
  const double bound = construct::TriangleReach(triangle).slack() * norm3(way);
  return bound > 0 ? std::abs(dot3(u.cross(v), way)) / bound : 0;
}

}  // namespace

TEST_CASE("margins are needed, and suffice") {
  // The last four are sums of bounds that do not occur at once, with factors for safety.
  const test::Margin rows[] = {{"determinant of four points", 12, share_of_determinant, 0.35},
                               {"separation of moving bodies", 23, share_of_separation, 0.05, 3000},
                               {"affine maps", 28, share_of_affine_slack, 0.01, 6000},
                               {"wrappers", 12, share_of_wrapper_slack, 0.004, 6000},
                               {"plane of a triangle", 11, share_of_triangle_plane, 0.00015, 6000}};
  test::check_margins(rows);
}

}  // namespace lrb::margins
