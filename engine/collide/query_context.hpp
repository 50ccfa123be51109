#pragma once
/// The two bodies of a query, and the memory that queries reuse.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/collide/pair_order.hpp"
#include "engine/core/numbering.hpp"
#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {

/// World coordinates of one body's vertices during one query. Each vertex is transformed at most once, when
/// it is first needed.
class WorldVertices {
 public:
  void begin(const LrbRep& rep, const Pose& pose) {
    rep_ = &rep;
    pose_ = pose;
    if (slots_.size() < rep.vertices().size()) slots_.resize(rep.vertices().size());
    if (++epoch_ == 0) {
      for (Slot& s : slots_) s.epoch = 0;
      epoch_ = 1;
    }
  }

  const LrbRep& rep() const { return *rep_; }
  const Pose& pose() const { return pose_; }

  /// Returns the world coordinates (x, y, z) of a vertex. The pointer is valid until the next begin().
  const double* operator()(VertexId v) {
    Slot& s = slots_[v];
    if (s.epoch != epoch_) {
      s.x = pose_.apply(rep_->vertices()[v]);
      s.epoch = epoch_;
    }
    return s.x.data();
  }

  /// Writes pointers to the world coordinates of a simplex's corners (3, or 2 in 2D) to out.
  void corners(SimplexId s, const double* out[3]) {
    VertexId v[3];
    rep_->simplex(s, v);
    for (int k = 0; k < rep_->simplex_size(); ++k) out[k] = (*this)(v[k]);
  }

 private:
  struct Slot {
    Eigen::Vector3d x;
    std::uint32_t epoch = 0;
  };
  const LrbRep* rep_ = nullptr;
  Pose pose_;
  std::uint32_t epoch_ = 0;
  std::vector<Slot> slots_;
};

/// World coordinates of one simplex's corners at a time, for threads, which cannot share WorldVertices.
class CornersAtPose {
 public:
  explicit CornersAtPose(const WorldVertices& world) : rep_(world.rep()), pose_(world.pose()) {}

  /// As WorldVertices::corners(); the pointers are valid until the next call.
  void corners(SimplexId s, const double* out[3]) {
    VertexId v[3];
    rep_.simplex(s, v);
    for (int k = 0; k < rep_.simplex_size(); ++k) {
      x_[k] = pose_.apply(rep_.vertices()[v[k]]);
      out[k] = x_[k].data();
    }
  }

 private:
  const LrbRep& rep_;
  const Pose& pose_;
  Eigen::Vector3d x_[3];
};

/// One body during a query.
struct QueryBody {
  WorldVertices world;
  std::unique_ptr<Wrapper> wrapper;
  std::uint64_t wrapper_serial = 0;  ///< serial of the LRB-rep that the wrapper was made for

  const LrbRep& rep() const { return world.rep(); }
  /// Return the data that is queried: the body's, or a level's.
  const ObbTree& tree() const { return *tree_; }
  std::span<const VertexId> component_vertices() const { return component_vertices_; }

  void begin(const LrbRep& rep, const Pose& pose, WrapperMode mode) {
    world.begin(rep, pose);
    begin_at_pose(mode);
  }
  /// Begins at the pose that `world` has already.
  void begin_at_pose(WrapperMode mode) {
    query_body();
    if (!wrapper || wrapper_serial != rep().serial() || &wrapper->rep() != &rep() ||
        wrapper->mode() != mode) {
      wrapper = std::make_unique<Wrapper>(rep(), mode);
      wrapper_serial = rep().serial();
    }
    wrapper->reset();
  }

  void query_body() {
    level_ = nullptr;
    tree_ = &rep().tree();
    component_vertices_ = rep().component_vertices();
  }
  void query_level(const WrapperLevel& level) {
    level_ = &level;
    tree_ = &level.tree;
    component_vertices_ = level.component_vertices;
  }

  /// Returns 0 if the body is queried, i + 1 if its level i is.
  std::uint32_t walked() const {
    return level_ == nullptr ? 0 : static_cast<std::uint32_t>(level_ - rep().levels().all().data()) + 1;
  }

  /// Returns the number of regions between a face and the outside, following parents.
  std::uint32_t depth_of(FaceId f) const {
    const CellId outer = rep().outer_cell(f);
    return is_region(outer) ? rep().depth(outer.as_region()) : 0;
  }

 private:
  const ObbTree* tree_ = nullptr;
  const WrapperLevel* level_ = nullptr;  ///< null: the body itself
  std::span<const VertexId> component_vertices_;
};

// The description of contacts (contact_regions.cpp, interiors.cpp).

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
  using Edge = std::array<std::uint32_t, 3>;  ///< two points, ascending, and a piece with this side
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
  std::vector<ContactHalfEdge> chained;  ///< from these
  std::vector<std::uint32_t> counts;     ///< number of pairs, by component
  EnclosedBuffers enclosed[2];           ///< vertices of A and of B
};

class KeptGaps;

/// The memory that a query reuses from call to call.
class QueryContext {
 public:
  QueryBody body[2];
  Workers* workers = nullptr;     ///< the threads of a query; null: the calling one
  std::vector<NodePair> stack;    ///< of the current kernel: pairs to visit, followed by those already tested
  std::vector<NodePair> waiting;  ///< pairs to visit apart: see split()
  std::vector<Candidate> candidates;
  // Used only in observed queries; see NodeWatch.
  std::unordered_map<std::uint64_t, std::uint32_t> parents;
  std::vector<RejectedPair> rejected;
  std::vector<NodePair> rejected_nodes;
  AffineTerms affine;  ///< of the current kernel, if its map is not rigid
  PairOrder pair_order;
  ContactBuffers contact;
  std::unordered_set<std::uint64_t> visited[3];  ///< paper: region x region (boxes: floor x floor), face x
                                                 ///< region, region x face
  KeptGaps* gaps = nullptr;                      ///< of a coherent query by the paper's recursion

  QueryBody& operator[](Side s) { return body[static_cast<int>(s)]; }
  bool has_threads() const { return workers != nullptr && workers->count() > 1; }
};

/// Tests exactly how two simplices intersect in the world frame. World: WorldVertices or CornersAtPose.
template <class World>
exact::Meet test_simplices(World& world_a, World& world_b, int dim, SimplexId a, SimplexId b) {
  const double *ca[3], *cb[3];
  world_a.corners(a, ca);
  world_b.corners(b, cb);
  return dim == 3 ? exact::meet_triangles(ca, cb) : exact::meet_segments(ca, cb);
}
inline exact::Meet test_simplices(QueryContext& ctx, SimplexId a, SimplexId b) {
  return test_simplices(ctx.body[0].world, ctx.body[1].world, ctx.body[0].rep().dim(), a, b);
}

inline void count_face_test(bool real, std::uint32_t level, Counters& c) {
  ++c.face_tests;
  c.real_tests += real;
  if (c.face_tests_by_level.size() <= level) c.face_tests_by_level.resize(level + 1);
  ++c.face_tests_by_level[level];
}

/// Appends a pair to the result.
template <class Probe>
void record_pair(CollideResult& result, Probe& probe, SimplexId a, SimplexId b, exact::Meet meet) {
  result.pairs.push_back({a, b});
  result.meets.push_back(meet);
  if constexpr (Probe::kEnabled) probe.contact(a, b, meet);
}

}  // namespace lrb
