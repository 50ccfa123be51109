// Self-intersections of a mesh, exactly:
// 1. Triangulate polygons: planar convex faces without degenerate triangles, others by cut_polygon().
// 2. FacePairs finds the pairs of faces whose bounds overlap.
// 3. Each pair is decided by exact tests of its triangles. A face with very many corners has a tree of its
//    triangles, so that a pair of such faces does not take the product of their triangle counts.
#include "engine/mesh/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>

#include <Eigen/Geometry>

#include "engine/exact/predicates.hpp"
#include "engine/mesh/face_pairs.hpp"
#include "engine/mesh/hubs.hpp"
#include "engine/mesh/polygon_shape.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

using Triangle = std::array<VertexId, 3>;

/// Returns true if two coplanar triangles have the same orientation and overlap in an area.
bool cover_each_other(const double* const a[3], const double* const b[3]) {
  // Project along the first axis along which a keeps an area; the projection preserves relative orientation.
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3;
    const int turn = exact::orient_axes(a[0], a[1], a[2], x, y);
    if (turn == 0) continue;
    // Opposite orientation: the solids are on different sides of the plane and only touch.
    if (exact::orient_axes(b[0], b[1], b[2], x, y) != turn) return false;
    // Separating axis theorem in 2D: if the interiors of two convex polygons are disjoint, the line of a side
    // of one of them separates them.
    const auto rejected = [&](const double* const p[3], const double* const q[3]) {
      for (int i = 0; i < 3; ++i) {
        bool beyond = true;
        for (int k = 0; k < 3; ++k)
          beyond &= exact::orient_axes(p[i], p[(i + 1) % 3], q[k], x, y) * turn <= 0;
        if (beyond) return true;
      }
      return false;
    };
    return !rejected(a, b) && !rejected(b, a);
  }
  return false;
}

bool overlap_3d(const double* const a[3], const double* const b[3]) {
  // If some corner of b is not in the plane of a, only a proper crossing counts as overlap.
  for (int k = 0; k < 3; ++k)
    if (exact::orient3d(a[0], a[1], a[2], b[k]) != 0)
      return exact::meet_triangles(a, b) == exact::Meet::cross;
  return cover_each_other(a, b);
}

/// Returns true if two segments, with the solid on their left, cross, or overlap on one line in the same
/// direction.
bool overlap_2d(const double* const a[2], const double* const b[2]) {
  // Not collinear: only a proper crossing counts.
  if (exact::orient2d(a[0], a[1], b[0]) != 0 || exact::orient2d(a[0], a[1], b[1]) != 0)
    return exact::meet_segments(a, b) == exact::Meet::cross;
  // Collinear: compare as intervals on an axis along which a has an extent. Opposite directions have the
  // solid on different sides. Open intervals: a shared end is not an overlap.
  const int k = a[0][0] != a[1][0] ? 0 : 1;
  const bool forward = a[0][k] < a[1][k];
  if (forward != (b[0][k] < b[1][k])) return false;
  return forward ? a[0][k] < b[1][k] && b[0][k] < a[1][k] : a[0][k] > b[1][k] && b[0][k] > a[1][k];
}

/// Adjacency of the corners of a face with very many corners.
class Ring {
 public:
  explicit Ring(std::span<const VertexId> corners) {
    for (std::uint32_t i = 0; i < corners.size(); ++i) places_.push_back({corners[i], i});
    std::sort(places_.begin(), places_.end());
  }
  bool are_neighbours(VertexId v, VertexId w) const {
    // Each corner occurs once: a face with a repeated corner does not count as convex.
    const auto n = static_cast<std::uint32_t>(places_.size());
    const std::uint32_t i = place(v), j = place(w);
    return (i + 1) % n == j || (j + 1) % n == i;
  }

 private:
  std::uint32_t place(VertexId v) const {
    return std::lower_bound(places_.begin(), places_.end(), std::array<std::uint32_t, 2>{v, 0})->at(1);
  }
  std::vector<std::array<std::uint32_t, 2>> places_;  ///< (vertex, index in the face), ascending
};

/// A face with very many corners.
struct LargeFace {
  TriangleTree tree;
  std::optional<Ring> ring;  ///< of a planar convex face: sides of its triangles need not be sides of the
                             ///< face
};

