// Setup of the dual traversal: the relative pose, and a bound on all its errors.
// 1. Compute B's pose relative to A, and the deviation of the matrices from rotations.
// 2. Nearly rotations: the rigid kernel, with the bounds derived at kernel_of().
// 3. Otherwise, or if the bodies are so far apart that floats could overflow: the affine kernel
//    (kernel_setup.hpp).

#include "engine/tree/kernel_setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_choice.hpp"

namespace lrb {

// Setup for arbitrary affine maps. kernel_setup.hpp derives the method and its error bounds.
// 1. Write each map as a power of two times a matrix with entries up to 1.
// 2. Invert the matrix; if it is nearly singular, invert a version with raised singular values.
// 3. Choose the query's unit, and express both bodies on the axes of each, and in the world, in that unit.
// 4. Bound the rounding of world coordinates, and transform the bound to each set of axes.

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The exponent of a map of everything to one point: less than any other, while sums of such exponents do not
/// overflow.
constexpr int kNoExponent = -100000;

/// Bound on coordinates in a tree's units: 1, except for bodies near the end of the range of doubles.
constexpr double kMaxUnits = 2;

/// Returns an exponent with x < 2^exponent; that power is at most twice as large as needed.
int exponent_of(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return x == 0 ? kNoExponent : exponent;
}

/// Returns 2^exponent x; usually by a product, which is faster.
template <class Matrix>
Matrix scaled(const Matrix& x, int exponent) {
  // Beyond that, 2^exponent may overflow or underflow although the products do not.
  if (std::abs(exponent) <= 1000) return x * std::ldexp(1.0, exponent);
  return x.unaryExpr([exponent](double c) { return std::ldexp(c, exponent); });
}

/// Returns the part of a map that acts on a 2D body, where z = 0. The third axis is unchanged.
Matrix3d map_in_plane(Matrix3d r) {
  r(2, 2) = r.topLeftCorner<2, 2>().cwiseAbs().maxCoeff();
  return r;
}

/// Returns a bound on the Euclidean norm, at most sqrt 3 times the norm.
double norm_of(const Matrix3d& m) {
  return m.norm() * (1 + kWrapperMargin);
}

Matrix3d raised_inverse(const Matrix3d& r) {
  // A regularised pseudo-inverse: R = U S V^T becomes V S'^-1 U^T with S' bounded from below.
  const Eigen::JacobiSVD<Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d& values = svd.singularValues();
  // A map to a point, or NaN: any G is valid (see the header), so use the identity.
  if (!(values[0] > 0)) return Matrix3d::Identity();
  const Vector3d raised = values.cwiseMax(kFlatness * values[0]);
  return svd.matrixV() * raised.cwiseInverse().asDiagonal() * svd.matrixU().transpose();
}

/// Returns the exponent of the query's unit: that of the larger body in the world, or more if the distance of
/// the bodies would overflow floats.
int query_exponent(const AffineMap& a, const Pose& pose_a, const AffineMap& b, const Pose& pose_b) {
  // Halves, so that the difference cannot overflow. Floats can represent distances of 2^kFarAway units.
  constexpr int kFarAway = 60, kLeast = -1022;
  const double apart = (pose_b.t / 2 - pose_a.t / 2).cwiseAbs().maxCoeff();
  return std::max({a.exponent, b.exponent, exponent_of(apart) - kFarAway, kLeast});
}

void put(const Matrix3d& m, double size, KernelMap& to) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      to.columns[j][i] = m(i, j);
      to.rows[i][j] = static_cast<float>(m(i, j));
    }
  to.size = rounded_up(size);
}

void put(const Vector3d& x, double (&to)[4]) {
  for (int i = 0; i < 3; ++i) to[i] = x[i];
}

/// Returns a bound on every coordinate of the image of coordinates up to 1, and on every term of it.
double row_size(const Matrix3d& r) {
  return r.cwiseAbs().rowwise().sum().maxCoeff();
}

}  // namespace

