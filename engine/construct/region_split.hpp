#pragma once
/// Splits the space between two sheets of surface into regions.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lrb::construct {

/// A triangle: its corners as indices of points, counter-clockwise seen from outside.
using PointTriangle = std::array<std::uint32_t, 3>;

/// Tells which piece each triangle bounds: pieces 0 .. count - 1.
struct RegionPieces {
  std::uint32_t count = 0;
  std::uint32_t merged = 0;             ///< pieces without volume that became part of another one...
  std::uint32_t into = 0;               ///< ...which is this
  std::vector<std::uint32_t> of_old;    ///< (|old|)
  std::vector<std::uint32_t> of_added;  ///< (|added|)
};

/// Splits the space between the sheets `old` and `added`, which lies in front of it, into pieces. (Triangles
/// that are in both sheets are in neither list.) `old_face`: triangles of one polygon have the same entry and
/// are neighbours in the list. Pieces are connected over edges; where the sheets touch in an edge, the space
/// to its left and the space to its right are different pieces. A piece without volume is the inner shell of
/// another one: it is joined to the largest.
RegionPieces split_region(std::span<const PointTriangle> old, std::span<const std::uint32_t> old_face,
                          std::span<const PointTriangle> added, std::span<const Eigen::Vector3d> points);

/// Directed edges of triangles, to be looked up.
class EdgeIndex {
 public:
  explicit EdgeIndex(std::span<const PointTriangle> triangles);
  /// Returns the triangle in which an edge runs from a to b, or kNull.
  std::uint32_t find(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Edge {
    std::uint64_t key;
    std::uint32_t triangle;
  };
  std::vector<Edge> edges_;
};

}  // namespace lrb::construct
