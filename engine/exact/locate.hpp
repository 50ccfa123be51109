#pragma once
/// Exact point location: ray crossings, points with rational coordinates, and sample points of the cells into
/// which other faces divide a face.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lrb::exact {

/// A point with rational coordinates. Immutable; copies share the coordinates. In 2D z = 0.
class RationalPoint {
 public:
  struct Coordinates;  // private to engine/exact (rational.hpp): keeps Boost out of this header

  /// Creates the exact point of `dim` (2 or 3) finite doubles.
  explicit RationalPoint(const double* p, int dim = 3);
  explicit RationalPoint(std::shared_ptr<const Coordinates> coordinates)
      : coordinates_(std::move(coordinates)) {}

  static RationalPoint midpoint(const RationalPoint& a, const RationalPoint& b);
  /// Returns sum(weights[i] * points[i]) / sum(weights). Requires one finite weight for each point, with a
  /// sum other than 0.
  static RationalPoint combination(std::span<const RationalPoint> points, std::span<const double> weights);

  /// Returns the nearest doubles (to one unit in the last place).
  Eigen::Vector3d rounded() const;
  const Coordinates& coordinates() const { return *coordinates_; }

 private:
  std::shared_ptr<const Coordinates> coordinates_;
};

/// orient2d() and orient3d() of predicates.hpp with a rational last point.
int orient2d(const double* a, const double* b, const RationalPoint& c);
int orient3d(const double* a, const double* b, const double* c, const RationalPoint& d);

/// The result of a ray at one face. If no face of a closed surface returns on_face, the point is inside if
/// and only if an odd number of faces return crosses.
enum class RayHit { misses = 0, crosses = 1, on_face = -1 };

/// Intersects the ray from p in direction +x with a triangle. p is perturbed by (0, eps, eps^2) for an
/// infinitesimal eps, so that the ray intersects no edge or corner of any triangle and is in no triangle's
/// plane: there are no degenerate cases. on_face: the unperturbed p is on the closed triangle (which may have
/// no area). After Edelsbrunner and Muecke, "Simulation of Simplicity" (1990).
RayHit ray_crosses(const double p[3], const double* const tri[3]);
RayHit ray_crosses(const RationalPoint& p, const double* const tri[3]);

/// Intersects the ray with a segment in the plane z = 0; p is perturbed by (0, eps).
RayHit ray_crosses_2d(const double p[2], const double* const seg[2]);
RayHit ray_crosses_2d(const RationalPoint& p, const double* const seg[2]);

/// Returns one point strictly inside each cell into which the other triangles divide `tri`. No point is on
/// any of these triangles, except that the point of a cell covered by a coplanar triangle is on that
/// triangle. Returns no points if tri has no area. Returns nullopt if there would be more than `limit`
/// points, more than `limit` cuts, or too many slabs: the work is cubic in the number of cuts. Method: slab
/// decomposition (sample_cells.cpp).
std::optional<std::vector<RationalPoint>> sample_cells(const double* const tri[3],
                                                       std::span<const std::array<const double*, 3>> others,
                                                       std::size_t limit);

/// The 2D version: a segment, cut by points (and by the ends of segments that overlap it).
std::optional<std::vector<RationalPoint>> sample_cells_2d(
    const double* const seg[2], std::span<const std::array<const double*, 2>> others, std::size_t limit);

/// A triangle divided into cells by others, as in sample_cells().
class CutFace {
 public:
  /// Returns nullopt if the triangle has no area, or if a limit of sample_cells() is exceeded.
  static std::optional<CutFace> make(const double* const tri[3],
                                     std::span<const std::array<const double*, 3>> others, std::size_t limit);

  /// Returns one point strictly inside each cell.
  const std::vector<RationalPoint>& samples() const { return samples_; }
  /// Returns the index of the cell that borders on the edge from corner `edge` to the next, at a point of the
  /// edge that is on no cut.
  std::size_t cell_beside(int edge, const RationalPoint& p) const;

 private:
  struct Parts;
  std::vector<RationalPoint> samples_;
  std::shared_ptr<const Parts> parts_;
};

/// Returns a point of each part into which the planes of some triangles divide a segment. If the segment is
/// in a triangle's plane, the lines of the triangle's edges divide it instead. Returns nullopt if the segment
/// is a point, or if it is in the plane of a triangle without area.
std::optional<std::vector<RationalPoint>> sample_edge(
    const double* from, const double* to, std::span<const std::array<const double*, 3>> triangles);

}  // namespace lrb::exact
