#include "engine/query/apart.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

/// Looks for the widest slab between two simplices. Any direction can be tried, however it came about; one too
/// short to be told from rounding proves nothing, nor does an overflow.
class SlabSearch {
 public:
  SlabSearch(const Corners& a, const Corners& b, double margin, double enough)
      : a_(a), b_(b), margin_(margin), enough_(enough) {}

  double widest() const { return widest_; }

  /// True if that is enough.
  bool across(const Vector3d& d) {
    const double length_sq = d.squaredNorm();
    if (!std::isnormal(length_sq)) return false;
    const double length = std::sqrt(length_sq), least = margin_ * length;
    if (!std::isnormal(least)) return false;
    const double a0 = d.dot(a_[0]), a1 = d.dot(a_[1]), a2 = d.dot(a_[2]);
    const double b0 = d.dot(b_[0]), b1 = d.dot(b_[1]), b2 = d.dot(b_[2]);
    const double width = std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}),
                                  std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
    if (width > least) widest_ = std::max(widest_, width / length);
    return widest_ > enough_;
  }

 private:
  const Corners &a_, &b_;
  double margin_, enough_;
  double widest_ = 0;
};

Corners relative_to(const double* origin, const double* const x[3], int dim) {
  Corners c;
  for (int k = 0; k < 3; ++k) {
    const double* p = x[dim == 2 && k == 2 ? 1 : k];
    c[k] = {p[0] - origin[0], p[1] - origin[1], dim == 3 ? p[2] - origin[2] : 0};
  }
  return c;
}

bool search_in_space(SlabSearch& search, const Corners& a, const Corners& b) {
  Vector3d edge_a[3], edge_b[3];
  for (int k = 0; k < 3; ++k) {
    edge_a[k] = a[(k + 1) % 3] - a[k];
    edge_b[k] = b[(k + 1) % 3] - b[k];
  }
  const Vector3d n_a = edge_a[0].cross(edge_a[1]), n_b = edge_b[0].cross(edge_b[1]);
  if (search.across(n_a) || search.across(n_b)) return true;
  for (const Vector3d& e : edge_a)
    for (const Vector3d& f : edge_b)
      if (search.across(e.cross(f))) return true;
  for (int k = 0; k < 3; ++k)
    if (search.across(n_a.cross(edge_a[k])) || search.across(n_b.cross(edge_b[k]))) return true;
  return false;
}

bool search_in_plane(SlabSearch& search, const Corners& a, const Corners& b) {
  for (const Vector3d& e : {Vector3d(a[1] - a[0]), Vector3d(b[1] - b[0])})
    if (search.across({-e.y(), e.x(), 0}) || search.across(e)) return true;
  return false;
}

/// The least of: the height of one triangle's corner over the other's plane, and the distances of an edge that
/// passes through that plane from the lines of the other's edges. The best over the edges that pass through.
double piercing_depth(const Corners& t, const Corners& edges_of, double best) {
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double size = n.norm();
  if (!std::isnormal(size)) return best;
  double height[3];
  for (int k = 0; k < 3; ++k) height[k] = n.dot(edges_of[k] - t[0]) / size;
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3;
    double depth = std::min(std::abs(height[k]), std::abs(height[m]));
    if ((height[k] > 0) == (height[m] > 0) || !(depth > best)) continue;
    const Vector3d& p = edges_of[k];
    const Vector3d along = edges_of[m] - p;
    int turns = 0;
    for (int side = 0; side < 3 && depth > best; ++side) {
      const Vector3d across = (t[(side + 1) % 3] - t[side]).cross(along);
      const double length = across.norm(), volume = across.dot(t[side] - p);
      if (!std::isnormal(length)) depth = 0;
      turns += volume > 0 ? 1 : -1;
      depth = std::min(depth, std::abs(volume) / length);
    }
    if (depth > best && std::abs(turns) == 3) best = depth;
  }
  return best;
}

/// The least height of a triangle: what keeps it from becoming a segment.
double least_height(const Corners& t) {
  const double longest =
      std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  return longest > 0 ? (t[1] - t[0]).cross(t[2] - t[0]).norm() / longest : 0;
}

}  // namespace

double gap_between(double margin, double enough, int dim, const double* const a[3], const double* const b[3]) {
  const Corners x = relative_to(a[0], a, dim), y = relative_to(a[0], b, dim);
  SlabSearch search(x, y, margin, enough);
  if (search.across((y[0] + y[1] + y[2]) - (x[0] + x[1] + x[2]))) return search.widest();
  dim == 3 ? search_in_space(search, x, y) : search_in_plane(search, x, y);
  for (int axis = 0; axis < dim && !(search.widest() > enough); ++axis) search.across(Vector3d::Unit(axis));
  return search.widest();
}

bool apart_by(double margin, int dim, const double* const a[3], const double* const b[3]) {
  return gap_between(margin, margin, dim, a, b) > margin;
}

double crossing_depth(const double* const a[3], const double* const b[3]) {
  const Corners x = relative_to(a[0], a, 3), y = relative_to(a[0], b, 3);
  const double depth = piercing_depth(y, x, piercing_depth(x, y, 0));
  return std::min({depth, least_height(x) / 4, least_height(y) / 4});
}

double world_size(const Pose& pose, const BlockTree& tree) {
  return pose.r.cwiseAbs().rowwise().sum().maxCoeff() * tree.extent() + pose.t.cwiseAbs().maxCoeff();
}

double wrapper_margin(const Pose& pose_a, const BlockTree& a, const Pose& pose_b, const BlockTree& b) {
  return kWrapperMargin * (world_size(pose_a, a) + world_size(pose_b, b) + kWorldUnderflow);
}

double stretch(const Pose& pose) {
  return std::sqrt((pose.r.transpose() * pose.r).cwiseAbs().rowwise().sum().maxCoeff()) * (1 + kWrapperMargin);
}

}  // namespace lrb
