#pragma once
/// How bodies whose surfaces do not meet lie to each other, by the parity of a segment to a random point far
/// off, in rationals where long doubles cannot decide; segments that graze an edge are thrown away. Shares
/// nothing with engine/exact and engine/collide but the definition of world coordinates.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/rational_oracle.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::torture {

using WorldPoint = std::array<double, 3>;

inline std::vector<WorldPoint> world_points(const LrbRep& rep, const Pose& pose) {
  std::vector<WorldPoint> x;
  for (const auto& v : rep.vertices()) {
    const Eigen::Vector3d w = pose.apply(v);
    x.push_back({w.x(), w.y(), w.z()});
  }
  return x;
}

/// Sign of the volume of four points.
inline int side_of(const WorldPoint& a, const WorldPoint& b, const WorldPoint& c, const WorldPoint& d) {
  using Real = long double;
  Real u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = Real{b[k]} - a[k];
    v[k] = Real{c[k]} - a[k];
    w[k] = Real{d[k]} - a[k];
  }
  Real det = 0, size = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    det += (u[i] * v[j] - u[j] * v[i]) * w[k];
    size += (std::fabs(u[i] * v[j]) + std::fabs(u[j] * v[i])) * std::fabs(w[k]);
  }
  if (std::fabs(det) > size * 0x1p-58L) return det > 0 ? 1 : -1;
  return oracle::orientation({a.data(), b.data(), c.data(), d.data()});
}

inline int side_of(const WorldPoint& a, const WorldPoint& b, const WorldPoint& c) {
  return oracle::orientation({a.data(), b.data(), c.data()});
}

/// Returns the corners of a simplex among a body's world points.
inline std::array<const double*, 3> corners_of(const LrbRep& rep, const std::vector<WorldPoint>& x,
                                               SimplexId s) {
  VertexId v[3];
  rep.simplex(s, v);
  std::array<const double*, 3> out{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(rep.dim()); ++k) out[k] = x[v[k]].data();
  return out;
}

