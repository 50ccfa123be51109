// Splits the space between two sheets with a common boundary into regions:
// 1. Union-find over triangles that bound the same piece of space along an edge.
// 2. Number the pieces in the order of their first triangle.
// 3. Merge pieces of volume <= 0, which are inner shells, into the largest piece.

#include "engine/construct/region_split.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/ids.hpp>

namespace lrb::construct {
namespace {

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{a} << 32 | b;
}

/// Joins triangles over edges; the old ones come first, then the added ones.
DisjointSets connect(std::span<const PointTriangle> old, std::span<const PointTriangle> added) {
  const auto old_count = static_cast<std::uint32_t>(old.size());
  DisjointSets sets(old.size() + added.size());
  // A directed edge occurs at most once in each sheet.
  const EdgeIndex old_edges(old), added_edges(added);
  for (std::uint32_t i = 0; i < added.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = added[i][k], b = added[i][(k + 1) % 3];
      // The same directed edge in both sheets: they touch here, and the space between them closes along the
      // edge.
      if (const std::uint32_t below = old_edges.find(a, b); below != kNull) sets.join(below, old_count + i);
      // Otherwise the piece continues to the next triangle of the same sheet.
      else if (const std::uint32_t beside = added_edges.find(b, a); beside != kNull)
        sets.join(old_count + beside, old_count + i);
    }
  }
  // The same for the old sheet; edges at which the sheets touch were handled above.
  for (std::uint32_t i = 0; i < old_count; ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = old[i][k], b = old[i][(k + 1) % 3];
      if (added_edges.find(a, b) != kNull) continue;
      if (const std::uint32_t beside = old_edges.find(b, a); beside != kNull) sets.join(beside, i);
    }
  }
  return sets;
}

std::vector<double> volumes_of(const RegionPieces& pieces, std::span<const PointTriangle> old,
                               std::span<const PointTriangle> added,
                               std::span<const Eigen::Vector3d> points) {
  // Six times the volume by the divergence theorem: outer faces count positive, inner ones negative. Only
  // signs and order are used.
  const Eigen::Vector3d origin = points[added.empty() ? old[0][0] : added[0][0]];
  const auto volume = [&](const PointTriangle& t) {
    return (points[t[0]] - origin).dot((points[t[1]] - origin).cross(points[t[2]] - origin));
  };
  std::vector<double> volumes(pieces.count, 0);
  for (std::size_t i = 0; i < added.size(); ++i) volumes[pieces.of_added[i]] += volume(added[i]);
  for (std::size_t i = 0; i < old.size(); ++i) volumes[pieces.of_old[i]] -= volume(old[i]);
  return volumes;
}

void merge_shells(RegionPieces& pieces, const std::vector<double>& volumes) {
  // An inner shell has no space of its own: its volume is part of the piece around it.
  const auto largest =
      static_cast<std::uint32_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
  const auto stays = [&](std::uint32_t p) { return volumes[p] > 0 || p == largest; };
  // Keep the numbers consecutive.
  std::vector<std::uint32_t> renumbered(pieces.count);
  std::uint32_t next = 0;
  for (std::uint32_t p = 0; p < pieces.count; ++p)
    if (stays(p)) renumbered[p] = next++;
  for (std::uint32_t p = 0; p < pieces.count; ++p)
    if (!stays(p)) renumbered[p] = renumbered[largest];
  pieces.merged = pieces.count - next;
  pieces.into = renumbered[largest];
  pieces.count = next;
  for (auto* list : {&pieces.of_old, &pieces.of_added})
    for (std::uint32_t& p : *list) p = renumbered[p];
}

}  // namespace

EdgeIndex::EdgeIndex(std::span<const PointTriangle> triangles) {
  // A sorted array: cheaper than hashing for a few hundred edges, and deterministic.
  edges_.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) edges_.push_back({edge_key(triangles[i][k], triangles[i][(k + 1) % 3]), i});
  std::sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) { return e.key < f.key; });
}

std::uint32_t EdgeIndex::find(std::uint32_t a, std::uint32_t b) const {
  const std::uint64_t key = edge_key(a, b);
  const auto e = std::lower_bound(edges_.begin(), edges_.end(), key,
                                  [](const Edge& edge, std::uint64_t wanted) { return edge.key < wanted; });
  return e != edges_.end() && e->key == key ? e->triangle : kNull;
}

RegionPieces split_region(std::span<const PointTriangle> old, std::span<const std::uint32_t> old_face,
                          std::span<const PointTriangle> added, std::span<const Eigen::Vector3d> points) {
  // Step 1. A polygon is one face of the complex, so its triangles must be in the same piece.
  DisjointSets sets = connect(old, added);
  for (std::uint32_t i = 1; i < old.size(); ++i)
    if (old_face[i] == old_face[i - 1]) sets.join(i - 1, i);
  // Step 2.
  RegionPieces pieces;
  std::vector<std::uint32_t> number(old.size() + added.size(), kNull);
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    std::uint32_t& n = number[sets.leader(i)];
    if (n == kNull) n = pieces.count++;
    (i < old.size() ? pieces.of_old : pieces.of_added).push_back(n);
  }
  // Step 3. A single piece needs no volumes.
  if (pieces.count > 1) merge_shells(pieces, volumes_of(pieces, old, added, points));
  return pieces;
}

}  // namespace lrb::construct