/// The faces as triangles with area (2D: as segments), and the pairs of them that may intersect.
class Pieces {
 public:
  Pieces(const Mesh& mesh, const std::vector<FaceUse>& use) : mesh_(mesh), use_(use), pairs_(mesh, use) {
    offsets_.reserve(mesh.face_count() + 1);
    triangles_.reserve(mesh.face_count());
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      offsets_.push_back(static_cast<std::uint32_t>(triangles_.size()));
      if (use[f] < FaceUse::area || mesh.dim == 2) continue;
      // Only usable faces take part. Segments are used unchanged.
      pairs_.is_large(f) ? add_large(f, use[f]) : add_triangles(f, use[f]);
    }
    offsets_.push_back(static_cast<std::uint32_t>(triangles_.size()));
  }

  /// Calls visit(f, g), f < g, for the pairs that may intersect; concurrently if `workers` has several
  /// threads.
  void for_each_pair(const FacePairs::Visit& visit, Workers& workers) const {
    pairs_.for_each(visit, workers);
  }

  /// Returns true if two faces have an intersection of a kind.
  bool meet(FaceId f, FaceId g, FaceMeeting kind) const {
    if (mesh_.dim == 2) {
      const auto [a, b] = segments(f, g);
      switch (kind) {
        case FaceMeeting::crossing:
          return exact::meet_segments(a.data(), b.data()) == exact::Meet::cross;
        case FaceMeeting::overlap:
          return overlap_2d(a.data(), b.data());
        case FaceMeeting::outside_shared:
          break;
      }
      return !exact::meet_only_in_shared_2d(a.data(), mesh_.face(f).data(), b.data(), mesh_.face(g).data());
    }
    return any_pair(f, g, [&](const Triangle& s, const Triangle& t) {
      switch (kind) {
        case FaceMeeting::crossing:
          return exact::meet_triangles(points(s).data(), points(t).data()) == exact::Meet::cross;
        case FaceMeeting::overlap:
          return overlap_3d(points(s).data(), points(t).data());
        case FaceMeeting::outside_shared:
          break;
      }
      return meet_outside_shared(f, s, g, t);
    });
  }

  /// Calls visit(s, t, contact) for each pair of triangles (2D: of the segments) of two faces that intersect
  /// outside what they share. In 2D the third corners are kNull.
  template <class Visit>
  void for_each_contact(FaceId f, FaceId g, const Visit& visit) const {
    if (mesh_.dim == 2) {
      const auto v = mesh_.face(f), w = mesh_.face(g);
      const auto [a, b] = segments(f, g);
      return visit(Triangle{v[0], v[1], kNull}, Triangle{w[0], w[1], kNull},
                   exact::contact_of_segments(a.data(), b.data()));
    }
    any_pair(f, g, [&](const Triangle& s, const Triangle& t) {
      if (meet_outside_shared(f, s, g, t))
        visit(s, t, exact::contact_of_triangles(points(s).data(), points(t).data()));
      return false;
    });
  }

 private:
  bool meet_outside_shared(FaceId f, const Triangle& s, FaceId g, const Triangle& t) const {
    // A triangle of a polygon may share a chord of that polygon with the other face, which the index test
    // would permit.
    return !exact::meet_only_in_shared(points(s).data(), s.data(), points(t).data(), t.data()) ||
           ((mesh_.face(f).size() > 3 || mesh_.face(g).size() > 3) && share_a_chord(f, s, g, t));
  }

  using Segment = std::array<const double*, 2>;
  std::pair<Segment, Segment> segments(FaceId f, FaceId g) const {
    const auto a = mesh_.face(f), b = mesh_.face(g);
    return {{point(a[0]), point(a[1])}, {point(b[0]), point(b[1])}};
  }

  const double* point(VertexId v) const { return mesh_.vertices[v].data(); }
  std::array<const double*, 3> points(const Triangle& t) const {
    return {point(t[0]), point(t[1]), point(t[2])};
  }

  void add_triangles(FaceId f, FaceUse use) {
    const auto corners = mesh_.face(f);
    if (use == FaceUse::convex) {
      triangulate_convex(mesh_, corners, scratch_);
      triangles_.insert(triangles_.end(), scratch_.begin(), scratch_.end());
    } else {
      add_cut(f, triangles_);
    }
  }

  /// Adds the triangles of a polygon that is not planar and convex.
  void add_cut(FaceId f, std::vector<Triangle>& out) {
    cut_polygon(mesh_, f, scratch_);
    for (const Triangle& t : scratch_)
      if (!exact::collinear3d(point(t[0]), point(t[1]), point(t[2]))) out.push_back(t);
  }

  void add_large(FaceId f, FaceUse use) {
    std::vector<Triangle> triangles;
    std::optional<Ring> ring;
    if (use == FaceUse::convex) {
      // Convex: triangles of all sizes, whose boxes overlap less than a fan's.
      triangulate_by_halves(mesh_, mesh_.face(f), triangles);
      ring.emplace(mesh_.face(f));
    } else {
      add_cut(f, triangles);
    }
    large_.emplace(f, LargeFace{TriangleTree(mesh_, pairs_.cube(), triangles, 1), std::move(ring)});
  }

  template <class Test>
  bool any_pair(FaceId f, FaceId g, Test test) const {
    if (pairs_.is_large(f) || pairs_.is_large(g)) return any_pair_of_trees(f, g, test);
    // All pairs of triangles: neither face has more than kFewNeighbours corners.
    for (std::uint32_t i = offsets_[f]; i < offsets_[f + 1]; ++i)
      for (std::uint32_t j = offsets_[g]; j < offsets_[g + 1]; ++j)
        if (test(triangles_[i], triangles_[j])) return true;
    return false;
  }

  template <class Test>
  bool any_pair_of_trees(FaceId f, FaceId g, Test& test) const {
    // The smaller face gets a temporary tree; it has few triangles, so the tree is a single leaf.
    const auto tree_of = [&](FaceId face, std::optional<TriangleTree>& made) -> const TriangleTree* {
      if (pairs_.is_large(face)) return &large_.at(face).tree;
      const std::uint32_t count = offsets_[face + 1] - offsets_[face];
      if (count == 0) return nullptr;
      made.emplace(mesh_, pairs_.cube(), std::span(triangles_).subspan(offsets_[face], count),
                   kFewNeighbours);
      return &*made;
    };
    std::optional<TriangleTree> made_of_f, made_of_g;
    const TriangleTree *a = tree_of(f, made_of_f), *b = tree_of(g, made_of_g);
    return a != nullptr && b != nullptr && TriangleTree::any_pair(*a, *b, test);
  }

  /// Returns true if the triangles share a side that is not a side of both faces but an interior chord of
  /// one: the faces then intersect, although the triangles only share a side.
  bool share_a_chord(FaceId f, const Triangle& s, FaceId g, const Triangle& t) const {
    // Corners in common, by index.
    VertexId shared[3];
    int count = 0;
    for (const VertexId v : s)
      if (std::find(t.begin(), t.end(), v) != t.end()) shared[count++] = v;
    return count == 2 && !(is_side(f, shared[0], shared[1]) && is_side(g, shared[0], shared[1]));
  }

  /// Returns true if two corners of a triangle are adjacent in the face. (A face that is not planar and
  /// convex is its triangles, and all their sides count as its own.)
  bool is_side(FaceId f, VertexId v, VertexId w) const {
    if (use_[f] != FaceUse::convex) return true;
    // Binary search in the sorted corners: a linear search for every triangle would be quadratic.
    if (pairs_.is_large(f)) return large_.at(f).ring->are_neighbours(v, w);
    const auto corners = mesh_.face(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const VertexId a = corners[i], b = corners[(i + 1) % corners.size()];
      if ((a == v && b == w) || (a == w && b == v)) return true;
    }
    return false;
  }

  const Mesh& mesh_;
  const std::vector<FaceUse>& use_;
  FacePairs pairs_;
  std::vector<std::uint32_t> offsets_;  ///< (|F| + 1), into triangles_
  std::vector<Triangle> triangles_;     ///< of faces that are not large
  std::map<FaceId, LargeFace> large_;
  std::vector<Triangle> scratch_;
};

}  // namespace