AffineMap::AffineMap(const Pose& pose, const ObbTree& tree, int dim)
    : r(dim == 2 ? map_in_plane(pose.r) : pose.r) {
  // Step 1: normalise by the largest entry. The power of two moves to the exponent, together with the tree's
  // unit.
  const int e = exponent_of(r.cwiseAbs().maxCoeff());
  exponent = e == kNoExponent ? e : e + std::ilogb(tree.unit());
  if (e != kNoExponent) r = scaled(r, -e);
  // Step 2: size * back_size is the condition number in the Euclidean (Frobenius) norm.
  size = norm_of(r);
  back = r.inverse();
  back_size = norm_of(back);
  flat = !(back_size * size * kFlatness <= 1);  // also true for NaN
  // Nearly singular: use the regularised inverse, under which the own map is not the identity.
  if (flat) {
    back = raised_inverse(r);
    back_size = norm_of(back);
    own = back * r;
    defect = 0;
  } else {
    own = Matrix3d::Identity();
    // The residual of the inverse, as a norm. It is added to the slack below.
    defect = (back * r - own).norm();
  }
}

TreeKernel set_up_affine_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                                int dim, AffineTerms& terms) {
  // Steps 1 and 2 for both bodies, and step 3: the unit.
  const AffineMap maps[2] = {AffineMap(pose_a, a, dim), AffineMap(pose_b, b, dim)};
  const int exponent = query_exponent(maps[0], pose_a, maps[1], pose_b);
  TreeKernel k{};
  k.max_node_pairs = kNoLimit;
  terms = {};
  terms.exponent = exponent;
  k.affine = &terms;
  k.nodes_a = a.nodes().data();
  k.nodes_b = b.nodes().data();
  k.blocks_a = a.blocks().data();
  k.blocks_b = b.blocks().data();
  // Powers of two of at most 1: scaling a tree's coordinates to the query's unit is exact, except for
  // underflow.
  k.ratio_a = std::ldexp(1.0F, maps[0].exponent - exponent);
  k.ratio_b = std::ldexp(1.0F, maps[1].exponent - exponent);
  const float ratios[2] = {k.ratio_a, k.ratio_b};
  const Vector3d t[2] = {scaled(pose_a.t, -exponent), scaled(pose_b.t, -exponent)}, between = t[1] - t[0];
  // Step 4: the rounding of world coordinates, relative to the sum of the largest terms of both bodies.
  double size = std::ldexp(kWorldUnderflow, -exponent);  // bound on every term of a world coordinate
  for (int side = 0; side < 2; ++side)
    size += row_size(maps[side].r) * kMaxUnits * ratios[side] + t[side].cwiseAbs().maxCoeff();
  const double rounding = kWorldRounding * size;
  // For each body: the maps of both bodies to its axes, and the slack there.
  for (int side = 0; side < 2; ++side) {
    const AffineMap &self = maps[side], &other = maps[1 - side];
    AffineTerms::Axes& axes = terms.axes[side];
    const Matrix3d other_map = self.back * other.r;
    const Vector3d origin = self.back * (side == 0 ? between : -between);
    put(other_map, norm_of(other_map), axes.other);
    put(origin, axes.origin);
    axes.flat = self.flat;
    put(self.own, self.flat ? norm_of(self.own) : 1, axes.own);
    // Deviation of the own map from the identity, plus the rounding of the world scaled by G.
    const double deviation = self.defect * kMaxUnits * ratios[side];
    axes.slack = rounded_up(kPoseSafety * (deviation + self.back_size * rounding));
    put(self.r, self.size, terms.world[side]);
    // Only used to choose the node to descend, so rounding does not matter.
    terms.span[side] = static_cast<float>(self.size) * ratios[side];
  }
  put(between, terms.between);
  terms.world_slack = rounded_up(kPoseSafety * rounding);
  return k;
}

