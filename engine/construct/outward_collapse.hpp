#pragma once
/// Geometry of one edge collapse that only moves a surface outward (progressive hulls: Sander, Gu, Gortler,
/// Hoppe and Snyder, "Silhouette Clipping", 2000).

#include <vector>

#include <Eigen/Core>

#include "engine/construct/half_spaces.hpp"
#include "engine/construct/open_front.hpp"

namespace lrb::construct {

/// Places and judges the vertex of the fan that replaces a star.
class OutwardCollapse {
 public:
  using Star = OpenFront::Star;
  using Vector3 = Eigen::Vector3d;

  /// `bounds`: new vertices stay inside. `depth`: see place(). `needle_weight`: see needle_cost().
  OutwardCollapse(const OpenFront& open, const BodyBounds& bounds, double depth, double needle_weight)
      : open_(open), bounds_(bounds), depth_(depth), needle_weight_(needle_weight) {}

  /// Finds the position of a new vertex: the point in front of all planes that is nearest to a target,
  /// `depth` radii below the star's centre, so that it is as low as possible and above the centre. (The
  /// lowest vertex by a linear program drifts sideways where the star is flat.) Returns false if there is no
  /// such point near the star.
  bool place(const Star& star, Vector3& w);

  // For a star whose first vertex moves onto the second.
  /// Returns true if the vertex is in front of all faces that do not have it.
  bool is_in_front(const Star& star) const;
  /// Returns true if it is in front of the neighbours beyond reflex edges of the rim, where the fan could
  /// intersect them.
  bool clears_neighbours(const Star& star) const;

  // Volumes and areas are in powers of OpenFront::unit().
  /// Returns the volume between the star and the fan from w. `area`: of the star.
  double volume_under(const Star& star, const Vector3& w, double& area) const;
  /// Returns a penalty for needles in the fan, to be added to that volume: needle_weight area^1.5 / shape of
  /// the worst triangle, which is 1 for an equilateral one. Infinite if a triangle has no area. `area`: of
  /// the star.
  double needle_cost(const Star& star, const Vector3& w, double area) const;
  /// Returns true if a face of the fan folds back over its neighbour beyond the rim, or turns to the inside
  /// of the front there. This happens where the surface is flat: a vertex outside the rim and hardly above
  /// the surface is in front of all planes. A face that turns by less than a right angle is not tested here;
  /// if it intersects its neighbour, the proof of the lid finds that.
  bool folds(const Star& star, const Vector3& w) const;
  /// Exact: the vertex must be strictly in front of every face that the fan covers.
  bool is_strictly_in_front(const Star& star, const Vector3& w) const;

 private:
  const OpenFront& open_;
  const BodyBounds& bounds_;
  double depth_, needle_weight_;
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace lrb::construct
