#pragma once
/// Memory that the descriptions of contacts reuse from query to query (contact_regions.hpp, interiors.hpp).

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/core/numbering.hpp"
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/ids.hpp>

namespace lrb {

/// Numbers some of the ids 0, 1, ... in the order of their first use; forgetting them takes constant time.
class SparseNumbers {
 public:
  void begin(std::size_t ids) {
    if (entries_.size() < ids) entries_.resize(ids);
    count_ = 0;
    if (++epoch_ != 0) return;
    for (Entry& entry : entries_) entry.epoch = 0;
    epoch_ = 1;
  }
  /// Returns the number of an id, and true if the id is new.
  std::pair<std::uint32_t, bool> add(std::uint32_t id) {
    Entry& entry = entries_[id];
    if (entry.epoch == epoch_) return {entry.number, false};
    entry = {epoch_, count_};
    return {count_++, true};
  }
  /// Returns kNull if the id has no number.
  std::uint32_t operator()(std::uint32_t id) const {
    return entries_[id].epoch == epoch_ ? entries_[id].number : kNull;
  }
  std::uint32_t size() const { return count_; }

 private:
  struct Entry {
    std::uint32_t epoch = 0, number = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t epoch_ = 0, count_ = 0;
};

/// Union-find with a bit for each element: whether it differs from its leader.
class ParitySets {
 public:
  void begin(std::size_t count) {
    parent_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) parent_[i] = {i, false};
  }
  struct Member {
    std::uint32_t leader;
    bool differs;
  };
  Member find(std::uint32_t i) {
    Member found{i, false};
    while (parent_[found.leader].leader != found.leader) {
      found.differs ^= parent_[found.leader].differs;
      found.leader = parent_[found.leader].leader;
    }
    // Path compression.
    for (bool differs = found.differs; i != found.leader;) {
      const Member next = parent_[i];
      parent_[i] = {found.leader, differs};
      differs ^= next.differs;
      i = next.leader;
    }
    return found;
  }
  /// States whether i and j differ. Has no effect if this is known.
  void join(std::uint32_t i, std::uint32_t j, bool differ) {
    const Member x = find(i), y = find(j);
    if (x.leader == y.leader) return;
    parent_[std::max(x.leader, y.leader)] = {std::min(x.leader, y.leader),
                                             (x.differs != y.differs) != differ};
  }

 private:
  std::vector<Member> parent_;
};

/// Used by EnclosedVertices.
struct EnclosedBuffers {
  /// A simplex in contact; a bit for each of its edges.
  struct Cuts {
    SimplexId simplex;
    std::uint8_t met = 0;      ///< the interior of the edge meets the other surface
    std::uint8_t unclear = 0;  ///< other than in crossings of its interior with interiors of simplices
    std::uint8_t odd = 0;      ///< the number of such crossings is odd
    bool crosses = false;      ///< the simplex crosses another one
  };
  SparseNumbers simplices, near;  ///< simplices in contact, and their corners
  std::vector<Cuts> cuts;         ///< by number of the simplex
  ParitySets sides;               ///< of the near vertices: joined if it is known whether their sides differ
  enum class Location : std::uint8_t { unknown, inside, outside, on_surface };
  std::vector<Location> location;  ///< of near vertices: those on the other surface, and leaders
  /// Enclosed vertices that edges connect: `inside` from `begin` to `end`.
  struct Part {
    std::size_t begin, end;
    std::uint32_t call = 0;  ///< the last call of from() that returned it
  };
  static constexpr std::uint32_t kOutside = kNull - 1;
  std::vector<std::uint32_t> part;    ///< (|near|) kNull if not yet known
  SparseNumbers reached;              ///< by a search
  std::vector<VertexId> inside;       ///< those of these that are inside, part by part
  std::vector<Part> parts;            ///< found so far
  std::vector<std::uint32_t> listed;  ///< the parts of the current call
  std::vector<VertexId> joined;       ///< their vertices, if there are several
};

/// The intersection of two surfaces as a graph: points, the segments between them, and coplanar polygons.
///
/// A corner of a pair's intersection is identified by the features of the two surfaces that contain it (a
/// vertex, an edge, or the interior of a simplex). The pairs on both sides of an edge yield the same
/// features, so pieces are connected by comparing integers, never coordinates.
struct ContactGraph {
  using Edge = std::array<std::uint32_t, 2>;
  struct Piece {
    std::uint32_t pair;                    ///< index into CollideResult::pairs
    std::uint32_t count;                   ///< 1: point, 2: segment, 3 or more: polygon
    std::array<std::uint32_t, 6> corners;  ///< the first `count` are valid
    std::span<const std::uint32_t> points() const { return {corners.data(), count}; }
  };
  std::vector<Eigen::Vector3d> points;   ///< world frame
  std::vector<Piece> pieces;             ///< one per pair
  std::vector<Edge> outlines;            ///< sides of an odd number of polygons, ascending
  std::vector<Edge> curves;              ///< segments that are no side of a polygon, once each, ascending
  std::vector<std::uint32_t> component;  ///< (|points|) label of the connected component
  std::uint32_t component_count = 0;
};

/// Used to describe contacts.
struct ContactBuffers {
  ContactGraph graph;
  Numbering<2> corners;  ///< by the features on A and on B
  DisjointSets sets{0};  ///< of points
  // Chains of edges.
  std::vector<ContactGraph::Edge> edges;
  std::vector<std::uint32_t> first_end;  ///< (|points| + 1) index into `ends`, by point
  std::vector<std::uint32_t> ends;       ///< edges that end at a point, ascending; point by point
  std::vector<std::uint8_t> is_used;     ///< by edge
  std::vector<std::uint32_t> chain;      ///< points
  std::vector<std::uint32_t> counts;     ///< number of pairs, by component
  EnclosedBuffers enclosed[2];           ///< vertices of A and of B
};

}  // namespace lrb