void find_self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use,
                             const std::function<void(FaceId, FaceId)>& found, FaceMeeting kind,
                             const std::function<bool(FaceId, FaceId)>& wanted) {
  // One thread, because callers' functions are not required to be thread-safe.
  const Pieces pieces(mesh, use);
  Workers alone;
  pieces.for_each_pair(
      [&](FaceId f, FaceId g) {
        if ((!wanted || wanted(f, g)) && pieces.meet(f, g, kind)) found(f, g);
      },
      alone);
}

std::vector<FaceId> self_intersecting_faces(const Mesh& mesh, const std::vector<FaceUse>& use,
                                            Workers& workers) {
  const Pieces pieces(mesh, use);
  std::vector<std::atomic<bool>> meets(mesh.face_count());
  pieces.for_each_pair(
      [&](FaceId f, FaceId g) {
        // Skip the exact test if both faces are known. Flags only change from false to true, so races between
        // threads are harmless.
        if (!(meets[f] && meets[g]) && pieces.meet(f, g, FaceMeeting::outside_shared))
          meets[f] = meets[g] = true;
      },
      workers);
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < meets.size(); ++f)
    if (meets[f]) faces.push_back(f);
  return faces;
}

bool overlaps_itself(const Mesh& mesh, const std::vector<FaceUse>& use,
                     const std::function<bool(FaceId, FaceId)>& wanted) {
  bool found = false;
  // After the first hit, all pairs are rejected, so no more exact tests run.
  find_self_intersections(
      mesh, use, [&](FaceId, FaceId) { found = true; }, FaceMeeting::overlap,
      [&](FaceId f, FaceId g) { return !found && (!wanted || wanted(f, g)); });
  return found;
}

