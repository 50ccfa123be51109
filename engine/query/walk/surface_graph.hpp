#pragma once

#include <span>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Tells which real vertices are joined by an edge of a real face. Derived from an LRB-rep when a query first
/// needs it.
class SurfaceGraph {
 public:
  explicit SurfaceGraph(const LrbRep& rep);
  std::span<const VertexId> neighbours(VertexId v) const {
    return {neighbours_.data() + offsets_[v], offsets_[v + 1] - offsets_[v]};
  }

 private:
  std::vector<std::uint32_t> offsets_;  ///< (|V| + 1)
  std::vector<VertexId> neighbours_;
};

}  // namespace lrb
