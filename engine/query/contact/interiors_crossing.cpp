/// Proves that the interiors of two crossing bodies overlap: where two faces cross and no other face lies,
/// there are four wedges, one of which is inside both bodies.

#include <algorithm>
#include <map>

#include "engine/core/tolerances.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/query/contact/interiors.hpp"
#include "engine/query/contact/side_in_plane.hpp"

namespace lrb {
namespace {

using Corners = std::array<const double*, 3>;

/// Finds a face of A and a face of B that cross where no other face of either surface lies. Parity changes
/// across each of them there, so that one of the four wedges between them is inside both bodies.
class CrossingProof {
 public:
  CrossingProof(QueryContext& ctx, const CollideResult& result)
      : ctx_(ctx), result_(result), dim_(ctx[Side::a].rep().dim()) {
    for (const SimplexPair& p : result.pairs) {
      // For each simplex all simplices of the other body that it intersects.
      partners_[0][p.a].push_back(p.b);
      partners_[1][p.b].push_back(p.a);
    }
  }

  bool found() const {
    unsigned tries = 0;
    for (std::size_t i = 0; i < result_.pairs.size() && tries < kCrossingsTried; ++i) {
      if (result_.meets[i] != exact::Meet::cross) continue;
      ++tries;
      const SimplexPair& p = result_.pairs[i];
      // All simplices of A that could interfere near the crossing intersect p.b, and vice versa.
      if (is_alone(Side::a, p.a, partners_[1].at(p.b)) && is_alone(Side::b, p.b, partners_[0].at(p.a)))
        return true;
    }
    return false;
  }

 private:
  /// Returns true if no other simplex of the body that meets the partner of `s` meets the inside of `s`.
  /// (Sufficient: one that passes through the plane of `s` anywhere counts as if it did.)
  bool is_alone(Side side, SimplexId s, const std::vector<SimplexId>& others) const {
    Corners face;
    ctx_[side].world.corners(s, face.data());
    return std::all_of(others.begin(), others.end(), [&](SimplexId u) {
      if (u == s) return true;
      Corners other;
      ctx_[side].world.corners(u, other.data());
      return dim_ == 3 ? keeps_out(face, other) : keeps_out_2d(face, other);
    });
  }

  /// Returns true if the triangle `other` does not meet the inside of `face`.
  static bool keeps_out(const Corners& face, const Corners& other) {
    std::vector<const double*> in_plane;
    bool above = false, below = false;
    for (const double* p : other) {
      // On which side of the face's plane each corner lies, exactly.
      const int side = exact::orient3d(face[0], face[1], face[2], p);
      above |= side > 0;
      below |= side < 0;
      if (side == 0) in_plane.push_back(p);
    }
    // It passes through the plane, perhaps through the face.
    if (above && below) return false;
    for (int k = 0; k < 3; ++k) {
      // Otherwise only its corners in the plane can touch the face. Beyond the line of one edge they miss its
      // interior.
      const double *p = face[k], *q = face[(k + 1) % 3];
      const int inward = side_in_plane(face.data(), p, q, face[(k + 2) % 3]);
      const bool beyond = std::all_of(in_plane.begin(), in_plane.end(), [&](const double* x) {
        return side_in_plane(face.data(), p, q, x) * inward <= 0;
      });
      if (beyond) return true;
    }
    return false;
  }

  /// Does the same for segments: what is on the line of `face` must lie beyond one of its ends.
  static bool keeps_out_2d(const Corners& face, const Corners& other) {
    // A coordinate in which the segment has length orders the points on its line.
    const int axis = face[0][0] != face[1][0] ? 0 : 1;
    const double low = std::min(face[0][axis], face[1][axis]), high = std::max(face[0][axis], face[1][axis]);
    bool above = false, below = false, before = true, after = true;
    for (int k = 0; k < 2; ++k) {
      const int side = exact::orient2d(face[0], face[1], other[k]);
      above |= side > 0;
      below |= side < 0;
      if (side != 0) continue;
      before &= other[k][axis] <= low;
      after &= other[k][axis] >= high;
    }
    return !(above && below) && (before || after);
  }

  QueryContext& ctx_;
  const CollideResult& result_;
  int dim_;
  std::map<SimplexId, std::vector<SimplexId>> partners_[2];
};

}  // namespace

Answer crossing_interiors_overlap(QueryContext& context, const CollideResult& result) {
  for (const Side side : {Side::a, Side::b})
    if (!context[side].rep().closed()) return Answer::unknown;
  return CrossingProof(context, result).found() ? Answer::yes : Answer::unknown;
}

}  // namespace lrb
