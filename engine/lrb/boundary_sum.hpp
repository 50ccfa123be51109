#pragma once

#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Decides if a set of oriented faces is closed: if along every edge (2D: at every vertex) as many
/// faces run one way as the other. Edges are numbered once; each question then costs O(faces added).
class BoundarySum {
 public:
  explicit BoundarySum(const LrbRep& rep);

  void add(FaceId f) { change(f, +1); }
  /// Adds a face seen from its other side.
  void add_reversed(FaceId f) { change(f, -1); }
  /// Returns true if the faces added since the last call are closed; otherwise names an edge where they are
  /// not in `open_at`. Starts the next sum.
  bool take_closed(VertexId open_at[2]);

 private:
  void change(FaceId f, int sign);

  const LrbRep& rep_;
  std::vector<std::uint32_t>
      edge_of_corner_;  ///< (sum of corners) the number of the edge from this corner to the next
  std::vector<std::int8_t>
      direction_;  ///< (sum of corners) +1 if that edge runs from the smaller vertex to the larger, else -1
  std::vector<std::uint32_t> corner_of_edge_;  ///< one corner of each edge, to name it
  std::vector<std::int32_t> sum_;              ///< (edges)
  std::vector<std::uint32_t> touched_;
};

}  // namespace lrb
