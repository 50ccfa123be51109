// The distance from a point to one real face is convex, so over a piece of a lid it is largest at one of the
// piece's corners; and the distance to all real faces is no more than that to any one of them. So a lid is cut
// into pieces, each of which has a real face near it, and the lid's bound is the largest distance from a
// piece's corner to the piece's face. Which face a piece has and where it is cut decides only how tight the
// bound is, so a search in floats may choose them; the distances are computed in double.
//
// Pieces are cut, worst first, until the bound is within kTight of a distance that some point of the lids
// really has. A piece that hangs over the border of its face is cut there: its other part is nearer another
// face. So a flat lid over a floor of many coplanar faces takes as many pieces as there are faces under it.
//
// Rounding. A cut puts a new corner on an edge, up to 2^-50 beside it (in units, in which coordinates are
// about 1 at most): a point of the piece is then that far from a point of the two new ones, at the same place
// by their corners' weights. A piece is the outcome of at most kMostCuts cuts, so it stands for points at most
// 2^-42 away; kThicknessRounding covers that and the rounding of distances.
#include "engine/lrb/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <Eigen/Geometry>

#include "engine/core/parallel.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/lrb/nearest_face.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// The bound may be this many times a distance that was found.
constexpr double kTight = 1.05;
/// Distances below this share of the unit count as this: bounds so small need not be tight.
constexpr double kSmall = 1e-6;
/// Cuts that lead to one piece, and pieces of one region, after which the bound stays as it is.
constexpr std::uint32_t kMostCuts = 256;
constexpr std::size_t kMostPieces = 20000;
/// A piece this many times as long as its face is halved, no matter where the face ends.
constexpr double kMuchLonger = 4;
/// A triangle, or in 2D a segment (two corners).
using Simplex = std::array<Vector3d, 3>;

/// Part of a lid.
struct Piece {
  Simplex x;
  NearFace face;  ///< the real simplex, and the largest distance of a corner from it
  std::uint32_t cuts = 0;
  bool operator<(const Piece& other) const { return face.distance < other.face.distance; }
};

/// Where a piece is to be cut: between two of its corners.
struct Cut {
  int from, to;
  double share;  ///< of the way between them
};

/// Returns the longest edge of the first `corners` corners, halved, and its squared length.
std::pair<Cut, double> longest_edge(const Simplex& x, int corners) {
  Cut longest{0, 1, 0.5};
  double length_sq = 0;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < i; ++j)
      if (const double d = (x[i] - x[j]).squaredNorm(); d > length_sq) length_sq = d, longest = {j, i, 0.5};
  return {longest, length_sq};
}

/// Returns the direction, in a simplex, that leads out of it over its e-th border (an edge; in 2D an end).
Vector3d border_normal(const Simplex& t, int corners, int e) {
  if (corners == 2) return t[e] - t[1 - e];
  const Vector3d edge = t[(e + 1) % 3] - t[e], other = t[(e + 2) % 3] - t[e];
  const double square = edge.squaredNorm();
  return square > 0 ? Vector3d(edge * (edge.dot(other) / square) - other) : Vector3d(0, 0, 0);
}

/// Returns the cut by the border of a face beyond which the piece's corner `worst` lies, if another corner is on
/// the near side of it; else a cut whose share is 0.
Cut cut_at_border(const Simplex& piece, int worst, const Simplex& face, int corners) {
  Cut best{0, 1, 0};
  double furthest = 0;
  for (int e = 0; e < corners; ++e) {
    const Vector3d outward = border_normal(face, corners, e);
    const double beyond = outward.dot(piece[worst] - face[e]);
    if (!(beyond > furthest)) continue;
    furthest = beyond;
    best.share = 0;
    double least = 0;
    for (int k = 0; k < corners; ++k) {
      const double there = outward.dot(piece[k] - face[e]);
      if (!(there < least)) continue;
      least = there;
      best = {worst, k, beyond / (beyond - there)};
    }
  }
  constexpr double kAside = 1e-3;  // nearer an end than this, a cut gains nothing
  return best.share > kAside && best.share < 1 - kAside ? best : Cut{0, 1, 0};
}

class RegionMeter {
 public:
  /// `near`: (|V|) a real simplex near each vertex.
  RegionMeter(const LrbRep& rep, const std::vector<Vector3d>& x, const std::vector<NearFace>& near)
      : rep_(rep), x_(x), near_(near), nearest_(rep, x), corners_(rep.dim()) {}

  /// Returns the region's thickness in units.
  double measure(RegionId r) {
    if (rep_.lids(r).empty()) return std::numeric_limits<double>::infinity();
    heap_.clear();
    most_ = found_ = 0;
    for (const FaceId f : rep_.lids(r))
      for (const VertexId v : rep_.face(f)) found_ = std::max(found_, near_[v].distance);
    for (const FaceId f : rep_.lids(r)) add_lid(f);
    cut_worst();
    return most_ + kThicknessRounding;
  }

 private:
  double limit() const { return kTight * std::max(found_, kSmall); }

  Simplex corners_of(const VertexId v[3]) const { return {x_[v[0]], x_[v[1]], x_[v[2]]}; }

