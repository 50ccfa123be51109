#include <algorithm>
#include <string>
#include <utility>

#include "engine/collide/query_context.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>

namespace lrb {

const char* to_string(Relation r) {
  return name_of(r).data();
}
const char* to_string(Answer a) {
  return name_of(a).data();
}
const char* to_string(Recursion r) {
  return name_of(r).data();
}

void clear(Counters& counters) {
  // Reset all counters, but keep the vector's memory.
  std::vector<std::uint32_t> levels = std::move(counters.face_tests_by_level);
  levels.clear();
  counters = {};
  counters.face_tests_by_level = std::move(levels);
}

void clear(CollideResult& result) {
  // Reset all members by exchanging with a new result, then move the emptied vectors back: they keep their
  // memory.
  CollideResult old = std::exchange(result, {});
  clear(old.counters);
  old.pairs.clear();
  old.meets.clear();
  old.contacts.clear();
  old.regions.clear();
  for (std::vector<RegionId>& opened : old.opened) opened.clear();
  result.counters = std::move(old.counters);
  result.pairs = std::move(old.pairs);
  result.meets = std::move(old.meets);
  result.contacts = std::move(old.contacts);
  result.regions = std::move(old.regions);
  result.opened = std::move(old.opened);
}

void reject_pairs(std::uint64_t limit) {
  throw InputError("more than " + std::to_string(limit) +
                   " pairs of triangles intersect, the limit set by max_pairs; raise it (--max-pairs) if "
                   "memory allows (about 25 bytes per pair, 650 with contacts), or use mode any or first");
}

std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs) {
  Fnv64 h;
  for (const SimplexPair& p : pairs) {
    h.add_value(p.a);
    h.add_value(p.b);
  }
  return h.value();
}

SurfaceGraph::SurfaceGraph(const LrbRep& rep) {
  // All edges of real faces, in both directions; shared ones occur once for each face.
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    const auto corners = rep.face(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const VertexId v = corners[i], w = corners[(i + 1) % corners.size()];
      edges.emplace_back(v, w);
      edges.emplace_back(w, v);
    }
  }
  // Sorted by the first vertex: the neighbours of a vertex are then contiguous.
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  // Compressed rows: count the neighbours of each vertex, then add up the counts.
  offsets_.assign(rep.vertices().size() + 1, 0);
  for (const auto& [v, w] : edges) {
    ++offsets_[v + 1];
    neighbours_.push_back(w);
  }
  for (std::size_t v = 0; v + 1 < offsets_.size(); ++v) offsets_[v + 1] += offsets_[v];
}

}  // namespace lrb
