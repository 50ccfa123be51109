#pragma once
/// Measures the distance between the contact region that a method reports, by a list of pairs or by points,
/// and the exact one of the two posed bodies.

#include <memory>
#include <optional>
#include <vector>

#include "bench/speed/record.hpp"
#include "engine/lrb/thickness.hpp"
#include <lrbscope/workspace.hpp>

namespace lrb::bench {

/// A contact in few numbers and many points; all in the world frame and the meshes' unit.
struct Region {
  std::vector<Eigen::Vector3d> points;  ///< corners of the intersections, at most kMostPoints of them
  double length = 0, area = 0;          ///< sums over connected regions
  Eigen::Vector3d centroid{0, 0, 0};    ///< of the points
  Eigen::Vector3d normal{0, 0, 0};      ///< of the largest connected region; zero: none
  double depth = 0;                     ///< the largest
};

/// Errors relative to the diagonal of the larger body, or to the exact value. 1 is the worst of each.
struct RegionError {
  double hausdorff = 0, centroid = 0;  ///< over the diagonal
  double length = 0, area = 0;         ///< over the larger of both values
  double normal = 0;                   ///< angle over 180 degrees
  double depth = 0;                    ///< over the diagonal
};

/// Describes lists of pairs of two bodies at given poses.
class RegionMaker {
 public:
  /// Keeps references to the bodies.
  RegionMaker(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
  /// Describes the region of these pairs. Pairs that do not meet count only for the points, where the middles
  /// of their triangles stand for them.
  Region of_pairs(const std::vector<SimplexPair>& pairs);

 private:
  const LrbRep &a_, &b_;
  Pose pose_a_, pose_b_;
  Workspace workspace_;
};

/// Tells how far points in the world are off two posed bodies.
class BodyDistance {
 public:
  BodyDistance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);
  BodyDistance(const BodyDistance&) = delete;  // its parts refer to each other
  BodyDistance& operator=(const BodyDistance&) = delete;
  /// Returns the largest sum of the distances from the one body's surface and from the other's; 0 without
  /// points.
  double off(const std::vector<Eigen::Vector3d>& points);

 private:
  struct Side {
    Side(const LrbRep& rep, const Pose& pose);
    double distance(const Eigen::Vector3d& world);
    double unit;
    Pose pose;
    std::vector<Eigen::Vector3d> vertices;  ///< in units
    NearestFace nearest;
  };
  Side a_, b_;
};

Region of_points(const std::vector<Eigen::Vector3d>& points);

/// Returns the errors. Two empty regions have none; if only one is empty, all are the worst.
RegionError region_error(const Region& exact, const Region& found, double diagonal);

}  // namespace lrb::bench