  void add_lid(FaceId f) {
    const std::size_t count = Mesh::simplices_of(rep_.face(f).size(), rep_.dim());
    for (std::size_t i = 0; i < count; ++i) {
      VertexId v[3] = {};
      rep_.simplex(SimplexId(rep_.first_simplex(f) + i), v);
      Piece piece;
      piece.x = corners_of(v);
      for (int k = 0; k < corners_; ++k) try_face(piece, near_[v[k]].simplex);
      add(piece);
    }
  }

  /// Measures the piece anew from the face that it has.
  void find_face(Piece& piece) const {
    piece.face.distance = 0;
    for (int k = 0; k < corners_; ++k)
      piece.face.distance = std::max(piece.face.distance, nearest_.distance(piece.x[k], piece.face.simplex));
  }

  /// Gives the piece this face if it is better than the one it has.
  void try_face(Piece& piece, SimplexId s) const {
    if (s == piece.face.simplex) return;
    double most = 0;
    for (int k = 0; k < corners_; ++k) {
      most = std::max(most, nearest_.distance(piece.x[k], s));
      if (most >= piece.face.distance) return;
    }
    piece.face = {s, most};
  }

  Vector3d middle_of(const Piece& piece) const {
    Vector3d middle = piece.x[0] + piece.x[1];
    if (corners_ == 3) middle += piece.x[2];
    return middle / corners_;
  }

  /// Finds a face for a piece that has one already, and puts it where it belongs.
  void add(Piece& piece) {
    if (piece.face.distance > limit()) {
      const Vector3d middle = middle_of(piece);
      const SimplexId s = piece.face.simplex;
      const NearFace nearest = nearest_.find(middle, {s, nearest_.distance(middle, s)});
      found_ = std::max(found_, nearest.distance);
      try_face(piece, nearest.simplex);
    }
    if (piece.face.distance <= limit()) {
      most_ = std::max(most_, piece.face.distance);
      return;
    }
    heap_.push_back(piece);
    std::push_heap(heap_.begin(), heap_.end());
  }

  /// Cuts the worst piece on the heap until it is within the limit, or there are too many.
  void cut_worst() {
    for (std::size_t cuts = 0; !heap_.empty(); ++cuts) {
      std::pop_heap(heap_.begin(), heap_.end());
      const Piece worst = heap_.back();
      heap_.pop_back();
      if (worst.face.distance <= limit() || worst.cuts == kMostCuts || cuts == kMostPieces) {
        most_ = std::max(most_, worst.face.distance);  // the others are no worse
        return;
      }
      for (Piece& part : divided(worst, choose_cut(worst))) {
        find_face(part);
        add(part);
      }
    }
  }

  std::array<Piece, 2> divided(const Piece& piece, const Cut& cut) const {
    const Vector3d between = piece.x[cut.from] + cut.share * (piece.x[cut.to] - piece.x[cut.from]);
    std::array<Piece, 2> parts = {piece, piece};
    parts[0].x[cut.from] = parts[1].x[cut.to] = between;
    for (Piece& part : parts) ++part.cuts;
    return parts;
  }

  Cut choose_cut(const Piece& piece) const {
    VertexId v[3] = {};
    rep_.simplex(piece.face.simplex, v);
    const Simplex face = corners_of(v);
    const auto [longest, length_sq] = longest_edge(piece.x, corners_);
    if (length_sq > kMuchLonger * kMuchLonger * longest_edge(face, corners_).second) return longest;
    int worst = 0;
    double most = -1;
    for (int k = 0; k < corners_; ++k)
      if (const double d = nearest_.distance(piece.x[k], piece.face.simplex); d > most) most = d, worst = k;
    const Cut at_border = cut_at_border(piece.x, worst, face, corners_);
    return at_border.share > 0 ? at_border : longest;
  }

  const LrbRep& rep_;
  const std::vector<Vector3d>& x_;
  const std::vector<NearFace>& near_;
  NearestFace nearest_;
  const int corners_;        ///< of a piece and of a real simplex
  std::vector<Piece> heap_;  ///< pieces whose bound is still above the limit, worst first
  double most_ = 0;          ///< bound of the pieces that are done
  double found_ = 0;         ///< largest distance that some point of the lids has
};

}  // namespace

std::vector<double> region_thickness(const LrbRep& rep, unsigned threads) {
  Workers workers(threads);
  const std::vector<Vector3d> x = vertices_in_units(rep);
  std::vector<NearFace> near(x.size());
  std::vector<std::unique_ptr<NearestFace>> finders(workers.count());
  for (auto& finder : finders) finder = std::make_unique<NearestFace>(rep, x);
  workers.for_each(x.size(), [&](std::size_t v, unsigned worker) { near[v] = finders[worker]->find(x[v]); });
  std::vector<std::unique_ptr<RegionMeter>> meters(workers.count());
  for (auto& meter : meters) meter = std::make_unique<RegionMeter>(rep, x, near);
  std::vector<double> out(rep.region_count());
  workers.for_each(out.size(), [&](std::size_t r, unsigned worker) {
    out[r] = meters[worker]->measure(static_cast<RegionId>(r)) * rep.tree().unit();
  });
  return out;
}

}  // namespace lrb
