#include "bench/speed/region_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <lrbscope/contact.hpp>

namespace lrb::bench {
namespace {

/// The number of points that distances are measured between: enough for three digits, few enough for all
/// pairs of them.
constexpr std::size_t kMostPoints = 1500;

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() <= kMostPoints) return points;
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < kMostPoints; ++i) out.push_back(points[i * points.size() / kMostPoints]);
  return out;
}

/// Returns the largest distance of a point of `from` to its nearest in `to`.
double directed(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double worst = 0;
  for (const Eigen::Vector3d& p : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& q : to) nearest = std::min(nearest, (p - q).squaredNorm());
    worst = std::max(worst, nearest);
  }
  return std::sqrt(worst);
}

double relative(double a, double b) {
  const double largest = std::max(std::abs(a), std::abs(b));
  return largest > 0 ? std::abs(a - b) / largest : 0;
}

double angle_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (a.isZero(0) && b.isZero(0)) return 0;
  if (a.isZero(0) || b.isZero(0)) return 1;
  constexpr double kHalfTurn = 3.141592653589793;
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kHalfTurn;
}

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const Eigen::Vector3d& p : points) sum += p;
  return points.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(points.size()));
}

/// A triangle of a posed body, as the exact predicates take it.
struct WorldTriangle {
  WorldTriangle(const LrbRep& rep, const Pose& pose, SimplexId simplex) {
    VertexId v[3] = {};
    rep.simplex(simplex, v);
    for (int k = 0; k < 3; ++k) x[k] = pose.apply(rep.vertices()[v[k]]);
  }
  Eigen::Vector3d x[3];  ///< world frame
  const double* corners[3] = {x[0].data(), x[1].data(), x[2].data()};
};

}  // namespace

RegionMaker::RegionMaker(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b)
    : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b) {}

Region RegionMaker::of_pairs(const std::vector<SimplexPair>& pairs) {
  CollideResult result;
  CollideRequest request;
  request.contacts = true;
  Region out;
  for (const SimplexPair& p : pairs) {
    const WorldTriangle a(a_, pose_a_, p.a), b(b_, pose_b_, p.b);
    const exact::Meet meet = exact::meet_triangles(a.corners, b.corners);
    if (meet != exact::Meet::disjoint) {
      result.pairs.push_back(p);
      result.meets.push_back(meet);
      continue;
    }
    Eigen::Vector3d sum(0, 0, 0);
    for (int k = 0; k < 3; ++k) sum += a.x[k] + b.x[k];
    out.points.push_back(sum / 6);
  }
  describe_contact(a_, pose_a_, b_, pose_b_, request, workspace_, result).value();
  double largest = -1;
  for (const exact::PairContact& c : result.contacts)
    for (std::uint8_t i = 0; i < c.corner_count; ++i) out.points.push_back(c.corners[i].x);
  for (const ContactRegion& r : result.regions) {
    out.length += r.length;
    out.area += r.area;
    out.depth = std::max(out.depth, r.depth_estimate);
    if (r.length + r.area > largest) out.normal = r.normal;
    largest = std::max(largest, r.length + r.area);
  }
  out.centroid = middle_of(out.points);
  out.points = thinned(out.points);
  return out;
}

BodyDistance::BodyDistance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b)
    : a_(a, pose_a), b_(b, pose_b) {}

BodyDistance::Side::Side(const LrbRep& rep, const Pose& p)
    : unit(rep.tree().unit()), pose(p), vertices(vertices_in_units(rep)), nearest(rep, vertices) {}

/// For poses that are rotations, as those of data sets are.
double BodyDistance::Side::distance(const Eigen::Vector3d& world) {
  const Eigen::Vector3d x = pose.r.transpose() * (world - pose.t);
  return nearest.find(x / unit).distance * unit;
}

double BodyDistance::off(const std::vector<Eigen::Vector3d>& points) {
  double most = 0;
  for (const Eigen::Vector3d& p : points) most = std::max(most, a_.distance(p) + b_.distance(p));
  return most;
}

Region of_points(const std::vector<Eigen::Vector3d>& points) {
  Region out;
  out.points = thinned(points);
  out.centroid = middle_of(points);
  return out;
}

RegionError region_error(const Region& exact, const Region& found, double diagonal) {
  if (exact.points.empty() && found.points.empty()) return {};
  if (exact.points.empty() || found.points.empty()) return {1, 1, 1, 1, 1, 1};
  RegionError e;
  const double far = std::max(directed(exact.points, found.points), directed(found.points, exact.points));
  e.hausdorff = std::min(1.0, far / diagonal);
  e.centroid = std::min(1.0, (exact.centroid - found.centroid).norm() / diagonal);
  e.length = relative(exact.length, found.length);
  e.area = relative(exact.area, found.area);
  e.normal = angle_share(exact.normal, found.normal);
  e.depth = std::min(1.0, std::abs(exact.depth - found.depth) / diagonal);
  return e;
}

}  // namespace lrb::bench
