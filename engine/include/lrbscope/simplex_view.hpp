#pragma once

#include <numeric>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>

namespace lrb {

/// What a tree needs to know about a body: its vertices and the corners of each simplex. Refers to the body,
/// which must outlive it.
struct SimplexView {
  int dim = 3;                                ///< 3: simplices are triangles; 2: segments
  std::span<const Eigen::Vector3d> vertices;  ///< (|V|) the body's frame, the mesh's unit
  std::uint32_t real_count = 0;               ///< real simplices are [0, real_count)
  const void* body = nullptr;
  void (*corners_of)(const void* body, SimplexId s, VertexId out[3]) = nullptr;

  std::vector<SimplexId> real_simplices() const {
    std::vector<SimplexId> all(real_count);
    std::iota(all.begin(), all.end(), SimplexId{0});
    return all;
  }
  /// Writes a simplex's corners (3, or 2 in 2D) to out.
  void simplex(SimplexId s, VertexId out[3]) const { corners_of(body, s, out); }
};

}  // namespace lrb
