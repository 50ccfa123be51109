/// Point location by the parity of ray crossings, and the relation of two bodies from it.
///
/// 1. locate(): reject points outside the root's box; shoot an axis-parallel ray in the direction that leaves
///    the box soonest; traverse the OBB tree along it; count crossings with exact predicates.
/// 2. decide_without_points(): intersecting pairs decide the relation; so do disjoint boxes of open surfaces.
/// 3. decide_by_enclosure(): otherwise the components inside the other body decide.

#include "engine/collide/relation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/world_box.hpp>

namespace lrb {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The direction of a ray: along a world axis, or opposite to it. All directions give the same parity of
/// crossings.
struct Direction {
  int axis = 0;
  bool backward = false;

  /// Maps a point to the frame in which the ray points along +x. Exact: coordinates are only permuted and
  /// negated.
  void to_ray_frame(const double* x, int dim, double* out) const {
    for (int k = 0; k < dim; ++k) {
      const double value = x[(axis + k) % dim];
      out[k] = k == 0 && backward ? -value : value;
    }
  }
};

/// Traverses the tree along the ray from a point (doubles, or exact::RationalPoint) and counts the simplices
/// that it crosses. `near`: the point rounded to doubles, for box tests.
template <class Point>
class RayWalk {
 public:
  RayWalk(QueryBody& body, const Point& point, const Vector3d& near)
      : body_(body), tree_(body.tree()), dim_(body.rep().dim()), point_(point), p_(near) {
    // margin_: rounding of world coordinates and of the point. turn_: largest row sum of the pose's matrix.
    const Pose& pose = body.world.pose();
    margin_ = kWorldRounding * (world_size(pose, tree_) + near.cwiseAbs().maxCoeff() + kWorldUnderflow);
    turn_ = pose.r.cwiseAbs().rowwise().sum().maxCoeff();
  }

  Where run() {
    const TreeNode& root = tree_.nodes()[0];
    const Frame f = frame_of(root);
    const Bounds whole = bounds_of(root, f);
    // Points outside the root's box need no ray: first the world AABB, then the tighter OBB.
    if (is_beside(whole) || (dim_ == 3 && is_beside_oriented(root, f))) return Where::outside;
    if constexpr (kMayTurn) choose_direction(whole);
    visit(0);
    // An odd number of crossings: inside.
    return on_surface_ ? Where::on_surface : crossings_ % 2 ? Where::inside : Where::outside;
  }

  /// See has_solid_beside(). The faces at the point separate two sides of the same parity if their number is
  /// even. The ray starts on one of these sides, and crosses all or none of them.
  std::optional<bool> beside() {
    passes_surface_ = true;
    visit(0);
    if (on_surface_) return std::nullopt;
    return faces_here_ % 2 == 1 || crossings_ % 2 == 1;
  }

 private:
  /// Rays of rational points run in direction +x.
  static constexpr bool kMayTurn = std::is_same_v<Point, const double*>;

  /// The axes and origin of a node in the world.
  struct Frame {
    Matrix3d axes;
    Vector3d origin;
    double grow;  ///< margin of boxes, covers all errors
  };

  /// An axis-aligned box in the world.
  struct Bounds {
    Vector3d centre, half;
  };

  Frame frame_of(const TreeNode& n) const {
    const Pose& pose = body_.world.pose();
    const double unit = tree_.unit();
    Frame f;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f.axes(j, i) = n.frame[i][j];
    // Columns are the node's axes in the world, scaled to the mesh's unit.
    f.axes = pose.r * f.axes * unit;
    f.origin = pose.r * (Vector3d(n.origin[0], n.origin[1], n.origin[2]) * unit) + pose.t;
    f.grow = margin_ + kKernelRounding * turn_ * (static_cast<double>(n.radius) * unit);
    return f;
  }

  /// Returns the world AABB of all boxes of a node. Conservative, as the kernel's boxes are.
  static Bounds bounds_of(const TreeNode& n, const Frame& f) {
    Vector3d centre, half;
    for (int i = 0; i < 3; ++i) {
      half[i] = n.scale[i] * 0.5 * kQuantizedMost;
      centre[i] = n.base[i] + half[i];
    }
    // World AABB of an OBB: |axes| half (Arvo, "Transforming Axis-Aligned Bounding Boxes", 1990).
    return {f.origin + f.axes * centre, f.axes.cwiseAbs() * half + Vector3d::Constant(f.grow)};
  }

  /// Returns true if the point is proven to be outside a box.
  bool is_beside(const Bounds& b) const {
    bool beside = false;
    for (int k = 0; k < dim_; ++k) beside |= std::abs(b.centre[k] - p_[k]) > b.half[k];
    return beside;
  }