/// True if the boxes of two simplices with n corners in n dimensions are disjoint.
inline bool boxes_disjoint(const double* const a[3], const double* const b[3], int n) {
  for (int axis = 0; axis < n; ++axis) {
    double low_a = INFINITY, high_a = -INFINITY, low_b = INFINITY, high_b = -INFINITY;
    for (int k = 0; k < n; ++k) {
      low_a = std::min(low_a, a[k][axis]);
      high_a = std::max(high_a, a[k][axis]);
      low_b = std::min(low_b, b[k][axis]);
      high_b = std::max(high_b, b[k][axis]);
    }
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

class ParityOracle {
 public:
  ParityOracle(const LrbRep& rep, const Pose& pose) : ParityOracle(rep, pose, all_real(rep)) {}
  /// Of another closed surface than the body's: some simplices of it.
  ParityOracle(const LrbRep& rep, const Pose& pose, std::vector<SimplexId> simplices)
      : rep_(rep), simplices_(std::move(simplices)), x_(world_points(rep, pose)) {
    for (const SimplexId s : simplices_) {
      VertexId v[3];
      rep.simplex(s, v);
      for (int k = 0; k < rep.dim(); ++k) {
        box_.extend(Eigen::Vector3d(x_[v[k]].data()));
        for (int axis = 0; axis < 3; ++axis) reach_ = std::max(reach_, std::fabs(x_[v[k]][axis]));
      }
    }
  }

  const Eigen::AlignedBox3d& box() const { return box_; }
  bool holds(const WorldPoint& p, shapes::RandomEngine& random) const {
    for (int attempt = 0;; ++attempt) {
      if (attempt == 100) throw std::logic_error("no segment to the far avoids all edges");
      WorldPoint far;
      for (int k = 0; k < 3; ++k)
        far[k] = std::max(reach_, std::fabs(p[k])) * shapes::uniform(random, -1, 1) *
                 (rep_.dim() == 2 && k == 2 ? 0 : 1);
      const int k = static_cast<int>(random() % static_cast<unsigned>(rep_.dim()));
      far[k] = (random() % 2 ? 4 : -4) * std::max({reach_, std::fabs(p[k]), 1e-300});
      bool grazes = false, odd = false;
      for (std::size_t i = 0; i < simplices_.size() && !grazes; ++i)
        odd ^= crosses(p, far, simplices_[i], grazes);
      if (!grazes) return odd;
    }
  }

  std::size_t held_pieces(const ParityOracle& inner, shapes::RandomEngine& random) const {
    std::size_t n = 0;
    for (const VertexId v : inner.rep_.component_vertices()) n += holds(inner.x_[v], random);
    return n;
  }

 private:
  static std::vector<SimplexId> all_real(const LrbRep& rep) {
    std::vector<SimplexId> all(rep.real_simplex_count());
    std::iota(all.begin(), all.end(), SimplexId{0});
    return all;
  }

  bool crosses(const WorldPoint& p, const WorldPoint& q, SimplexId s, bool& grazes) const {
    VertexId v[3] = {};
    rep_.simplex(s, v);
    const auto& a = x_[v[0]];
    const auto& b = x_[v[1]];
    if (rep_.dim() == 2) return crosses_flat(p, q, a, b, grazes);
    const auto& c = x_[v[2]];
    const int at_p = side_of(a, b, c, p), at_q = side_of(a, b, c, q);
    if (at_p * at_q > 0) return false;
    if (at_p == 0 && at_q == 0 && is_flat(a, b, c)) return false;
    const int e0 = side_of(p, q, a, b), e1 = side_of(p, q, b, c), e2 = side_of(p, q, c, a);
    const bool left = e0 > 0 || e1 > 0 || e2 > 0, right = e0 < 0 || e1 < 0 || e2 < 0;
    if (left && right) return false;
    if (e0 == 0 || e1 == 0 || e2 == 0 || at_q == 0) grazes = true;
    return at_p != 0;
  }

  static bool is_flat(const WorldPoint& a, const WorldPoint& b, const WorldPoint& c) {
    return oracle::affine_dimension_of({a.data(), b.data(), c.data()}, 3) < 2;
  }

  static bool crosses_flat(const WorldPoint& p, const WorldPoint& q, const WorldPoint& a, const WorldPoint& b,
                           bool& grazes) {
    const int at_p = side_of(a, b, p), at_q = side_of(a, b, q), at_a = side_of(p, q, a),
              at_b = side_of(p, q, b);
    if (at_p * at_q > 0 || at_a * at_b > 0 || a == b) return false;
    if (at_a == 0 || at_b == 0 || at_q == 0) grazes = true;
    return at_p != 0;
  }

  const LrbRep& rep_;
  std::vector<SimplexId> simplices_;
  std::vector<WorldPoint> x_;
  double reach_ = 0;
  Eigen::AlignedBox3d box_;
};

/// For bodies without a pair that meets.
inline Relation relation_by_parity(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                   shapes::RandomEngine& random) {
  const ParityOracle oa(a, pose_a), ob(b, pose_b);
  if (!a.closed() || !b.closed())
    return oa.box().intersects(ob.box()) ? Relation::undefined : Relation::separate;
  const std::size_t a_in_b = ob.held_pieces(oa, random), b_in_a = oa.held_pieces(ob, random);
  const std::size_t pieces_a = a.component_vertices().size(), pieces_b = b.component_vertices().size();
  if (a_in_b > 0 && a_in_b == pieces_a) return Relation::a_inside_b;
  if (b_in_a > 0 && b_in_a == pieces_b) return Relation::b_inside_a;
  if (a_in_b > 0) return Relation::a_inside_b;
  return b_in_a > 0 ? Relation::b_inside_a : Relation::separate;
}

}  // namespace lrb::torture
