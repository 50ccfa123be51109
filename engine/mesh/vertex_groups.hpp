#pragma once
/// Vertices grouped by position, and items grouped by vertex.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/ids.hpp>

namespace lrb {

/// Returns a hash of a point that is equal for 0 and -0.
inline std::uint64_t hash_of_point(const Eigen::Vector3d& v) {
  std::uint64_t h = 0;
  for (int i = 0; i < 3; ++i) {
    h ^= std::bit_cast<std::uint64_t>(v[i] + 0.0);  // -0 + 0 is 0
    h *= 0x9e3779b97f4a7c15u;  // 2^64 divided by the golden ratio: disperses neighbouring keys
    h ^= h >> 32;
  }
  return h;
}

/// Returns the slot of the vertex at x, or the free slot for it. Open addressing: `slots` are indices of
/// `points` or kNull, a power of two in number, and not all used.
inline VertexId& slot_of(const Eigen::Vector3d& x, std::span<const Eigen::Vector3d> points,
                         std::span<VertexId> slots) {
  const std::size_t mask = slots.size() - 1;
  std::size_t i = hash_of_point(x) & mask;
  while (slots[i] != kNull && points[slots[i]] != x) i = (i + 1) & mask;
  return slots[i];
}

/// Finds the first of several vertices with equal coordinates (0 and -0 are equal).
class FirstAtPosition {
 public:
  /// Has room for all `points`, which must outlive it.
  explicit FirstAtPosition(std::span<const Eigen::Vector3d> points)
      : points_(points), slots_(std::bit_ceil(2 * points.size() + 1), kNull) {}

  /// Returns the first vertex at the position of v among those passed so far, or v itself if it is the first.
  /// A point with a NaN differs from all others. Pass each vertex once.
  VertexId operator()(VertexId v) {
    const Eigen::Vector3d& x = points_[v];
    if (x.hasNaN()) return v;
    VertexId& slot = slot_of(x, points_, slots_);
    if (slot == kNull) slot = v;
    return slot;
  }

 private:
  std::span<const Eigen::Vector3d> points_;
  std::vector<VertexId> slots_;
};

/// Returns for each vertex the first one at its position: vertices on seams occur twice.
inline std::vector<VertexId> first_at_positions(std::span<const Eigen::Vector3d> points) {
  FirstAtPosition first_at(points);
  std::vector<VertexId> places;
  places.reserve(points.size());
  for (VertexId v = 0; v < points.size(); ++v) places.push_back(first_at(v));
  return places;
}

/// Merges equal points (bitwise, except that 0 and -0 are equal) to vertices, numbered in order of first
/// appearance. There is no tolerance: points an ulp apart stay distinct, and check_mesh() reports the gap.
class VertexMerger {
 public:
  explicit VertexMerger(std::vector<Eigen::Vector3d>& vertices) : vertices_(vertices), slots_(64, kNull) {}

  VertexId id(const Eigen::Vector3d& v) {
    if (2 * vertices_.size() >= slots_.size()) grow();
    VertexId& slot = slot_of(v, vertices_, slots_);
    if (slot == kNull) {
      slot = static_cast<VertexId>(vertices_.size());
      vertices_.push_back(v);
    }
    return slot;
  }

 private:
  /// Doubles the slots, so that at most half of them are used.
  void grow() {
    slots_.assign(2 * slots_.size(), kNull);
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      slot_of(vertices_[i], vertices_, slots_) = static_cast<VertexId>(i);
  }

  std::vector<Eigen::Vector3d>& vertices_;
  std::vector<VertexId> slots_;
};

/// Items grouped by a vertex with a counting sort: O(items + vertices). Within a group they keep their order.
template <class Item>
class VertexBuckets {
 public:
  /// `for_each_item(visit)` must call visit(vertex, item) for each item. It runs twice and must produce the
  /// same items both times; every vertex is below `vertices`.
  template <class ForEach>
  VertexBuckets(std::size_t vertices, const ForEach& for_each_item) : offsets_(vertices + 1, 0) {
    // Pass 1: sizes of the groups, then prefix sums: offsets_[v] is the start of group v.
    for_each_item([&](VertexId v, const Item&) { ++offsets_[v + std::size_t{1}]; });
    for (std::size_t v = 0; v < vertices; ++v) offsets_[v + 1] += offsets_[v];
    // Pass 2: place the items. This moves offsets_[v] to the end of group v, the start of the next one.
    items_.resize(offsets_.back());
    for_each_item([&](VertexId v, const Item& item) { items_[offsets_[v]++] = item; });
  }

  /// Returns all items in the order of their vertices.
  std::vector<Item>& items() { return items_; }
  const std::vector<Item>& items() const { return items_; }

  /// Calls visit(v, group) for each vertex that has items, ascending.
  template <class Visit>
  void for_each_group(const Visit& visit) {
    for (std::size_t v = 0, first = 0; v + 1 < offsets_.size(); first = offsets_[v++])
      if (offsets_[v] > first)
        visit(VertexId(static_cast<std::uint32_t>(v)),
              std::span<Item>(items_).subspan(first, offsets_[v] - first));
  }

 private:
  std::vector<std::uint32_t> offsets_;  ///< (|V| + 1) the ends of the groups, then the number of items
  std::vector<Item> items_;
};

}  // namespace lrb
