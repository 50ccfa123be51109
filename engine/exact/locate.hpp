#pragma once
/// Locating points: crossings of an exact ray, points with rational coordinates, and sample points for the
/// cells into which a face is cut by other faces. Everything here is exact.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lrb::exact {

/// A point with rational coordinates. Immutable; copies share them. In 2D z = 0.
class RationalPoint {
 public:
  struct Coordinates;  // private to engine/exact (rational.hpp): keeps Boost out of this header

  /// Makes the exact point of `dim` (2 or 3) finite doubles.
  explicit RationalPoint(const double* p, int dim = 3);
  explicit RationalPoint(std::shared_ptr<const Coordinates> coordinates)
      : coordinates_(std::move(coordinates)) {}

  static RationalPoint midpoint(const RationalPoint& a, const RationalPoint& b);
  /// Returns sum(weights[i] * points[i]) / sum(weights). There must be one finite weight for each point, and
  /// their sum must not be 0.
  static RationalPoint combination(std::span<const RationalPoint> points, std::span<const double> weights);

  /// Returns the nearest doubles (to one unit in the last place).
  Eigen::Vector3d rounded() const;
  const Coordinates& coordinates() const { return *coordinates_; }

 private:
  std::shared_ptr<const Coordinates> coordinates_;
};

/// The predicates orient2d and orient3d of predicates.hpp with a rational last point.
int orient2d(const double* a, const double* b, const RationalPoint& c);
int orient3d(const double* a, const double* b, const double* c, const RationalPoint& d);

/// What a ray does at one face of a surface. If no face of a closed surface gives on_face, the point is
/// inside exactly if an odd number of faces give crosses.
enum class RayHit { misses = 0, crosses = 1, on_face = -1 };

/// Tells what the ray from p in the direction +x does at a triangle, after p has been moved by (0, eps,
/// eps^2) for an infinitely small eps: the ray then meets no edge or corner of any triangle and runs in no
/// triangle's plane, so that no case is degenerate. on_face: p itself, not moved, lies on the closed triangle
/// (which may have no area). After Edelsbrunner and Muecke, "Simulation of Simplicity" (1990).
RayHit ray_crosses(const double p[3], const double* const tri[3]);
RayHit ray_crosses(const RationalPoint& p, const double* const tri[3]);

/// Does the same in the plane z = 0 for a segment; p is moved by (0, eps).
RayHit ray_crosses_2d(const double p[2], const double* const seg[2]);
RayHit ray_crosses_2d(const RationalPoint& p, const double* const seg[2]);

/// Returns one point strictly inside every cell into which `tri` is cut by its intersections with the other
/// triangles. None of the points lies on any of these triangles, except that a cell covered by a coplanar
/// triangle has its point on that triangle. Works by vertical slabs between all end points and crossings of
/// the cuts, in the projection along an axis in which the triangle keeps its area. Returns no points if tri
/// has no area. Gives up (empty optional) if there would be more than `limit` points, more than `limit` cuts,
/// or too many slabs: the work is cubic in the number of cuts.
std::optional<std::vector<RationalPoint>> sample_cells(const double* const tri[3],
                                                       std::span<const std::array<const double*, 3>> others,
                                                       std::size_t limit);

/// Does the same for a segment in the plane, cut by points (and by the ends of segments that overlap it).
std::optional<std::vector<RationalPoint>> sample_cells_2d(
    const double* const seg[2], std::span<const std::array<const double*, 2>> others, std::size_t limit);

/// A triangle that others cut into cells, as sample_cells() has them.
class CutFace {
 public:
  /// Returns nothing if the triangle has no area, or where sample_cells() gives up.
  static std::optional<CutFace> make(const double* const tri[3],
                                     std::span<const std::array<const double*, 3>> others, std::size_t limit);

  /// Returns one point strictly inside each cell.
  const std::vector<RationalPoint>& samples() const { return samples_; }
  /// Returns the cell that borders on the edge from corner `edge` to the next, at a point of the edge that is
  /// on no cut.
  std::size_t cell_beside(int edge, const RationalPoint& p) const;

 private:
  struct Parts;
  std::vector<RationalPoint> samples_;
  std::shared_ptr<const Parts> parts_;
};

/// Returns a point of each part into which a segment is cut by the planes of some triangles or, where it lies
/// in such a plane, by the lines through the triangle's edges. Nothing if the segment is a point, or a
/// triangle in whose plane it would lie has no area.
std::optional<std::vector<RationalPoint>> sample_edge(
    const double* from, const double* to, std::span<const std::array<const double*, 3>> triangles);

}  // namespace lrb::exact
