#include "engine/lrb/pieces.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

std::vector<VertexId> piece_vertices(const LrbRep& rep, std::span<const FaceId> faces) {
  // Union-find over vertices: the corners of one face are in one piece.
  DisjointSets pieces(rep.vertices().size());
  for (const FaceId f : faces)
    for (const VertexId v : rep.face(f)) pieces.join(rep.face(f)[0], v);
  // The leader of a set is a vertex of its piece. Each is listed when its first face comes.
  std::vector<VertexId> out;
  std::vector<bool> seen(rep.vertices().size(), false);
  for (const FaceId f : faces) {
    const VertexId v(pieces.leader(rep.face(f)[0]));
    if (!seen[v]) out.push_back(v);
    seen[v] = true;
  }
  return out;
}

}  // namespace lrb
