#pragma once
/// The penetration depth of two solids whose interiors overlap, and the depth along a direction.

#include <optional>

#include <Eigen/Geometry>

#include "engine/clash/minkowski.hpp"
#include "engine/clash/separating_translation.hpp"
#include "engine/clash/unit_bodies.hpp"
#include <lrbscope/clash.hpp>

namespace lrb::penetration {

/// Bounds depths. Lower bounds come from overlapping sets inside the bodies, upper bounds from translations
/// that are proven to separate. For convex bodies both agree up to rounding.
class DepthFinder {
 public:
  /// `query`: begun with the bodies, which must be closed. `result`: all pairs of intersecting simplices.
  /// adapter: null, or notified of bounds on the depth.
  DepthFinder(QueryContext& query, const CollideResult& result, const UnitBodies& bodies,
              SeparationSearch& penetration, BoundsProbeAdapter* adapter = nullptr);

  struct Depth {
    ProvedInterval length;  ///< world
    Vector3d translation{0, 0, 0};
  };
  Depth depth();
  /// `n`: approximately of unit length.
  ProvedInterval along(const Vector3d& n);

 private:
  /// Convex sets inside each body, around a common point.
  struct Common {
    ConvexPoints a, b;
  };
  std::optional<Vector3d> inside_point(Side side, const Vector3d& unit, const Vector3d& shift);
  std::optional<ConvexPoints> shrunken(Side side);
  Eigen::AlignedBox3d common_box(const Vector3d& shift);
  static std::vector<Vector3d> starts(const Eigen::AlignedBox3d& box, int grid);
  std::optional<Vector3d> deepest_common(const Vector3d& shift);
  double common_clearance(const Vector3d& x, const Vector3d& shift);
  std::optional<Common> common_sets(const Vector3d& shift, WholeTriangles whole);
  const SurfaceDistance& surface(Side side);
  double raise_lower(double known, double& best, Vector3d& best_n);
  std::vector<Vector3d> directions();
  void improve(const Vector3d& n, double& best, Vector3d& best_n);
  void refine(double& best, Vector3d& best_n);
  void find_depth(MinkowskiDifference& difference, unsigned max_steps, bool is_inner);
  void notify(double least);
  double hull_width(const Vector3d& n) const;
  double along_lower(const Vector3d& n);

  QueryContext& query_;
  const CollideResult& result_;
  const UnitBodies& bodies_;
  SeparationSearch& separation_search_;
  BoundsProbeAdapter* adapter_;
  double reported_lower_ = 0;             ///< lower bound on the depth, world units; only with an adapter
  std::uint64_t grown_ = 0;               ///< number of expansion steps; only with an adapter
  std::optional<ConvexPoints> whole_[2];  ///< the set of a convex body
  std::optional<SurfaceDistance> surface_[2];  ///< built on first use
  std::vector<Vector3d> common_;               ///< points of both bodies at their poses, the deepest first
};

}  // namespace lrb::penetration