  /// Returns true if the point is proven to be beyond a side of a node's own box. A separating plane is a
  /// proof whatever its direction's errors: the box's extent along it is bounded by the half axes and `grow`.
  bool is_beside_oriented(const TreeNode& n, const Frame& f) const {
    Vector3d centre = f.origin, half[3];
    for (int i = 0; i < 3; ++i) {
      const double scale = n.scale[i], midpoint = n.base[i] + scale * 0.5 * kQuantizedMost;
      centre += f.axes.col(i) * midpoint;
      half[i] = f.axes.col(i) * (scale * 0.5 * kQuantizedMost);
    }
    const Vector3d towards = p_ - centre;
    const auto is_beyond = [&](const Vector3d& d) {
      constexpr double kFarFromUnderflow = 0x1p-960;
      const double errors = f.grow * d.cwiseAbs().sum();
      // This near to underflow, products have no relative error bound.
      if (!(errors > kFarFromUnderflow)) return false;
      // Separating axis: the centre is further away along d than the box reaches.
      return std::abs(d.dot(towards)) >
             std::abs(d.dot(half[0])) + std::abs(d.dot(half[1])) + std::abs(d.dot(half[2])) + errors;
    };
    const Matrix3d axes = f.axes / tree_.unit();  // about as long as 1
    for (int i = 0; i < 3; ++i)
      // Normals of the sides; for sheared boxes these differ from the axes.
      if (is_beyond(axes.col(i).cross(axes.col((i + 1) % 3)))) return true;
    return false;
  }

  /// Chooses the direction in which the ray leaves the body's box soonest.
  void choose_direction(const Bounds& whole) {
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < dim_; ++axis)
      for (const bool backward : {false, true}) {
        const double beyond = p_[axis] - whole.centre[axis];
        // Distance to the side of the box where a ray in this direction leaves it.
        const double left = whole.half[axis] + (backward ? beyond : -beyond);
        if (!(left < least)) continue;
        least = left;
        direction_ = {axis, backward};
      }
    direction_.to_ray_frame(point_, dim_, seen_);
  }

  /// Returns a bit for each child or simplex of a node that the ray may meet: it is proven to miss the world
  /// AABBs of the boxes of all others.
  std::uint32_t met(const TreeNode& n) const {
    const Frame f = frame_of(n);
    // All boxes at once, in structure-of-arrays layout.
    double centre[3][kTreeWidth], half[3][kTreeWidth];
    for (int i = 0; i < 3; ++i)
      for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
        const double step = 0.5 * n.scale[i];
        centre[i][k] = n.base[i] + step * (n.lo[i][k] + n.hi[i][k]);
        half[i][k] = step * (n.hi[i][k] - n.lo[i][k]);
      }
    double beyond[kTreeWidth];  // the largest distance to the interval of a box on an axis
    std::fill(std::begin(beyond), std::end(beyond), -std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < dim_; ++axis) {
      const double x = f.axes(axis, 0), y = f.axes(axis, 1), z = f.axes(axis, 2);
      double offset[kTreeWidth];  // > 0: the centre of the box lies ahead on this axis
      for (std::uint32_t k = 0; k < kTreeWidth; ++k)
        offset[k] = f.origin[axis] - p_[axis] + x * centre[0][k] + y * centre[1][k] + z * centre[2][k];
      // Across the ray, the point must lie within the box's interval; along it, the box must not lie behind.
      const double sign = direction_.backward ? 1 : -1;
      for (std::uint32_t k = 0; k < kTreeWidth; ++k)
        offset[k] = axis != direction_.axis ? std::abs(offset[k]) : sign * offset[k];
      for (std::uint32_t k = 0; k < kTreeWidth; ++k)
        beyond[k] = std::max(beyond[k], offset[k] - (std::abs(x) * half[0][k] + std::abs(y) * half[1][k] +
                                                     std::abs(z) * half[2][k] + f.grow));
    }
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < n.count; ++k) bits |= static_cast<std::uint32_t>(!(beyond[k] > 0)) << k;
    return bits;
  }

  void visit(std::uint32_t index) {
    const TreeNode& n = tree_.nodes()[index];
    for (std::uint32_t bits = met(n); bits != 0 && !on_surface_; bits &= bits - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (n.is_leaf)
        cross(tree_.blocks()[n.first].simplex[k]);
      else
        visit(n.first + k);
    }
  }

  void cross(SimplexId s) {
    const double* corners[3];
    body_.world.corners(s, corners);
    exact::RayHit hit;
    // The exact predicate knows only the direction +x: map the corners to the ray's frame.
    if constexpr (kMayTurn) {
      double seen[3][3];
      for (int k = 0; k < dim_; ++k) {
        direction_.to_ray_frame(corners[k], dim_, seen[k]);
        corners[k] = seen[k];
      }
      hit = dim_ == 3 ? exact::ray_crosses(seen_, corners) : exact::ray_crosses_2d(seen_, corners);
    } else {
      hit = dim_ == 3 ? exact::ray_crosses(point_, corners) : exact::ray_crosses_2d(point_, corners);
    }
    if constexpr (!kMayTurn)
      if (passes_surface_ && hit == exact::RayHit::on_face) {
        ++faces_here_;
        on_surface_ |= !is_strictly_inside(corners);
        return;
      }
    on_surface_ |= hit == exact::RayHit::on_face;
    crossings_ += hit == exact::RayHit::crosses;
  }

  /// Returns true if the point, which is on a triangle, is on none of its edges, and the triangle is in the
  /// plane of those seen before.
  bool is_strictly_inside(const double* const corners[3]) {
    Vector3d x[3];
    for (int k = 0; k < 3; ++k) x[k] = Eigen::Map<const Vector3d>(corners[k]);
    if (faces_here_ == 1) std::copy(std::begin(x), std::end(x), current_);
    for (const Vector3d& corner : x)
      if (exact::orient3d(current_[0].data(), current_[1].data(), current_[2].data(), corner.data()) != 0)
        return false;
    // A point beside the plane: along an axis that is not parallel to it.
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d offset = x[0];
      offset[axis] += (x[1] - x[0]).cwiseAbs().maxCoeff() + (x[2] - x[0]).cwiseAbs().maxCoeff();
      if (exact::orient3d(corners[0], corners[1], corners[2], offset.data()) == 0) continue;
      for (int k = 0; k < 3; ++k)
        if (exact::orient3d(corners[k], corners[(k + 1) % 3], offset.data(), point_) == 0) return false;
      return true;
    }
    return false;
  }

  QueryBody& body_;
  const ObbTree& tree_;
  const int dim_;
  const Point& point_;
  Vector3d p_;
  Direction direction_;
  double seen_[3];  ///< the point in the frame of direction_
  double margin_, turn_;
  int crossings_ = 0;
  bool on_surface_ = false;
  bool passes_surface_ = false;  ///< for beside()
  int faces_here_ = 0;           ///< that contain the point
  Vector3d current_[3];          ///< corners of the first one
};

}  // namespace

