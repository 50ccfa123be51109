#include "engine/query/walk/relation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/tree/pose_bounds.hpp"

namespace lrb {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Walks the tree along the ray from a point (doubles, or exact::RationalPoint) in direction +x and counts
/// the simplices that it crosses. `near` is the point rounded to doubles, for the boxes.
template <class Point>
class RayWalk {
 public:
  RayWalk(QueryBody& body, const Point& point, const Vector3d& near)
      : body_(body), tree_(body.tree()), point_(point), p_(near) {
    const Pose& pose = body.world.pose();
    margin_ = kWorldRounding * (world_size(pose, tree_) + near.cwiseAbs().maxCoeff() + kWorldUnderflow);
    turn_ = pose.r.cwiseAbs().rowwise().sum().maxCoeff();
  }

  Where run() {
    if (!misses_all()) visit(0);
    return on_surface_ ? Where::on_surface : crossings_ % 2 ? Where::inside : Where::outside;
  }

 private:
  /// The axes and origin of a node in the world.
  struct Frame {
    Matrix3d axes;
    Vector3d origin;
    double grow;  ///< by how much boxes grow to cover all errors
  };

  Frame frame_of(const TreeNode& n) const {
    const Pose& pose = body_.world.pose();
    const double unit = tree_.unit();
    Frame f;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f.axes(j, i) = n.frame[i][j];
    f.axes = pose.r * f.axes * unit;
    f.origin = pose.r * (Vector3d(n.origin[0], n.origin[1], n.origin[2]) * unit) + pose.t;
    f.grow = margin_ + kKernelRounding * turn_ * (static_cast<double>(n.radius) * unit);
    return f;
  }

  /// Returns true if the ray certainly misses a box whose quantized ends are `lo` and `hi`. Conservative, as
  /// the kernel's boxes are.
  template <class Lo, class Hi>
  bool misses(const TreeNode& n, const Frame& f, const Lo& lo, const Hi& hi) const {
    Vector3d centre, half;
    for (int i = 0; i < 3; ++i) {
      const double base = n.base[i], scale = n.scale[i];
      centre[i] = base + scale * 0.5 * (lo(i) + hi(i));
      half[i] = scale * 0.5 * (hi(i) - lo(i));
    }
    const Vector3d c = f.origin + f.axes * centre;
    const Vector3d h = f.axes.cwiseAbs() * half + Vector3d::Constant(f.grow);
    return c.x() + h.x() < p_[0] || std::abs(c.y() - p_[1]) > h.y() ||
           (body_.rep().dim() == 3 && std::abs(c.z() - p_[2]) > h.z());
  }

  /// Returns true if the ray misses the whole body, as most do: the root's box, as it lies along the world's axes
  /// or as it lies itself.
  bool misses_all() const {
    const TreeNode& root = tree_.nodes()[0];
    const Frame f = frame_of(root);
    return misses(
               root, f, [](int) { return 0; }, [](int) { return kQuantizedMost; }) ||
           (body_.rep().dim() == 3 && misses_oriented(root, f));
  }

  /// Returns true if a plane parts the ray from a node's whole box: one along a side of the box, or one along the
  /// ray and an edge of it. Any direction proves what it shows, however it came about: the box may reach across it
  /// by what its half axes and `grow` allow, and the ray from its beginning on, on that side to which it goes.
  bool misses_oriented(const TreeNode& n, const Frame& f) const {
    Vector3d centre = f.origin, half[3];
    for (int i = 0; i < 3; ++i) {
      const double scale = n.scale[i], middle = n.base[i] + scale * 0.5 * kQuantizedMost;
      centre += f.axes.col(i) * middle;
      half[i] = f.axes.col(i) * (scale * 0.5 * kQuantizedMost);
    }
    const Vector3d way = p_ - centre;
    const auto parts = [&](const Vector3d& d) {
      constexpr double kFarFromUnderflow = 0x1p-960;
      const double errors = f.grow * d.cwiseAbs().sum();
      if (!(errors > kFarFromUnderflow)) return false;
      const double gap = d.dot(way), reach = std::abs(d.dot(half[0])) + std::abs(d.dot(half[1])) +
                                             std::abs(d.dot(half[2])) + errors;
      return (d.x() >= 0 && gap > reach) || (d.x() <= 0 && -gap > reach);
    };
    const Matrix3d axes = f.axes / tree_.unit();  // about as long as 1
    for (int i = 0; i < 3; ++i)
      if (parts(axes.col(i).cross(axes.col((i + 1) % 3))) || parts({0, -axes(2, i), axes(1, i)})) return true;
    return false;
  }

  void visit(std::uint32_t index) {
    const TreeNode& n = tree_.nodes()[index];
    if (n.is_leaf) {
      const LeafBlock& block = tree_.blocks()[n.first];
      for (int k = 0; k < n.count && !on_surface_; ++k) cross(block.simplex[k]);
      return;
    }
    const Frame f = frame_of(n);
    for (std::uint32_t k = 0; k < n.count && !on_surface_; ++k)
      if (!misses(
              n, f, [&](int i) { return n.lo[i][k]; }, [&](int i) { return n.hi[i][k]; }))
        visit(n.first + k);
  }

  void cross(SimplexId s) {
    const double* corners[3];
    body_.world.corners(s, corners);
    const exact::RayHit hit =
        body_.rep().dim() == 3 ? exact::ray_crosses(point_, corners) : exact::ray_crosses_2d(point_, corners);
    on_surface_ |= hit == exact::RayHit::on_face;
    crossings_ += hit == exact::RayHit::crosses;
  }

  QueryBody& body_;
  const ObbTree& tree_;
  const Point& point_;
  Vector3d p_;
  double margin_, turn_;
  int crossings_ = 0;
  bool on_surface_ = false;
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

bool decide_without_points(QueryContext& ctx, CollideResult& result) {
  const bool solids = ctx[Side::a].rep().closed() && ctx[Side::b].rep().closed();
  if (result.pairs.empty() && solids) return false;
  if (result.pairs.empty()) {
    result.relation = Relation::undefined;
    result.interiors_overlap = Answer::unknown;
    return true;
  }
  const bool crosses =
      std::find(result.meets.begin(), result.meets.end(), exact::Meet::cross) != result.meets.end();
  result.relation = crosses ? Relation::crossing : Relation::touching;
  result.interiors_overlap = crosses && solids ? Answer::yes : Answer::unknown;
  return true;
}

void decide_by_enclosure(const Enclosed& a_in_b, const Enclosed& b_in_a, CollideResult& result) {
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
