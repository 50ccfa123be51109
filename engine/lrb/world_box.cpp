/// World AABBs by branch and bound over the OBB tree, once in each of six directions.
///
/// 1. Bound each child of a node along the direction: its box, plus all rounding errors.
/// 2. Visit the child with the largest bound first, and prune those whose bound is below the best vertex.
/// 3. Evaluate vertices with Pose::apply(), as the query does, so that the box is exact.

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb {
namespace {

/// Number of corners up to which transforming all of them is faster. Measured: 2.4 ns per corner; the tree
/// takes 8 to 15 us for bodies of 1,400 to 2,600 corners, 53 us for one of 49,000.
constexpr std::size_t kFewCorners = 16384;

/// Finds the real corner whose world coordinate on one axis, times `sign`, is largest.
///
/// With d the axis's row of the rotation, a child's box (frame coordinates y in [lo, hi]) bounds d . x by d .
/// origin + sum_i max(g_i lo_i, g_i hi_i), g = frame d. Two error terms are added:
/// - kKernelRounding |d| radius, because a node's axes are orthonormal only to kFrameDefect: x - origin =
///   frame^T (1 - E) y + ..., |E| <= kFrameDefect, which takes sqrt 3 of the available 8 kFrameDefect;
/// - the rounding of world coordinates: Pose::apply() and this sum take less than 16 u of the 32 u in
///   kWorldRounding.
class Search {
 public:
  Search(const LrbRep& rep, const Pose& pose, int axis, double sign)
      : rep_(rep), pose_(pose), axis_(axis), sign_(sign) {
    // The coordinate of x, in the tree's units, is d_ . x + t_; `sign` turns a minimum into a maximum.
    d_ = sign * rep.tree().unit() * pose.r.row(axis).transpose();
    t_ = sign * pose.t[axis];
    // Bound on every term of the coordinate, to which its rounding is relative.
    const double size = pose.r.row(axis).cwiseAbs().sum() * rep.tree().extent() + std::abs(pose.t[axis]);
    slack_ = kWorldRounding * size + kWorldUnderflow;
  }

  /// Runs the search, starting with the vertex `first`; kNull: none.
  void run(VertexId first) {
    if (first != kNull) look_at(first);
    visit(0);
  }
  /// Returns false as soon as a corner reaches `limit` (times the sign), true if none does.
  bool stays_below(double limit, VertexId first) {
    enough_ = limit;
    run(first);
    return best_ < limit;
  }
  VertexId vertex() const { return vertex_; }
  double coordinate() const { return sign_ * best_; }

 private:
  void look_at(VertexId v) {
    const double x = sign_ * pose_.apply(rep_.vertices()[v])[axis_];
    if (!(x > best_)) return;
    best_ = x;
    vertex_ = v;
  }

  void look_at_simplex(SimplexId s) {
    VertexId v[3];
    rep_.simplex(s, v);
    for (int k = 0; k < rep_.simplex_size(); ++k) look_at(v[k]);
  }

  void visit(std::uint32_t index) {
    const TreeNode& node = rep_.tree().nodes()[index];
    std::array<double, kTreeWidth> bound{};
    bounds(node, bound);
    for (std::uint32_t turn = 0; turn < node.count; ++turn) {
      // Best bound first: the vertex found there prunes most of the others.
      const auto k = static_cast<std::uint32_t>(std::max_element(bound.begin(), bound.begin() + node.count) -
                                                bound.begin());
      // No remaining child can reach further, or the caller's limit is reached.
      if (!(bound[k] > best_) || best_ >= enough_) return;
      // Mark as visited.
      bound[k] = -kInfinity;
      if (node.is_leaf)
        look_at_simplex(rep_.tree().blocks()[node.first].simplex[k]);
      else
        visit(node.first + k);
    }
  }

  void bounds(const TreeNode& n, std::array<double, kTreeWidth>& out) const {
    // The terms shared by all children, and all rounding errors.
    double centre = t_ + slack_ + kKernelRounding * d_.cwiseAbs().sum() * n.radius;
    double g[3];
    for (int i = 0; i < 3; ++i) {
      g[i] = n.frame[i][0] * d_[0] + n.frame[i][1] * d_[1] + n.frame[i][2] * d_[2];
      centre += d_[i] * n.origin[i] + g[i] * n.base[i];
      g[i] *= n.scale[i];
    }
    for (std::uint32_t k = 0; k < n.count; ++k) {
      out[k] = centre;
      // The corner of the child's box that is furthest along the direction.
      for (int i = 0; i < 3; ++i) out[k] += g[i] * (g[i] > 0 ? n.hi[i][k] : n.lo[i][k]);
    }
  }

  const LrbRep& rep_;
  const Pose& pose_;
  int axis_;
  double sign_;
  Eigen::Vector3d d_;  ///< from units to mesh units
  double t_, slack_;
  double best_ = -kInfinity, enough_ = kInfinity;
  VertexId vertex_ = kNull;
};

/// Returns true if no coordinate, and no term in its computation, can overflow.
bool stays_finite(const LrbRep& rep, const Pose& pose) {
  return world_size(pose, rep.tree()) <= 0.25 * std::numeric_limits<double>::max();
}

Eigen::AlignedBox3d everything() {
  return {Eigen::Vector3d::Constant(-kInfinity), Eigen::Vector3d::Constant(kInfinity)};
}

/// Returns the world AABB of a body whose world coordinates are known to be finite, by transforming all
/// corners.
Eigen::AlignedBox3d box_of_corners(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(pose.apply(rep.vertices()[v]));
  return box;
}

}  // namespace

/// If two boxes are disjoint along an axis, any two of their corners have the order of the boxes there.
bool world_boxes_are_disjoint(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  const FloatMode float_mode;
  if (a.tree().empty() || b.tree().empty()) return true;
  const bool in_range = stays_finite(a, pose_a) && stays_finite(b, pose_b);
  Eigen::AlignedBox3d box_a, box_b;
  // Near overflow the bounds of the tree are useless: compare the boxes of all corners.
  if (!in_range) {
    box_a = box_of_corners(a, pose_a);
    box_b = box_of_corners(b, pose_b);
  }
  const VertexId first_a = a.face(0)[0], first_b = b.face(0)[0];
  const Eigen::Vector3d of_a = pose_a.apply(a.vertices()[first_a]),
                        of_b = pose_b.apply(b.vertices()[first_b]);
  for (int axis = 0; axis < a.dim(); ++axis) {
    if (!in_range) {
      if (box_a.max()[axis] < box_b.min()[axis] || box_b.max()[axis] < box_a.min()[axis]) return true;
      continue;
    }
    // The intervals share a coordinate.
    if (of_a[axis] == of_b[axis]) continue;
    // The only possible order of the bodies, given by any two corners.
    const double sign = of_a[axis] < of_b[axis] ? 1 : -1;
    Search top_of_a(a, pose_a, axis, sign), bottom_of_b(b, pose_b, axis, -sign);
    // Stops at A's first corner beyond B's; B is searched only if there is none.
    if (top_of_a.stays_below(sign * of_b[axis], first_a) &&
        bottom_of_b.stays_below(-sign * top_of_a.coordinate(), first_b))
      return true;
  }
  return false;
}

Eigen::AlignedBox3d world_box(const LrbRep& rep, const Pose& pose, ExtremeVertices* last) {
  const FloatMode float_mode;
  Eigen::AlignedBox3d box;
  if (rep.tree().empty()) return box;
  if (!stays_finite(rep, pose)) return everything();
  for (int axis = 0; axis < 3; ++axis) {
    // A 2D body is at one height, so any corner gives it.
    const bool level = rep.dim() == 2 && pose.r(axis, 0) == 0 && pose.r(axis, 1) == 0;
    if (level) {
      box.min()[axis] = box.max()[axis] = pose.apply(rep.vertices()[rep.face(0)[0]])[axis];
      continue;
    }
    for (const bool high : {false, true}) {
      const auto slot = static_cast<std::size_t>(2 * axis + high);
      // The extreme vertex of the last pose is a good initial bound.
      Search search(rep, pose, axis, high ? 1 : -1);
      search.run(last != nullptr ? last->vertex[slot] : kNull);
      (high ? box.max() : box.min())[axis] = search.coordinate();
      if (last != nullptr) last->vertex[slot] = search.vertex();
    }
  }
  return box;
}

BodyExtent::BodyExtent(const LrbRep& rep) : rep_(&rep) {
  std::vector<bool> is_corner(rep.vertices().size());
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) is_corner[v] = true;
  const auto count = static_cast<std::size_t>(std::count(is_corner.begin(), is_corner.end(), true));
  // A large body: leave corners_ empty and search the tree.
  if (count > kFewCorners) return;
  for (VertexId v = 0; v < is_corner.size(); ++v)
    if (is_corner[v]) corners_.push_back(rep.vertices()[v]);
}

Eigen::AlignedBox3d BodyExtent::in_world(const Pose& pose, ExtremeVertices* last) const {
  const FloatMode float_mode;
  if (corners_.empty()) return world_box(*rep_, pose, last);
  if (!stays_finite(*rep_, pose)) return everything();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : corners_) box.extend(pose.apply(x));
  return box;
}

}  // namespace lrb
