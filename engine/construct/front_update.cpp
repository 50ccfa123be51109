// Applies a cap to the front. work_out() computes the regions under the cap and the neighbours across each
// of its edges, without changing anything; cover() then updates complex and front.

#include "engine/construct/front_update.hpp"

#include <algorithm>
#include <bit>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/ids.hpp>

namespace lrb::construct {
namespace {

using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

void notify(ConstructProbe& probe, std::uint32_t first_region, const RegionPieces& pieces) {
  for (std::uint32_t p = 0; p < pieces.count; ++p) probe.region(RegionId(first_region + p));
  if (pieces.merged > 0) probe.merged(RegionId(first_region + pieces.into), pieces.merged);
}

}  // namespace

void work_out(const FrontMesh& front, Sheet& sheet) {
  // Step 1: renumber the vertices of both surfaces to 0 .. n - 1 for the local algorithms.
  std::sort(sheet.removed.begin(), sheet.removed.end());
  std::vector<Corner> corners;
  for (const Slot slot : sheet.removed)
    corners.insert(corners.end(), front[slot].v.begin(), front[slot].v.end());
  for (const PointTriangle& t : sheet.added) corners.insert(corners.end(), t.begin(), t.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  std::vector<Eigen::Vector3d> points;
  points.reserve(corners.size());
  for (const Corner c : corners)
    // New vertices do not exist in the front yet.
    points.push_back(c < Sheet::kNewPoint ? front.x(c) : sheet.new_points[c - Sheet::kNewPoint]);
  const auto local = [&](const PointTriangle& t) {
    PointTriangle out;
    for (int i = 0; i < 3; ++i)
      out[i] = static_cast<std::uint32_t>(std::lower_bound(corners.begin(), corners.end(), t[i]) -
                                          corners.begin());
    return out;
  };
  // Step 2: the regions between the covered triangles and the cap.
  std::vector<PointTriangle> old, added;
  std::vector<std::uint32_t> old_face;
  for (const Slot slot : sheet.removed) {
    old.push_back(local(front[slot].v));
    old_face.push_back(front[slot].face);
  }
  for (const PointTriangle& t : sheet.added) added.push_back(local(t));
  sheet.pieces = split_region(old, old_face, added, points);
  // Step 3: the neighbour across each new edge: another new triangle, or at the boundary the triangle that
  // was across the same edge of the covered triangle.
  const EdgeIndex old_edges(old), added_edges(added);
  sheet.beyond.resize(added.size());
  for (std::size_t i = 0; i < added.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = added[i][k], b = added[i][(k + 1) % 3];
      Sheet::Beyond& beyond = sheet.beyond[i][k];
      beyond.added = added_edges.find(b, a);
      if (beyond.added == kNull) beyond.removed = old_edges.find(a, b);
    }
  }
}

std::vector<Slot> cover(FrontMesh& front, ComplexBuilder& complex, const Sheet& sheet, std::uint16_t layer,
                        std::uint32_t component, ConstructProbe* probe) {
  // Step 1: assign the final numbers of vertices and regions.
  const Corner first_new = front.point_count();
  for (std::size_t i = 0; i < sheet.new_points.size(); ++i)
    front.add_point(sheet.new_points[i], complex.add_vertex(sheet.new_points[i]));
  const std::vector<Slot>& removed = sheet.removed;
  const std::uint32_t first_region = complex.region_count();
  for (std::uint32_t p = 0; p < sheet.pieces.count; ++p) complex.add_region(layer);
  // Step 2: the covered faces become the floors of the regions.
  for (std::size_t i = 0; i < removed.size(); ++i)
    complex.set_outer_cell(front[removed[i]].face, RegionId(first_region + sheet.pieces.of_old[i]));

  // Step 3: new triangles reuse the slots of the covered ones, then append.
  std::vector<Slot> slots;
  for (std::size_t i = 0; i < sheet.added.size(); ++i)
    slots.push_back(i < removed.size() ? removed[i]
                                       : front.slot_count() + static_cast<Slot>(i - removed.size()));
  // Step 4: prepare the triangles while the covered ones still exist, because their neighbours are read.
  std::vector<FrontMesh::Triangle> triangles(sheet.added.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    FrontMesh::Triangle& t = triangles[i];
    VertexId ids[3];
    for (int k = 0; k < 3; ++k) {
      const Corner c = sheet.added[i][k];
      t.v[k] = c < Sheet::kNewPoint ? c : first_new + (c - Sheet::kNewPoint);
      ids[k] = front.point(t.v[k]).id;
    }
    for (int k = 0; k < 3; ++k) {
      const Sheet::Beyond& beyond = sheet.beyond[i][k];
      if (beyond.added != kNull) {
        t.across[k] = slots[beyond.added];
      } else {
        const Slot old = removed[beyond.removed];
        t.across[k] = front[old].across[front.index_of(old, t.v[k])];
        // The outer neighbour refers back to the new triangle.
        front.link(t.across[k], t.v[(k + 1) % 3], slots[i]);
      }
    }
    t.face = complex.add_pseudo_face(ids, RegionId(first_region + sheet.pieces.of_added[i]), kOutside);
    t.component = component;
  }
  // Step 5: replace the covered triangles by the new ones.
  front.remove(removed);
  for (std::size_t i = 0; i < slots.size(); ++i) front.add(slots[i], triangles[i]);
  if (probe) notify(*probe, first_region, sheet.pieces);
  return slots;
}

// Splits the space between two surfaces with a common boundary into regions:
// 1. Union-find over triangles that bound the same piece of space along an edge.
// 2. Number the pieces in the order of their first triangle.
// 3. Merge pieces of volume <= 0, which are inner shells, into the largest piece.

namespace {

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{a} << 32 | b;
}

/// Connects triangles over edges; the old ones come first, then the added ones.
DisjointSets connect(std::span<const PointTriangle> old, std::span<const PointTriangle> added) {
  const auto old_count = static_cast<std::uint32_t>(old.size());
  DisjointSets sets(old.size() + added.size());
  // A directed edge occurs at most once in each surface.
  const EdgeIndex old_edges(old), added_edges(added);
  for (std::uint32_t i = 0; i < added.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = added[i][k], b = added[i][(k + 1) % 3];
      // The same directed edge in both surfaces: they touch, and the space between them ends at this edge.
      if (const std::uint32_t below = old_edges.find(a, b); below != kNull) sets.join(below, old_count + i);
      // Otherwise the piece continues to the next triangle of the same surface.
      else if (const std::uint32_t beside = added_edges.find(b, a); beside != kNull)
        sets.join(old_count + beside, old_count + i);
    }
  }
  // Connect the old surface; edges at which the surfaces touch were handled above.
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
  // Six times the volume by the divergence theorem: outer faces count as positive, inner ones as negative.
  // Only signs and order are used.
  const Eigen::Vector3d origin = points[added.empty() ? old[0][0] : added[0][0]];
  const auto volume = [&](const PointTriangle& t) {
    return dot3(points[t[0]] - origin, (points[t[1]] - origin).cross(points[t[2]] - origin));
  };
  std::vector<double> volumes(pieces.count, 0);
  for (std::size_t i = 0; i < added.size(); ++i) volumes[pieces.of_added[i]] += volume(added[i]);
  for (std::size_t i = 0; i < old.size(); ++i) volumes[pieces.of_old[i]] -= volume(old[i]);
  return volumes;
}

void merge_shells(RegionPieces& pieces, const std::vector<double>& volumes) {
  // An inner shell has no volume of its own: it belongs to the piece around it.
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

EdgeIndex::EdgeIndex(std::span<const PointTriangle> triangles)
    : edges_(std::bit_ceil(std::max<std::size_t>(6 * triangles.size(), 2))) {
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t key = edge_key(triangles[i][k], triangles[i][(k + 1) % 3]);
      edges_[place_of(key)] = {key, i};
    }
}

/// Returns the place of an edge, or the empty place where it belongs. Linear probing.
std::uint64_t EdgeIndex::place_of(std::uint64_t key) const {
  const std::uint64_t last = edges_.size() - 1;
  std::uint64_t at = (key * 0x9e3779b97f4a7c15u >> 32) & last;
  while (edges_[at].triangle != kNull && edges_[at].key != key) at = (at + 1) & last;
  return at;
}

std::uint32_t EdgeIndex::find(std::uint32_t a, std::uint32_t b) const {
  return edges_[place_of(edge_key(a, b))].triangle;
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
