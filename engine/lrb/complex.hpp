#pragma once

#include <array>
#include <span>
#include <vector>

#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>

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

class LrbRep;

/// Returns one vertex of each connected piece of the given faces, in the order of the faces. Faces joined by
/// a vertex count as one piece.
std::vector<VertexId> piece_vertices(const LrbRep& rep, std::span<const FaceId> faces);

/// The real simplices across the borders of a real simplex: [e] across the edge from corner e to the next
/// one, in 2D beyond corner e. kNull where there is none.
using Across = std::array<SimplexId, 3>;

/// Returns what lies across the borders of each real simplex. Where more than two meet in one border, each
/// has one of the others across it.
std::vector<Across> real_neighbours(const LrbRep& rep);

}  // namespace lrb
