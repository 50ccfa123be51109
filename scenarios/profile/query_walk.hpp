#pragma once
/// A captured query with what its analysis needs: the bodies and trees of its capture, and its visits linked
/// to one another.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/profile/volumes.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// Maps pairs of 32-bit numbers to 32-bit numbers: open addressing with linear probing, without removal. The
/// pair (kNull, kNull) is reserved.
class PairMap {
 public:
  PairMap() { clear(); }

  void clear() {
    slots_.assign(kFirst, {});
    size_ = 0;
  }
  std::size_t size() const { return size_; }

  /// Returns the value of a pair, or nullptr without one. Valid until the next insertion.
  const std::uint32_t* find(std::uint32_t a, std::uint32_t b) const {
    const Slot& slot = slots_[place_of(key_of(a, b))];
    return slot.key == kFree ? nullptr : &slot.value;
  }
  /// Inserts a pair unless it exists. Returns its value.
  std::uint32_t& insert(std::uint32_t a, std::uint32_t b, std::uint32_t value) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[place_of(key_of(a, b))];
    if (slot.key == kFree) {
      slot = {key_of(a, b), value};
      ++size_;
    }
    return slot.value;
  }

 private:
  static constexpr std::size_t kFirst = 64;  ///< a power of two
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kFree;
    std::uint32_t value = 0;
  };

  static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

  /// Returns the slot of a key, or the free one where it belongs.
  std::size_t place_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    // Fibonacci hashing (Knuth, The Art of Computer Programming, volume 3, section 6.4), upper bits.
    std::size_t i = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 32) & mask;
    while (slots_[i].key != kFree && slots_[i].key != key) i = (i + 1) & mask;
    return i;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != kFree) slots_[place_of(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

/// The parents of a captured tree's nodes and the leaves of its triangles. Also valid for broken trees:
/// the first of several parents or leaves counts, and nodes that the root does not reach have no depth.
struct TreeIndex {
  std::vector<std::uint32_t> parent;           ///< by node; kNull: the root, or no parent
  std::vector<std::uint32_t> depth;            ///< by node; kNull: not below the root
  std::vector<std::uint32_t> from_root;        ///< the nodes below the root, breadth first, each once
  std::vector<std::uint32_t> leaf;             ///< by triangle; kNull: in no leaf
  std::vector<std::uint32_t> triangles_below;  ///< by node; 0 for nodes not below the root

  /// `triangles`: number of triangles of the tree's mesh.
  TreeIndex(const capture::Tree& tree, std::size_t triangles);

  bool is_leaf(std::uint32_t node) const { return !has_children[node]; }
  /// Calls visit(leaf) for each leaf of a triangle: several in a tree with spatial splits.
  template <class Visit>
  void for_each_leaf(std::uint32_t triangle, const Visit& visit) const {
    if (leaf[triangle] != kNull) visit(leaf[triangle]);
    auto i = std::ranges::lower_bound(more_leaves, std::pair(triangle, std::uint32_t{0}));
    for (; i != more_leaves.end() && i->first == triangle; ++i) visit(i->second);
  }
  std::vector<char> has_children;
  /// With spatial splits: (triangle, leaf) of the leaves after the first one, ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> more_leaves;
};

/// A test of bounding volumes with the one that led to it.
struct Visit {
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::size_t parent = kNone;    ///< index of an event; kNone: the first pair, or unknown
  std::optional<NodeStep> step;  ///< the nodes that the engine descended from here; nullopt: none
  std::uint8_t children = 0;     ///< number of pairs visited from here; saturates at 255

  /// Adds a pair that the engine came to by `to`. Returns false if it descended from here by another step.
  bool lead(NodeStep to) {
    if (step.value_or(to) != to) return false;
    step = to;
    children += children < std::numeric_limits<std::uint8_t>::max();
    return true;
  }
};

/// Returns a visit for each event of a query of two trees: finds the predecessor of each test, which is the
/// test of the parents, or of one parent and the other node. The visit of a triangle test has the test of its
/// leaves as parent; visits of counters and phases are unused.
std::vector<Visit> visits_of(const TreeIndex& tree_a, const TreeIndex& tree_b,
                             std::span<const capture::Event> events);

inline std::array<Eigen::Vector3d, 3> corners_of(const capture::Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// The probe of a query as a body with a tree of one node. A ray and a point are a triangle without area. A
/// box has twelve triangles, of which the first stands for all in the leaf, as in events.
struct ProbeBody {
  capture::Mesh mesh;
  capture::Tree tree;  ///< without the index of its mesh
};
/// Makes the volume of a ray's tree, an OBB or RSS, the part of its x axis from `begin` to `end`.
void set_segment(capture::Tree& tree, double begin, double end);
/// Returns the probe of a query of `tree`, no vertex of whose mesh is farther than `reach` from the origin of
/// the mesh. A ray that goes on beyond them ends at a power of two, so that most rays are the same body.
ProbeBody probe_body(const capture::Query& query, const capture::Tree& tree, double reach);
double reach_of(const capture::Mesh& mesh);
/// Makes the pairs of a query's box, which are those of its surface, pairs of the solid with the triangle 0.
/// Does nothing for other queries. `body`, `mesh`: of A.
void fill_box(const capture::Query& query, const LrbRep& body, const capture::Mesh& mesh,
              std::vector<SimplexPair>& pairs);
/// Returns bounds of the length along a query's ray at which it meets a triangle of the mesh of A that it
/// hits, if coordinates may be wrong by `error`.
std::array<double, 2> hit_of(const capture::Query& query, const capture::Mesh& mesh, std::uint32_t triangle,
                             double error = 0);
/// Returns true if a query is for the first hit of a ray.
inline bool is_first_hit(const capture::Query& query) {
  return query.kind == capture::QueryKind::distance && query.probe.shape == capture::ProbeShape::ray;
}

/// Returns true if tests of triangles were recorded.
inline bool tests_triangles(const capture::Query& query) {
  return std::ranges::any_of(query.events,
                             [](const capture::Event& e) { return e.kind == capture::EventKind::triangles; });
}

/// Triangles of two meshes by the capture's numbers, or of one: then a < b.
struct TrianglePair {
  std::uint32_t a = 0, b = 0;
  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// The meshes and trees of a capture, prepared on first use. The capture must outlive this object.
class CapturedBodies {
 public:
  /// The number of the tree, and of the mesh, of the last query's probe.
  static constexpr std::uint32_t kProbe = kNull - 1;

  explicit CapturedBodies(const capture::Capture& capture);

  /// Call it when meshes or trees were added to the capture. References to trees become invalid.
  void update();

  const capture::Capture& capture() const { return *capture_; }
  /// Returns captured_body() of a mesh, whose simplices are the mesh's triangles under their own numbers;
  /// nullptr if the mesh has no triangles.
  const LrbRep* body(std::uint32_t mesh);
  const TreeIndex& index(std::uint32_t tree);
  const Volumes& volumes(std::uint32_t tree);
  const capture::Tree& tree(std::uint32_t tree) const {
    return tree == kProbe ? probe_.tree : capture_->trees[tree];
  }
  const capture::Mesh& mesh_of(std::uint32_t tree) const { return mesh(this->tree(tree).mesh); }

  /// Returns the trees of both sides, which are the same for a self query; nullopt if a side has none. That
  /// of a probe is valid until the next call.
  std::optional<std::array<std::uint32_t, 2>> trees_of(const capture::Query& query);

 private:
  const capture::Mesh& mesh(std::uint32_t mesh) const {
    return mesh == kProbe ? probe_.mesh : capture_->meshes[mesh];
  }
  /// Returns the element of a mesh or tree in a vector, whose last one is the probe's.
  template <class T>
  static std::unique_ptr<T>& slot(std::vector<std::unique_ptr<T>>& all, std::uint32_t i) {
    return i == kProbe ? all.back() : all[i];
  }

  const capture::Capture* capture_;
  ProbeBody probe_;
  std::vector<double> reach_;                                ///< by mesh, reach_of(); negative: not known
  std::vector<std::unique_ptr<bodies::LoadedBody>> bodies_;  ///< by mesh
  std::vector<std::unique_ptr<TreeIndex>> indices_;
  std::vector<std::unique_ptr<Volumes>> volumes_;
};

/// The visits of a query: its tests of nodes, each with the one that led to it.
class QueryWalk {
 public:
  static constexpr std::uint32_t kNone = kNull;

  /// `trees`: as returned by CapturedBodies::trees_of(). The arguments must outlive this object.
  QueryWalk(CapturedBodies& bodies, const capture::Query& query, const std::array<std::uint32_t, 2>& trees);

  const capture::Query& query() const { return *query_; }
  const std::array<std::uint32_t, 2>& trees() const { return trees_; }
  const TreeIndex& index(std::size_t side) const { return *index_[side]; }

  /// Returns the visit, the index of an event, that led to an event; kNone: the first pair, or unknown.
  /// Parents are first visits. An engine may skip levels: then the parent is the closest pair above whose
  /// volumes overlap.
  std::uint32_t parent(std::size_t event) const { return parent_[event]; }
  /// Returns how the engine continued from a visit; nullopt: it did not.
  std::optional<NodeStep> step(std::size_t event) const { return visits_[event].step; }
  /// Returns the number of pairs visited from a visit; saturates at 255.
  std::uint8_t children(std::size_t event) const { return visits_[event].children; }
  /// Returns the first visit of two nodes, or kNone if there is none.
  std::uint32_t visit_of(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t* const found = first_.find(a, b);
    return found == nullptr ? kNone : *found;
  }
  /// Returns the first visit of the same two nodes: the event itself unless it repeats one.
  std::uint32_t first_visit(std::size_t event) const {
    return *first_.find(query_->events[event].a, query_->events[event].b);
  }
  /// The visits of nodes that hang under the roots of their trees, parents before children.
  const std::vector<std::uint32_t>& from_root() const { return order_; }
  /// Returns the number of visits of nodes.
  std::uint64_t visits() const { return visit_count_; }
  /// Returns true if the descent begins with this visit: that of both roots, or if these were not tested, one
  /// of two nodes that are each a root or its child.
  bool is_start(std::size_t event) const;
  /// Returns the deepest visited pair of nodes above two triangles, or kNone if there is none.
  std::uint32_t deepest_above(const TrianglePair& pair) const;
  /// Returns true if a test compares more than one pair of volumes: then a visit of two nodes compares the
  /// volumes of their children, and only pairs whose volumes overlap are visited.
  bool wide() const { return wide_; }

 private:
  void link_strays();
  std::uint32_t deepest_above(std::uint32_t a, std::uint32_t b) const;
  /// Returns the deepest accepted visit of two nodes or of nodes above them, or kNone if there is none.
  template <class Accept>
  std::uint32_t deepest_from(std::uint32_t a, std::uint32_t b, const Accept& accept) const;
  /// Returns the deepest visited pair above two nodes whose volumes overlap, or kNone if there is none.
  std::uint32_t closest_above(std::uint32_t a, std::uint32_t b) const;
  /// Returns the depths of an event's nodes added up; kNone: one does not hang under its root.
  std::uint32_t depth_of(std::size_t event) const;

  const capture::Query* query_;
  std::array<std::uint32_t, 2> trees_;
  std::array<const TreeIndex*, 2> index_;
  std::vector<Visit> visits_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> by_a_;  ///< the first visits of their nodes, by the node of A
  PairMap first_;
  std::uint64_t visit_count_ = 0;
  bool wide_ = false, visits_roots_ = false;
};

}  // namespace lrb::profile
