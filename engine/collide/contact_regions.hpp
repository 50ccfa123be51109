#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/collide/query_context.hpp"
#include <lrbscope/contact.hpp>

namespace lrb {

/// The intersection of two surfaces as a graph: points, the segments between them, and coplanar polygons.
///
/// A corner of a pair's intersection is identified by the features of the two surfaces that contain it (a
/// vertex, an edge, or the interior of a simplex). The pairs on both sides of an edge yield the same
/// features, so pieces are connected by comparing integers, never coordinates.
struct ContactGraph {
  struct Piece {
    std::uint32_t pair;                    ///< index into CollideResult::pairs
    std::uint32_t count;                   ///< 1: point, 2: segment, 3 or more: polygon
    std::array<std::uint32_t, 6> corners;  ///< the first `count` are valid
    std::span<const std::uint32_t> points() const { return {corners.data(), count}; }
  };
  std::vector<Eigen::Vector3d> points;                 ///< world frame
  std::vector<Piece> pieces;                           ///< one per pair
  std::vector<std::array<std::uint32_t, 2>> curves;    ///< segments that are no side of a polygon, once each
  std::vector<std::array<std::uint32_t, 2>> outlines;  ///< sides of an odd number of polygons
  std::vector<std::uint32_t> component;                ///< (|points|) label of the connected component
  std::uint32_t component_count = 0;
};

/// Builds the graph from result.pairs and result.contacts.
ContactGraph contact_graph(const QueryContext& context, const CollideResult& result);

/// Chains edges between numbered points into loops: closed ones if all of their points have two edges,
/// otherwise open chains between ends or branch points. Uses every edge once.
std::vector<ContactLoop> chain_edges(std::span<const std::array<std::uint32_t, 2>> edges,
                                     const std::vector<Eigen::Vector3d>& points);

/// Sets interiors_overlap, contacts and regions of a result, as far as requested.
void describe_contact(QueryContext& context, const CollideRequest& request, CollideResult& result);

}  // namespace lrb
