#pragma once
/// The signed distance of points to a body: for each point an interval of doubles that is proven to contain
/// its distance to the surface, the closest point, and the side on which the point is.
///
/// The body consists of the simplices whose corners are the doubles given by Pose::apply(), exactly, as in
/// collide(). A point is at distance 0 if and only if it is on the surface. The side is decided exactly, by
/// the parity of the crossings of a ray, as the relation of two bodies is:
/// - a void of a body is outside; a component inside the void is inside again;
/// - where a body that crosses itself, or several overlapping components, enclose a point an even number of
///   times, the point is outside;
/// - a body that is not closed has no inside: the side is unknown, and the distance has no sign.
///
/// Algorithm: the distance query (distance.hpp) with a body of one point, and point location by ray crossings
/// (collide/relation.hpp).

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/distance.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

struct PointDistanceRequest {
  /// Maximum width of the interval, as in DistanceRequest.
  double tolerance = 0, relative_tolerance = 0;
  bool side = true;  ///< determine the side; if false, PointDistance::side is nullopt unless on the surface
};

struct PointDistance {
  /// Bounds of the distance to the surface; both 0 on the surface. Infinite if the body has no faces.
  double lower = 0, upper = 0;
  /// The side of the point; nullopt if it was not requested or the body is not closed.
  std::optional<Where> side;
  /// The closest point of the surface, at distance `upper` up to rounding.
  Witness closest;

  /// Bounds of the signed distance: negative inside. Without a side, those of the distance.
  double signed_lower() const { return side == Where::inside ? -upper : lower; }
  double signed_upper() const { return side == Where::inside ? -lower : upper; }
};

/// Returns the distances of points in the world (2D: z is ignored) to a body at a pose, in the order of the
/// points. The result does not depend on `threads` (0: all cores). Throws InputError for a point or a world
/// coordinate that is not finite, naming the point, and for negative or non-finite numbers in the request.
std::vector<PointDistance> point_distances(const LrbRep& body, const Pose& pose,
                                           std::span<const Eigen::Vector3d> points,
                                           const PointDistanceRequest& request = {}, unsigned threads = 0);

}  // namespace lrb