InstructionSet best_instruction_set() {
#if defined(__x86_64__)
  const char* const wish = std::getenv("LRB_SIMD");
  const std::string_view most = wish != nullptr ? wish : "";
  // All features with which the AVX-512 kernels are compiled must be present.
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                          __builtin_cpu_supports("popcnt");
  if (most != "baseline" && most != "avx2" && has_avx512) return InstructionSet::avx512;
  if (most != "baseline" && __builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

double rotation_defect(const Eigen::Matrix3d& r) {
  // PropagateNaN, because a plain maximum may skip a NaN and report a small defect.
  return (r.transpose() * r - Eigen::Matrix3d::Identity())
      .cwiseAbs()
      .rowwise()
      .sum()
      .maxCoeff<Eigen::PropagateNaN>();
}

double world_size(const Pose& pose, const ObbTree& tree) {
  return pose.r.cwiseAbs().rowwise().sum().maxCoeff() * tree.extent() + pose.t.cwiseAbs().maxCoeff();
}

double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b) {
  return kWrapperMargin * (world_size(pose_a, a) + world_size(pose_b, b) + kWorldUnderflow);
}

/// Scales by a power of two, which is exact, so that squares are representable in doubles, and back; usually
/// by a product, which is faster.
double stretch(const Pose& pose) {
  // Normalise so that the largest entry is in [0.5, 1).
  int exponent = 0;
  std::frexp(pose.r.cwiseAbs().maxCoeff(), &exponent);
  const Eigen::Matrix3d r = std::abs(exponent) <= 1000
                                ? Eigen::Matrix3d(pose.r * std::ldexp(1.0, -exponent))
                                : pose.r.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
  // The largest row sum of r^T r bounds its spectral norm, which is the square of that of r.
  const double norm = std::sqrt((r.transpose() * r).cwiseAbs().rowwise().sum().maxCoeff());
  const double size = std::ldexp(norm * (1 + kWrapperMargin), exponent);
  // Results near underflow have an absolute rounding error, which the smallest normal double covers.
  return exponent < -1000 ? size + kWorldUnderflow : size;
}

namespace {

/// B's rotation relative to A, with the deviations of it and of A's own matrix from rotations.
struct RelativeTurn {
  Eigen::Matrix3d m;
  double defect_a, defect_m;

  RelativeTurn(const Pose& a, const Pose& b)
      : m(a.r.transpose() * b.r), defect_a(rotation_defect(a.r)), defect_m(rotation_defect(m)) {}

  /// Returns false for NaN.
  bool is_near_rotation() const { return defect_a <= kNearRotation && defect_m <= kNearRotation; }
};

/// Sets up the kernel, which compares boxes on A's axes and on B's. Let w_a = r_a x_a + t_a + rounding and
/// w_b = r_b x_b + t_b + rounding be the world coordinates of a point of each body, and m = r_a^T r_b, t =
/// r_a^T (t_b - t_a), with Euclidean norms. If w_a = w_b:
/// - On A's axes the kernel uses x_a unchanged and m x_b + t for x_b. These differ by at most
///       on_a = D(r_a) |x_a| + |r_a| |rounding|,   D(r) = |r^T r - 1|.
/// - On B's axes it uses x_b unchanged and m^T (x_a - t) for x_a. These differ by at most
///       on_b = D(m) |x_b| + |m| on_a,
///   relative to any point of B (x_b is then a distance of two points of B).
/// |r|^2 <= 1 + D(r). World coordinates are rounded by at most 4 u times the sizes of their terms (u =
/// 2^-53), and m, t and the offsets between nodes by another 16 u of the same sizes. The factor kPoseSafety
/// covers the conversion from the largest coordinate to the Euclidean length (sqrt 3), and from a distance to
/// an extent (2). The bounds hold for any matrix. For one far from a rotation they are so large that little
/// is culled; kernel_setup.hpp has other bounds for those. Overflow makes bounds infinite or NaN: then
/// nothing is culled.
TreeKernel kernel_of(const RelativeTurn& turn, const ObbTree& a, const Pose& pose_a, const ObbTree& b,
                     const Pose& pose_b) {
  TreeKernel k{};
  k.nodes_a = a.nodes().data();
  k.nodes_b = b.nodes().data();
  k.blocks_a = a.blocks().data();
  k.blocks_b = b.blocks().data();
  // Powers of two of at most 1, so scaling to the query's unit is exact.
  const double unit = query_unit(a, b);
  k.ratio_a = static_cast<float>(a.unit() / unit);
  k.ratio_b = static_cast<float>(b.unit() / unit);

  // m is stored twice: in double for the offsets of nodes, in float for the rotation of boxes.
  const Eigen::Matrix3d& m = turn.m;
  const Eigen::Vector3d t = pose_a.r.transpose() * (pose_b.t - pose_a.t) / unit;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      k.m[j][i] = m(i, j);
      k.m_rows[i][j] = static_cast<float>(m(i, j));
    }
    k.t[i] = t[i];
  }
  // The bounds of the derivation above: on_a for A's axes, on_b for B's. One slack covers both.
  const double size = (world_size(pose_a, a) + world_size(pose_b, b) + kWorldUnderflow) / unit;
  const double turn_a = std::sqrt(1 + turn.defect_a), turn_m = std::sqrt(1 + turn.defect_m);
  const double on_a = turn.defect_a * (a.extent() / unit) + turn_a * kWorldRounding * size;
  const double on_b = turn.defect_m * (b.extent() / unit) + turn_m * on_a;
  // Rounded up, because the conversion to float may round down.
  k.slack = static_cast<float>(kPoseSafety * (on_a + on_b)) * kFloatUp + kKernelTiny;
  k.m_size = static_cast<float>(turn_m) * kFloatUp;
  k.max_node_pairs = kNoLimit;
  return k;
}

