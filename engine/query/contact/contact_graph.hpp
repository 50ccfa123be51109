#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// The intersection of two surfaces as a graph: points, segments between them and coplanar polygons over
/// them.
///
/// A corner of a pair's intersection is named by the features of the two surfaces that hold it (a vertex, an
/// edge, the interior of a simplex). The two pairs on both sides of an edge name the same corner the same
/// way, so pieces are joined by comparing integers, never coordinates.
struct ContactGraph {
  struct Piece {
    std::uint32_t pair;                 ///< index into CollideResult::pairs
    std::vector<std::uint32_t> points;  ///< 1: point, 2: segment, 3 or more: polygon
  };
  std::vector<Eigen::Vector3d> points;                 ///< world frame
  std::vector<Piece> pieces;                           ///< one per pair
  std::vector<std::array<std::uint32_t, 2>> curves;    ///< segments that bound no polygon, once each
  std::vector<std::array<std::uint32_t, 2>> outlines;  ///< sides that belong to an odd number of polygons
  std::vector<std::uint32_t> component;                ///< (|points|) label of the connected part
  std::uint32_t component_count = 0;
};

/// Makes the graph from result.pairs and result.contacts.
ContactGraph contact_graph(const QueryContext& context, const CollideResult& result);

}  // namespace lrb
