#pragma once
/// Proves that two bodies overlap after all translations that are short enough.
///
/// If the open ball of radius r about x is in A, and the open ball of radius s about x - v is in B, then the
/// interiors overlap after all translations of B that differ from v by less than r + s, because B's ball then
/// reaches into A's. Translations are divided into cubes, nearest to 0 first. For each cube, a point x is
/// searched whose two balls are large enough for the entire cube; if none is found, the cube is divided into
/// eight. All translations shorter than the nearest remaining cube are proven. The closer these are to the
/// depth, the smaller are the cubes near separating translations; their number grows as the inverse of the
/// difference to the depth.

#include <functional>
#include <vector>

#include "engine/clash/clash_tolerances.hpp"
#include "engine/clash/unit_bodies.hpp"

namespace lrb::penetration {

class OverlapProof {
 public:
  /// Returns true if a point is inside a body (units; B at its pose, before any translation).
  using IsInside = std::function<bool(Side, const Vector3d&)>;
  /// Keeps references to the surfaces.
  OverlapProof(const SurfaceDistance& a, const SurfaceDistance& b, IsInside is_inside);

  /// Begins with common points of both bodies, the best first, and with all translations shorter than `most`,
  /// which must be less than 2 and should be slightly above the depth. Returns false if no point is in both
  /// bodies.
  bool begin(const std::vector<Vector3d>& common, double most);
  /// Continues until about `max_points` more points have been tried, or no larger bound can be proven.
  /// Returns the number of points tried.
  unsigned grow(unsigned max_points);
  /// Returns a proven lower bound: after all shorter translations of B the interiors overlap.
  double lower() const { return lower_; }
  /// Returns a translation near the shortest one that is not proven, which may separate the bodies, or 0 if
  /// no cube is left.
  Vector3d undecided() const { return cubes_.empty() ? Vector3d(Vector3d::Zero()) : cubes_.front().centre; }

 private:
  /// A point of both bodies, for a translation.
  struct Common {
    Vector3d x{0, 0, 0}, of_b{0, 0, 0}, shift{0, 0, 0};  ///< x, x - v and v
    double clear_a = 0, clear_b = 0;                     ///< of x from A's surface, of x - v from B's
    double room() const { return clear_a + clear_b; }
  };
  struct Cube {
    double least;  ///< lower bound on the length of its translations
    Vector3d centre;
    double half;
    Common near;  ///< of a nearby translation
  };
  void push(const Vector3d& centre, double half, const Common& near);
  bool look(const Vector3d& x, const Vector3d& v, const Common& near, Common& out);
  bool is_in(Side side, const Vector3d& x, double radius, const Vector3d& known, double known_radius);
  std::vector<Common> seeds(const Cube& cube) const;
  bool find_room(const Cube& cube, double needed, const Common& seed, Common& best);
  bool prove(const Cube& cube, Common& best);
  void climb(double needed, bool thorough, Common& best);
  static bool has_more(const Common& x, const Common& y) { return x.room() > y.room() * (1 + kClearlyMore); }
  bool is_small(const Cube& cube) const { return cube.half < kSmallCube * (most_ - cube.least); }

  const SurfaceDistance &a_, &b_;
  IsInside is_inside_;
  /// The initial points, followed by those for the centres of the proven cubes.
  std::vector<Common> found_;
  std::size_t first_ = 0;    ///< number of initial points
  std::vector<Cube> cubes_;  ///< a min-heap
  double most_ = 0, lower_ = 0;
  unsigned points_ = 0;
};

}  // namespace lrb::penetration
