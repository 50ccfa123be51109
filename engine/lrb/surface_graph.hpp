#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/lrb_rep.hpp>

namespace lrb {

/// The real vertices connected to each vertex by an edge of a real face, and the vertices that coincide.
class SurfaceGraph {
 public:
  explicit SurfaceGraph(const LrbRep& rep);
  /// Returns them ascending.
  std::span<const VertexId> neighbours(VertexId v) const {
    return {neighbours_.data() + offsets_[v], offsets_[v + 1] - offsets_[v]};
  }
  /// Returns the first vertex with the same coordinates: vertices along a texture seam are one place.
  VertexId place(VertexId v) const { return places_.empty() ? v : places_[v]; }

 private:
  std::vector<std::uint32_t> offsets_;  ///< (|V| + 1)
  std::vector<VertexId> neighbours_;
  std::vector<VertexId> places_;  ///< (|V|); empty if no two vertices coincide
};

}  // namespace lrb
