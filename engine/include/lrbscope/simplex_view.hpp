#pragma once

#include <numeric>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>

namespace lrb {

/// The part of a body that an OBB tree needs: its vertices and the corners of its simplices. A view; the body
/// must outlive it.
struct SimplexView {
  int dim = 3;                                ///< 3: simplices are triangles; 2: segments
  std::span<const Eigen::Vector3d> vertices;  ///< (|V|) body frame, mesh units
  std::uint32_t real_count = 0;               ///< simplices [0, real_count) are real
  const void* body = nullptr;
  void (*corners_of)(const void* body, SimplexId s, VertexId out[3]) = nullptr;

  /// Returns the indices of all real simplices, ascending.
  std::vector<SimplexId> real_simplices() const {
    std::vector<SimplexId> all(real_count);
    std::iota(all.begin(), all.end(), SimplexId{0});
    return all;
  }
  /// Writes the corners of a simplex (3, or 2 in 2D) to out.
  void simplex(SimplexId s, VertexId out[3]) const { corners_of(body, s, out); }
};

}  // namespace lrb
