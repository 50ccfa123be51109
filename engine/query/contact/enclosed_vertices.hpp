#pragma once

#include <span>
#include <unordered_set>
#include <vector>

#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Finds the vertices of one body that lie strictly inside the other and are connected to given pairs.
class EnclosedVertices {
 public:
  /// Prepares the search for vertices of `side`. Finds nothing if the other body is not closed.
  EnclosedVertices(QueryContext& context, Side side, const CollideResult& result);

  /// Returns what is found by spreading over the surface from the simplices of some pairs (indices into
  /// result.pairs), without crossing the other body's surface.
  std::vector<VertexId> from(std::span<const std::uint32_t> pairs);

 private:
  SimplexId simplex(std::uint32_t pair) const;
  bool is_inside(VertexId v);

  QueryBody& body_;
  QueryBody& holder_;
  Side side_;
  const CollideResult& result_;
  std::unordered_set<VertexId> near_;  ///< corners of simplices in contact
};

}  // namespace lrb
