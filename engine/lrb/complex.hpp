#pragma once
/// Neighbourhoods in the faces of an LRB-rep: closed sets of faces, components, neighbours.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb {

/// Decides whether a set of oriented faces is closed: along every edge (2D: at every vertex) as many faces
/// run in one direction as in the other. Edges are numbered once; each query then takes O(faces added).
class BoundarySum {
 public:
  explicit BoundarySum(const LrbRep& rep);

  void add(FaceId f) { change(f, +1); }
  /// Adds a face with reversed orientation.
  void add_reversed(FaceId f) { change(f, -1); }
  /// Returns true if the faces added since the last call are closed. Otherwise writes the vertices of an open
  /// edge to `open_at`. Starts the next sum.
  bool take_closed(VertexId open_at[2]);

 private:
  void change(FaceId f, int sign);

  const LrbRep& rep_;
  /// (sum of corners) number of the edge from this corner to the next
  std::vector<std::uint32_t> edge_of_corner_;
  /// (sum of corners) +1 if that edge runs from the smaller to the larger vertex, 0 if they are equal, -1
  /// otherwise
  std::vector<std::int8_t> direction_;
  std::vector<std::uint32_t> corner_of_edge_;  ///< one corner of each edge, to identify it
  std::vector<std::int32_t> sum_;              ///< (edges)
  std::vector<std::uint32_t> touched_;
};

/// Returns one vertex of each connected component of the given faces, in the order of the faces. Faces that
/// share a vertex belong to one component.
std::vector<VertexId> piece_vertices(const LrbRep& rep, std::span<const FaceId> faces);

/// The real simplices adjacent to a real simplex: [e] across the edge from corner e to the next one (2D: at
/// corner e). kNull if there is none.
using Across = std::array<SimplexId, 3>;

/// Returns the neighbours of each real simplex. At an edge with more than two simplices, each has one of the
/// others as its neighbour.
std::vector<Across> real_neighbours(const LrbRep& rep);

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
