#include "engine/lrb/pieces.hpp"

#include <algorithm>
#include <numeric>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

std::vector<VertexId> piece_vertices(const LrbRep& rep, std::span<const FaceId> faces) {
  std::vector<VertexId> leader(rep.vertices().size());
  std::iota(leader.begin(), leader.end(), 0u);
  const auto find = [&](VertexId v) {
    while (leader[v] != v) v = leader[v] = leader[leader[v]];
    return v;
  };
  for (const FaceId f : faces)
    for (const VertexId v : rep.face(f)) {
      const VertexId x = find(rep.face(f)[0]), y = find(v);
      leader[std::max(x, y)] = std::min(x, y);  // the leader is the least vertex, whatever the order
    }
  std::vector<VertexId> out;
  std::vector<bool> seen(rep.vertices().size(), false);
  for (const FaceId f : faces) {
    const VertexId v = find(rep.face(f)[0]);
    if (!seen[v]) out.push_back(v);
    seen[v] = true;
  }
  return out;
}

}  // namespace lrb