/// Returns true if the kernel's floats cannot overflow.
bool is_near(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b) {
  return (pose_b.t - pose_a.t).cwiseAbs().maxCoeff() <= kNearEnough * query_unit(a, b);
}

}  // namespace

TreeKernel set_up_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b) {
  return kernel_of({pose_a, pose_b}, a, pose_a, b, pose_b);
}

TreeKernel set_up_any_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                             int dim, AffineTerms& terms) {
  const RelativeTurn turn(pose_a, pose_b);
  return turn.is_near_rotation() && is_near(a, pose_a, b, pose_b)
             ? kernel_of(turn, a, pose_a, b, pose_b)
             : set_up_affine_kernel(a, pose_a, b, pose_b, dim, terms);
}

void start_at_roots(TreeKernel& k, const ObbTree& a, const ObbTree& b, std::vector<NodePair>& room) {
  // One allocation for both stacks, reused by later queries.
  const std::size_t each = stack_room(a.height(), b.height());
  if (room.size() < 2 * each) room.resize(2 * each);
  k.stack = room.data();
  k.tested = k.stack + each;
  start_at(k, {0, 0});
}

bool roots_are_apart(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b) {
  constexpr double kLeastSize = 0x1p-300;  // squares of smaller sizes underflow
  if (a.empty() || b.empty()) return false;
  const TreeNode &root_a = a.nodes()[0], &root_b = b.nodes()[0];
  const auto centre = [](const TreeNode& root, const ObbTree& tree, const Pose& pose) {
    return Eigen::Vector3d(
        pose.r * (Eigen::Vector3d(root.origin[0], root.origin[1], root.origin[2]) * tree.unit()) + pose.t);
  };
  const double square = (centre(root_a, a, pose_a) - centre(root_b, b, pose_b)).squaredNorm();
  const double radii = root_a.radius * a.unit() + root_b.radius * b.unit();
  // Most bodies that intersect are rejected here, at little cost.
  if (!(square > radii * radii)) return false;
  // A near-rotation stretches lengths by at most 1 + kNearRotation / 2.
  const double size = world_size(pose_a, a) + world_size(pose_b, b);
  const double reach = radii * (1 + kNearRotation) + kPoseSafety * kWorldRounding * size;
  return size >= kLeastSize && square > reach * reach && rotation_defect(pose_a.r) <= kNearRotation &&
         rotation_defect(pose_b.r) <= kNearRotation;
}

void allow_for_wrappers(TreeKernel& k) {
  // A larger slack leaves more pairs to the exact tests, and never loses one.
  k.slack *= kWrapperSlack;
  if (k.affine == nullptr) return;
  for (AffineTerms::Axes& axes : k.affine->axes) axes.slack *= kWrapperSlack;
  k.affine->world_slack *= kWrapperSlack;
}

}  // namespace lrb
