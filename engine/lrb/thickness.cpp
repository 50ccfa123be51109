// One-sided Hausdorff distance from the lids of a region to the real faces, by branch and bound.
//
// Bound. The distance to one real face is convex, so over a piece of a lid it is largest at one of the
// piece's corners. The distance to all real faces is at most that to any one of them. A lid is therefore
// divided into pieces, each of which is assigned a nearby real face, and the lid's bound is the largest
// distance from a piece's corner to the piece's face. The choice of faces and cuts only affects how tight the
// bound is, so it may be made in floats; the distances are computed in double.
//
// Search. Pieces are cut, worst first, until the bound is within kTight of the distance of an actual point of
// the lids. A nearby face is found by walking from the face of the piece to adjacent faces. The tree is
// searched only if the walk ends at a larger distance than any found so far, because that would raise the
// value that the bound is compared with. With 100,000 faces this is one walk in 28, and takes a quarter of
// the time of searching the tree for each piece. A piece that extends beyond the border of its face is cut
// there, because the other part is closer to another face. A flat lid over a floor of many coplanar faces
// therefore takes as many pieces as there are faces under it.
//
// Rounding. A cut places a new corner on an edge with an error of at most 2^-50 (in units, in which
// coordinates are at most about 1). A point of the piece then has that distance to the point of the two new
// pieces with the same barycentric coordinates. A piece results from at most kMaxCuts cuts, so it represents
// points at most 2^-42 away; kThicknessRounding covers that and the rounding of distances.

#include "engine/lrb/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {
namespace {

/// Writes the squared distances from p (units) to the boxes of a node's children, in float. They only
/// determine the order of the search and which simplex it chooses.
void box_distances_sq(const TreeNode& node, const Eigen::Vector3d& p, float out[kTreeWidth]) {
  // The difference is computed in double: close to a small node far from zero, floats would lose all digits.
  const float from_origin[3] = {static_cast<float>(p.x() - node.origin[0]),
                                static_cast<float>(p.y() - node.origin[1]),
                                static_cast<float>(p.z() - node.origin[2])};
  for (std::uint32_t k = 0; k < kTreeWidth; ++k) out[k] = 0;
  for (int i = 0; i < 3; ++i) {
    // Coordinate of p on the node's axis i, from the start of the quantized range.
    const float q = node.frame[i][0] * from_origin[0] + node.frame[i][1] * from_origin[1] +
                    node.frame[i][2] * from_origin[2] - node.base[i];
    for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
      // Distance to the interval [lo, hi] on this axis; 0 inside. Squares add up over the axes.
      const float low = node.scale[i] * static_cast<float>(node.lo[i][k]) - q;
      const float high = q - node.scale[i] * static_cast<float>(node.hi[i][k]);
      const float d = std::max(std::max(low, high), 0.0f);
      out[k] += d * d;
    }
  }
}

/// Writes the children whose distance is below a limit to `order`, closest first. Returns their number.
std::uint32_t sort_below(const float d[kTreeWidth], std::uint32_t children, double limit_sq,
                         std::uint32_t order[kTreeWidth]) {
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < children; ++k) {
    if (!(static_cast<double>(d[k]) < limit_sq)) continue;
    // Insertion sort: at most kTreeWidth (8) entries.
    std::uint32_t at = count++;
    for (; at > 0 && d[order[at - 1]] > d[k]; --at) order[at] = order[at - 1];
    order[at] = k;
  }
  return count;
}

}  // namespace