// The pairs with kinds, segments and curves.

namespace {

/// A vertex, edge or triangle of the mesh: its vertices, ascending, then kNull.
using MeshFeature = std::array<VertexId, 3>;
/// A point of an intersection: the features of lowest dimension that it is on, ascending. The pairs on both
/// sides of an edge have the same ones.
using PointKey = std::array<MeshFeature, 2>;

MeshFeature feature_of(const Triangle& t, const exact::Feature& feature) {
  MeshFeature out{kNull, kNull, kNull};
  const std::size_t corners = t[2] == kNull ? 2 : 3;
  if (feature.dim == 2 || (corners == 2 && feature.dim == 1))
    std::copy(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(corners), out.begin());
  else
    for (std::size_t i = 0; i <= feature.dim; ++i) out[i] = t[(feature.index + i) % corners];
  std::sort(out.begin(), out.end());
  return out;
}

/// The intersection of two faces.
struct FoundPair {
  FaceId f, g;
  SelfContact kind = SelfContact::touch;
  std::vector<std::array<PointKey, 2>> keys;  ///< of the ends of the segments
  std::vector<std::array<Eigen::Vector3d, 2>> segments;

  void add(const Triangle& s, const Triangle& t, const exact::PairContact& contact) {
    const std::uint8_t n = contact.corner_count;
    const bool overlap = contact.coplanar && n >= (s[2] == kNull ? 2 : 3);
    kind = std::max(kind, overlap                              ? SelfContact::overlap
                          : contact.meet == exact::Meet::cross ? SelfContact::cross
                                                               : SelfContact::touch);
    const auto key = [&](const exact::ContactCorner& corner) {
      PointKey out{feature_of(s, corner.on_a), feature_of(t, corner.on_b)};
      std::sort(out.begin(), out.end());
      return out;
    };
    // A point is a segment of length 0, and a polygon its outline.
    for (std::uint8_t i = 0; i < (n <= 2 ? 1 : n); ++i) {
      const exact::ContactCorner &p = contact.corners[i], &q = contact.corners[(i + 1u) % n];
      const std::array<PointKey, 2> ends{key(p), key(q)};
      // Triangles on both sides of a chord of their polygon can have a segment on it.
      const auto is_same = [&](const std::array<PointKey, 2>& other) {
        return other == ends || (other[0] == ends[1] && other[1] == ends[0]);
      };
      if (std::any_of(keys.begin(), keys.end(), is_same)) continue;
      keys.push_back(ends);
      segments.push_back({p.x, q.x});
    }
  }
};

std::uint32_t shared_corners(const Mesh& mesh, FaceId f, FaceId g) {
  const auto a = mesh.face(f), b = mesh.face(g);
  std::vector<VertexId> of_a(a.begin(), a.end()), of_b(b.begin(), b.end()), both;
  std::sort(of_a.begin(), of_a.end());
  std::sort(of_b.begin(), of_b.end());
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(both));
  return static_cast<std::uint32_t>(both.size());
}