Where locate(QueryBody& body, const double* point) {
  if (body.tree().empty()) return Where::outside;
  return RayWalk<const double*>(body, point, {point[0], point[1], body.rep().dim() == 3 ? point[2] : 0})
      .run();
}

Where locate(QueryBody& body, const exact::RationalPoint& point) {
  return body.tree().empty() ? Where::outside : RayWalk(body, point, point.rounded()).run();
}

std::optional<bool> has_solid_beside(QueryBody& body, const exact::RationalPoint& point) {
  return body.tree().empty() ? false : RayWalk(body, point, point.rounded()).beside();
}

bool decide_without_points(QueryContext& ctx, CollideResult& result) {
  const bool solids = ctx[Side::a].rep().closed() && ctx[Side::b].rep().closed();
  if (result.pairs.empty() && solids) return false;
  // A surface that is not closed has no inside: only disjoint world boxes decide.
  if (result.pairs.empty()) {
    const QueryBody &a = ctx[Side::a], &b = ctx[Side::b];
    const bool apart = world_boxes_are_disjoint(a.rep(), a.world.pose(), b.rep(), b.world.pose());
    result.relation = apart ? Relation::separate : Relation::undefined;
    result.interiors_overlap = apart ? Answer::no : Answer::unknown;
    return true;
  }
  const bool crosses =
      std::find(result.meets.begin(), result.meets.end(), exact::Meet::cross) != result.meets.end();
  result.relation = crosses ? Relation::crossing : Relation::touching;
  // Closed bodies that cross overlap, unless rounding flattened one of them: crossing_interiors_overlap()
  // checks that.
  result.interiors_overlap = crosses && solids ? Answer::yes : Answer::unknown;
  return true;
}

void decide_by_enclosure(const Enclosed& a_in_b, const Enclosed& b_in_a, CollideResult& result) {
  // Entirely enclosed bodies take precedence. The surfaces do not intersect, so that one vertex decides for
  // its component.
  if (a_in_b.all())
    result.relation = Relation::a_inside_b;
  else if (b_in_a.all())
    result.relation = Relation::b_inside_a;
  else if (a_in_b.some())
    result.relation = Relation::a_inside_b;
  else if (b_in_a.some())
    result.relation = Relation::b_inside_a;
  else
    result.relation = Relation::separate;
  result.interiors_overlap = result.relation == Relation::separate ? Answer::no : Answer::yes;
}

void decide_relation(QueryContext& ctx, CollideResult& result) {
  decide_relation(ctx, result, [] { return true; });
}

}  // namespace lrb