std::vector<RealSimplex> real_simplices(const LrbRep& rep) {
  const std::vector<Across> neighbours = real_neighbours(rep);
  const auto at = [&](VertexId v) { return Eigen::Vector3d(rep.vertices()[v] / rep.tree().unit()); };
  std::vector<RealSimplex> out(rep.real_simplex_count());
  for (SimplexId s = 0; s < out.size(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    const Eigen::Vector3d a = at(v[0]), c = rep.dim() == 3 ? at(v[2]) : a;
    out[s] = {a, at(v[1]) - a, c - a, neighbours[s]};
  }
  return out;
}

namespace {

ClosestPart<double> closest_part(const RealSimplex& t, const Eigen::Vector3d& p) {
  return lrb::closest_part<double>(t.ab, t.ac, p - t.a);
}

/// Returns the borders that have the closest point, as bits: 2D, ends; 3D, edges.
unsigned borders(TrianglePart part, bool is_segment) {
  constexpr unsigned kOfTriangle[] = {0, 1, 2, 4, 1 | 4, 1 | 2, 2 | 4}, kOfSegment[] = {0, 0, 2, 0, 1, 2, 0};
  return (is_segment ? kOfSegment : kOfTriangle)[static_cast<int>(part)];
}

}  // namespace

double NearestFace::distance(const Eigen::Vector3d& p, SimplexId s) const {
  return std::sqrt(closest_part(simplices_[s], p).distance_sq);
}

/// A closer point can be beyond a border only if the closest point so far is on that border.
NearFace NearestFace::walk(const Eigen::Vector3d& p, SimplexId from) const {
  // Greedy descent on the surface. The distance decreases at each step, so the walk terminates. It may end in
  // a local minimum, which callers account for.
  auto nearest = closest_part(simplices_[from], p);
  for (bool moves = true; moves;) {
    moves = false;
    const unsigned on = borders(nearest.part, is_segment_);
    const Across& across = simplices_[from].across;
    for (int e = 0; e < 3; ++e) {
      if ((on >> e & 1) == 0 || across[e] == kNull) continue;
      const auto there = closest_part(simplices_[across[e]], p);
      if (there.distance_sq < nearest.distance_sq) nearest = there, from = across[e], moves = true;
    }
  }
  return {from, std::sqrt(nearest.distance_sq)};
}

/// Visits the closest boxes first. Uses an explicit stack, because the height of a tree from a file is
/// unbounded.
NearFace NearestFace::find(const Eigen::Vector3d& p, NearFace known) {
  // Depth-first branch and bound (Roussopoulos et al. 1995): closest boxes first, subtrees beyond the best
  // distance are pruned.
  NearFace best = known;
  double best_sq = known.distance * known.distance;
  stack_.clear();
  if (!tree_.empty()) stack_.push_back({0, 0});
  while (!stack_.empty()) {
    const Branch branch = stack_.back();
    stack_.pop_back();
    // The best distance may have decreased since the branch was pushed.
    if (!(static_cast<double>(branch.distance_sq) < best_sq)) continue;
    const TreeNode& node = tree_.nodes()[branch.node];
    float d[kTreeWidth];
    std::uint32_t order[kTreeWidth];
    box_distances_sq(node, p, d);
    const std::uint32_t count = sort_below(d, node.count, best_sq, order);
    if (node.is_leaf == 0) {
      // Pushed in reverse, so that the closest child is popped first.
      for (std::uint32_t i = count; i-- > 0;) stack_.push_back({node.first + order[i], d[order[i]]});
      continue;
    }
    // Leaf: distances to the simplices in double. Boxes are sorted, so the first one too far ends the loop.
    for (std::uint32_t i = 0; i < count && static_cast<double>(d[order[i]]) < best_sq; ++i) {
      const SimplexId s = tree_.blocks()[node.first].simplex[order[i]];
      const double square = closest_part(simplices_[s], p).distance_sq;
      if (square < best_sq) best_sq = square, best.simplex = s;
    }
  }
  if (best.simplex != known.simplex) best.distance = std::sqrt(best_sq);
  return best;
}

std::vector<bool> regions_on_body(const LrbRep& rep) {
  const auto at = [&](VertexId v) { return rep.vertices()[v].data(); };
  const auto is_flat = [&](RegionId r) {
    VertexId p[3], v[3];
    rep.simplex(rep.first_simplex(rep.lids(r)[0]), p);
    const exact::Axes axes = exact::axes_for(at(p[0]), at(p[1]), at(p[2]));
    if (axes.turn == 0) return false;
    for (const FaceId f : rep.collector(r)) {
      if (!rep.is_real(f) && rep.inner_cell(f) != r) return false;
      for (std::size_t i = 0; i < Mesh::simplices_of(rep.face(f).size(), 3); ++i) {
        rep.simplex(SimplexId(rep.first_simplex(f) + i), v);
        for (const VertexId corner : v)
          if (exact::orient3d(at(p[0]), at(p[1]), at(p[2]), at(corner)) != 0) return false;
        if (axes.turn * exact::orient_axes(at(v[0]), at(v[1]), at(v[2]), axes.x, axes.y) < 0) return false;
      }
    }
    return true;
  };
  std::vector<bool> on_body(rep.region_count(), false);
  std::optional<BoundarySum> sum;
  for (RegionId r = 0; rep.dim() == 3 && r < rep.region_count(); ++r) {
    if (rep.lids(r).empty() || !is_flat(r)) continue;
    // In a plane, only the empty surface is closed: the lids cover as much as the floor.
    if (!sum) sum.emplace(rep);
    for (const FaceId f : rep.lids(r)) sum->add(f);
    for (const FaceId f : rep.floor(r)) sum->add_reversed(f);
    VertexId open_at[2];
    on_body[r] = sum->take_closed(open_at);
  }
  return on_body;
}

namespace {

using Eigen::Vector3d;

/// Maximum ratio of the bound to a distance found. 1.05: 2 to 7 % more faces for a tolerance (six real
/// meshes), in about the same time, because most cuts are at the borders of faces.
constexpr double kTight = 1.01;
/// Smaller distances (in units) count as this, because bounds below it need not be tight.
constexpr double kSmall = 1e-6;
/// Maximum number of cuts that lead to one piece, and of pieces of one region, after which the bound is no
/// longer refined.
constexpr std::uint32_t kMaxCuts = 256;
constexpr std::size_t kMaxPieces = 20000;
/// Ratio of the lengths of a piece and its face above which the piece is bisected, wherever the face ends.
constexpr double kMuchLonger = 4;
/// A triangle, or in 2D a segment (two corners).
using Simplex = std::array<Vector3d, 3>;

/// A part of a lid.
struct Piece {
  Simplex x;
  std::array<double, 3> deviation;                        ///< distance of each corner to the face
  SimplexId face = kNull;                                 ///< a real simplex
  double most = std::numeric_limits<double>::infinity();  ///< the maximum of `deviation`
  std::uint32_t cuts = 0;
};

/// An entry of the queue of pieces.
struct Waiting {
  double most;  ///< maximum distance of the piece
  std::uint32_t piece;
  bool operator<(const Waiting& other) const { return most < other.most; }
};

/// The position of a cut between two corners of a piece.
struct Cut {
  int from, to;
  double share;  ///< position on the segment from `from` to `to`, 0 to 1
};

/// Returns the cut that bisects the longest edge among the first `corners` corners, and its squared length.
std::pair<Cut, double> longest_edge(const Simplex& x, int corners) {
  Cut longest{0, 1, 0.5};
  double length_sq = 0;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < i; ++j)
      if (const double d = squared_norm3(x[i] - x[j]); d > length_sq) length_sq = d, longest = {j, i, 0.5};
  return {longest, length_sq};
}

/// Returns the direction, within a simplex, that leads out of it across its e-th border (an edge; 2D: an
/// end).
Vector3d border_normal(const Simplex& t, int corners, int e) {
  // 2D: the direction from the other end to this one.
  if (corners == 2) return t[e] - t[1 - e];
  // 3D: perpendicular to the edge, away from the third corner, with the triangle's height as its length. An
  // edge of length 0 has no normal; the zero vector then never counts as crossed.
  const Vector3d edge = t[(e + 1) % 3] - t[e], other = t[(e + 2) % 3] - t[e];
  const double square = squared_norm3(edge);
  return square > 0 ? Vector3d(edge * (dot3(edge, other) / square) - other) : Vector3d(0, 0, 0);
}

/// Returns the cut along the border of a face that separates the piece's corner `worst` from another corner.
/// Returns a cut with share 0 if no corner is on the near side of that border.
Cut cut_at_border(const Simplex& piece, int worst, const Simplex& face, int corners) {
  Cut best{0, 1, 0};
  double furthest = 0;
  for (int e = 0; e < corners; ++e) {
    const Vector3d outward = border_normal(face, corners, e);
    // Both `beyond` and `there` are scaled by the normal's length, which cancels in their quotient.
    const double beyond = dot3(outward, piece[worst] - face[e]);
    if (!(beyond > furthest)) continue;
    furthest = beyond;
    // Discard the cut at an earlier border: only the border that is exceeded most is considered.
    best.share = 0;
    // Cut towards the corner deepest on the near side, at the crossing of the edge between the two and the
    // border.
    double least = 0;
    for (int k = 0; k < corners; ++k) {
      const double there = dot3(outward, piece[k] - face[e]);
      if (!(there < least)) continue;
      least = there;
      best = {worst, k, beyond / (beyond - there)};
    }
  }
  constexpr double kAside = 1e-3;  // closer to an end than this, a cut gains nothing
  return best.share > kAside && best.share < 1 - kAside ? best : Cut{0, 1, 0};
}

class RegionMeter {
 public:
  /// `near`: (|V|) a real simplex near each vertex.
  RegionMeter(const LrbRep& rep, const std::vector<Vector3d>& x, const std::vector<RealSimplex>& simplices,
              const std::vector<NearFace>& near)
      : rep_(rep), x_(x), simplices_(simplices), near_(near), nearest_(rep, simplices), corners_(rep.dim()) {}

  /// Returns the region's thickness in units.
  double measure(RegionId r) {
    if (rep_.lids(r).empty()) return std::numeric_limits<double>::infinity();
    heap_.clear();
    pieces_.clear();
    most_ = found_ = 0;
    // Lower bound: the corners of the lids. It only controls when the search stops, so its rounding cannot
    // make the result too small.
    for (const FaceId f : rep_.lids(r))
      for (const VertexId v : rep_.face(f)) found_ = std::max(found_, near_[v].distance);
    // Upper bound: initial pieces, one per simplex of a lid, then refinement.
    for (const FaceId f : rep_.lids(r))
      if (!add_lid(f)) return std::numeric_limits<double>::infinity();
    cut_worst();
    return most_ + kThicknessRounding;
  }

 private:
  double limit() const { return kTight * std::max(found_, kSmall); }

  Simplex corners_of(const VertexId v[3]) const { return {x_[v[0]], x_[v[1]], x_[v[2]]}; }

  /// Divides a lid into pieces. Returns false if no real face has a finite distance to it, as in a damaged
  /// file.
  bool add_lid(FaceId f) {
    const std::size_t count = Mesh::simplices_of(rep_.face(f).size(), rep_.dim());
    for (std::size_t i = 0; i < count; ++i) {
      VertexId v[3] = {};
      rep_.simplex(SimplexId(rep_.first_simplex(f) + i), v);
      Piece piece;
      piece.x = corners_of(v);
      // Candidates: the faces near the corners. try_face() keeps the one with the smallest bound.
      for (int k = 0; k < corners_; ++k)
        if (near_[v[k]].simplex != kNull) try_face(piece, near_[v[k]].simplex);
      if (piece.face == kNull) return false;
      add(piece);
    }
    return true;
  }

  /// Assigns this face to the piece if it bounds the piece better than the current one.
  void try_face(Piece& piece, SimplexId s) const {
    if (s == piece.face) return;
    std::array<double, 3> deviation{};
    double most = 0;
    for (int k = 0; k < corners_; ++k) {
      // A face is better if all its corner distances are below the current bound: stop at the first that is
      // not.
      deviation[k] = nearest_.distance(piece.x[k], s);
      if (!(deviation[k] < piece.most)) return;  // also on overflow
      most = std::max(most, deviation[k]);
    }
    piece.face = s, piece.deviation = deviation, piece.most = most;
  }

  Vector3d centroid_of(const Piece& piece) const {
    Vector3d centroid = piece.x[0] + piece.x[1];
    if (corners_ == 3) centroid += piece.x[2];
    return centroid / corners_;
  }

  /// Searches for a better face for a piece. Returns true if the piece is within the limit then.
  bool is_settled(Piece& piece) {
    if (piece.most > limit()) {
      // The face near the centroid often bounds the entire piece better.
      const Vector3d centroid = centroid_of(piece);
      NearFace near = nearest_.walk(centroid, piece.face);
      // The walk may end in a local minimum: another part of the surface may be closer.
      if (near.distance > found_) near = nearest_.find(centroid, near);
      // The centroid is a point of the lid, so its distance raises the lower bound.
      found_ = std::max(found_, near.distance);
      try_face(piece, near.simplex);
    }
    if (piece.most > limit()) return false;
    most_ = std::max(most_, piece.most);
    return true;
  }

  void add(Piece& piece) {
    if (is_settled(piece)) return;
    pieces_.push_back(piece);
    wait(pieces_.size() - 1);
  }

  void wait(std::size_t piece) {
    heap_.push_back({pieces_[piece].most, static_cast<std::uint32_t>(piece)});
    std::push_heap(heap_.begin(), heap_.end());
  }

  /// Cuts the worst waiting piece until it is within the limit, or the limit on cuts or pieces is reached.
  void cut_worst() {
    // Best-first branch and bound: the top of the heap has the largest upper bound of all open pieces.
    for (std::size_t cuts = 0; !heap_.empty(); ++cuts) {
      const Waiting worst = heap_.front();
      Piece& piece = pieces_[worst.piece];
      if (worst.most <= limit() || piece.cuts == kMaxCuts || cuts == kMaxPieces) {
        most_ = std::max(most_, worst.most);  // the others are no worse
        return;
      }
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
      // Split; store one part in the slot of the whole. add() may reallocate pieces_, so `piece` is not used
      // after it.
      Piece part = divide(piece, choose_cut(piece));
      if (!is_settled(piece)) wait(worst.piece);
      add(part);
    }
  }

  /// Cuts a piece in two: `piece` becomes one part, the other is returned.
  Piece divide(Piece& piece, const Cut& cut) const {
    // The distance to one face is convex, so the new corner is no further from it than the worse end of the
    // cut edge: neither part has a larger bound than the whole.
    const Vector3d between = piece.x[cut.from] + cut.share * (piece.x[cut.to] - piece.x[cut.from]);
    const double deviation = nearest_.distance(between, piece.face);
    ++piece.cuts;
    Piece other = piece;
    move_corner(piece, cut.from, between, deviation);
    move_corner(other, cut.to, between, deviation);
    return other;
  }

  void move_corner(Piece& piece, int k, const Vector3d& to, double deviation) const {
    piece.x[k] = to;
    piece.deviation[k] = deviation;
    piece.most = *std::max_element(piece.deviation.begin(), piece.deviation.begin() + corners_);
  }

  Cut choose_cut(const Piece& piece) const {
    const RealSimplex& t = simplices_[piece.face];
    const Simplex face = {t.a, t.a + t.ab, t.a + t.ac};
    // A piece much longer than its face spans many faces: bisect its longest edge (fast progress on large
    // lids).
    const auto [longest, length_sq] = longest_edge(piece.x, corners_);
    if (length_sq > kMuchLonger * kMuchLonger * longest_edge(face, corners_).second) return longest;
    // Otherwise separate the worst corner along the border of the face; bisect if there is no such cut.
    const auto worst = std::max_element(piece.deviation.begin(), piece.deviation.begin() + corners_) -
                       piece.deviation.begin();
    const Cut at_border = cut_at_border(piece.x, static_cast<int>(worst), face, corners_);
    return at_border.share > 0 ? at_border : longest;
  }

  const LrbRep& rep_;
  const std::vector<Vector3d>& x_;
  const std::vector<RealSimplex>& simplices_;
  const std::vector<NearFace>& near_;
  NearestFace nearest_;
  const int corners_;  ///< number of corners of a piece and of a real simplex
  std::vector<Piece> pieces_;
  std::vector<Waiting> heap_;  ///< pieces with a bound above the limit, worst first
  double most_ = 0;            ///< bound of the finished pieces
  double found_ = 0;           ///< largest distance of an actual point of the lids
};

/// Returns a real simplex near each vertex: one that contains the vertex if there is one.
std::vector<NearFace> near_vertices(const LrbRep& rep, const std::vector<Vector3d>& x,
                                    const std::vector<RealSimplex>& simplices, Workers& workers) {
  std::vector<NearFace> near(x.size());
  // A vertex of a real simplex is on it: distance 0.
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    for (int k = 0; k < rep.dim(); ++k) near[v[k]] = {s, 0};
  }
  // Vertices of pseudo faces are searched in the tree. Each worker has its own search stack.
  std::vector<NearestFace> finders(workers.count(), NearestFace(rep, simplices));
  workers.for_each(x.size(), [&](std::size_t v, unsigned worker) {
    if (near[v].simplex == kNull) near[v] = finders[worker].find(x[v]);
  });
  return near;
}

}  // namespace

std::vector<double> region_thickness(const LrbRep& rep, unsigned threads) {
  const FloatMode float_mode;
  Workers workers(threads);
  std::vector<Vector3d> x;
  for (const Vector3d& v : rep.vertices()) x.push_back(v / rep.tree().unit());
  const std::vector<RealSimplex> simplices = real_simplices(rep);
  const std::vector<NearFace> near = near_vertices(rep, x, simplices, workers);
  // Regions are independent. Each worker measures them with its own meter, whose state is reset per region.
  std::vector<RegionMeter> meters(workers.count(), RegionMeter(rep, x, simplices, near));
  std::vector<double> out(rep.region_count());
  const std::vector<bool> on_body = regions_on_body(rep);
  workers.for_each(out.size(), [&](std::size_t r, unsigned worker) {
    if (!on_body[r]) out[r] = meters[worker].measure(static_cast<RegionId>(r)) * rep.tree().unit();
  });
  return out;
}

}  // namespace lrb