/// Numbers the curves in the order of the pairs, and gives equal points equal coordinates: the pairs on both
/// sides of an edge may round them differently.
void find_curves(const std::vector<FoundPair>& found, SelfIntersections& out) {
  std::vector<PointKey> points;
  for (const FoundPair& pair : found)
    for (const auto& ends : pair.keys) points.insert(points.end(), ends.begin(), ends.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto number = [&](const PointKey& key) {
    return static_cast<std::uint32_t>(std::lower_bound(points.begin(), points.end(), key) - points.begin());
  };
  DisjointSets sets(points.size());
  std::vector<const Eigen::Vector3d*> first(points.size(), nullptr);
  // All segments of a pair are of one curve: faces are connected, though the segments of two polygons that
  // are not convex may not be.
  std::size_t segment = 0;
  for (const FoundPair& pair : found) {
    const std::uint32_t of_pair = number(pair.keys[0][0]);
    for (std::size_t i = 0; i < pair.keys.size(); ++i, ++segment)
      for (std::size_t end = 0; end < 2; ++end) {
        const std::uint32_t point = number(pair.keys[i][end]);
        sets.join(of_pair, point);
        if (first[point] == nullptr) first[point] = &pair.segments[i][end];
        out.segments[segment][end] = *first[point];
      }
  }
  std::vector<std::uint32_t> curve_of(points.size(), kNull);
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::uint32_t& curve = curve_of[sets.leader(number(found[i].keys[0][0]))];
    if (curve == kNull) curve = out.curves++;
    out.pairs[i].curve = curve;
  }
}

}  // namespace

SelfIntersections self_intersections(const Mesh& mesh, const std::vector<FaceUse>& use, Workers& workers,
                                     std::uint64_t max_pairs) {
  const FloatMode float_mode;
  const Pieces pieces(mesh, use);
  std::vector<FoundPair> found;
  std::mutex lock;
  std::atomic<bool> is_full = false;
  pieces.for_each_pair(
      [&](FaceId f, FaceId g) {
        if (is_full || !pieces.meet(f, g, FaceMeeting::outside_shared)) return;
        const std::lock_guard<std::mutex> locked(lock);
        if (found.size() == max_pairs)
          is_full = true;
        else
          found.push_back({f, g, SelfContact::touch, {}, {}});
      },
      workers);
  if (is_full)
    throw InputError(mesh.name + ": more than " + std::to_string(max_pairs) +
                     " pairs of faces intersect, the limit set by max_pairs; raise it, or repair the mesh");
  std::sort(found.begin(), found.end(),
            [](const FoundPair& x, const FoundPair& y) { return x.f != y.f ? x.f < y.f : x.g < y.g; });
  workers.for_each(found.size(), [&](std::size_t i, unsigned) {
    FoundPair& pair = found[i];
    pieces.for_each_contact(pair.f, pair.g,
                            [&](const Triangle& s, const Triangle& t, const exact::PairContact& contact) {
                              pair.add(s, t, contact);
                            });
  });
  SelfIntersections out;
  for (const FoundPair& pair : found) {
    out.pairs.push_back({pair.f, pair.g, pair.kind, shared_corners(mesh, pair.f, pair.g), 0,
                         static_cast<std::uint32_t>(out.segments.size()),
                         static_cast<std::uint32_t>(pair.segments.size())});
    out.segments.insert(out.segments.end(), pair.segments.begin(), pair.segments.end());
  }
  find_curves(found, out);
  return out;
}

SelfIntersections self_intersections(const CheckedMesh& mesh, unsigned threads, std::uint64_t max_pairs) {
  Workers workers(threads);
  return self_intersections(mesh.mesh(), mesh.use(), workers, max_pairs);
}

}  // namespace lrb
