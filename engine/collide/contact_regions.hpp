#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/collide/query_context.hpp"
#include <lrbscope/contact.hpp>

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

/// Chains edges between numbered points into loops: closed where all points have two edges, else open from
/// one branch point or end to the next. Uses every edge once.
std::vector<ContactLoop> chain_edges(std::span<const std::array<std::uint32_t, 2>> edges,
                                     const std::vector<Eigen::Vector3d>& points);

/// Fills in interiors_overlap, contacts and regions of a result, as far as the request asks for them.
void describe_contact(QueryContext& context, const CollideRequest& request, CollideResult& result);

}  // namespace lrb
