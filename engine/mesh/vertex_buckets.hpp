#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/ids.hpp>

namespace lrb {

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
