// Right answers that are lists of pairs: those within a distance, and self-intersections. By rational
// arithmetic where doubles do not decide with a margin.
#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "bench/quantities/truth.hpp"
#include "bench/stability/rational_oracles.hpp"

namespace lrb::stability {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using oracle::Rational;
using oracle::RationalPoints;

/// The real triangles of a body in world coordinates.
struct Faces {
  std::vector<std::array<VertexId, 3>> corners;
  std::vector<std::array<Vector3d, 3>> x;
  std::vector<RationalPoints> exact;
  std::vector<AlignedBox3d> boxes;

  explicit Faces(const LrbRep& rep) {
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      std::array<VertexId, 3> v{};
      rep.simplex(s, v.data());
      corners.push_back(v);
      x.emplace_back();
      exact.emplace_back();
      boxes.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        x.back()[k] = rep.vertices()[v[k]];
        boxes.back().extend(x.back()[k]);
        exact.back().push_back(oracle::rational({x.back()[k].x(), x.back()[k].y(), x.back()[k].z()}));
      }
    }
  }
  std::size_t size() const { return corners.size(); }
  oracle::Corners doubles(std::size_t t) const {
    oracle::Corners out;
    for (const Vector3d& v : x[t]) out.push_back({v.x(), v.y(), v.z()});
    return out;
  }
};

/// Differences of doubles, and sums of a few squares of them, have smaller relative errors.
constexpr double kMargin = 1e-12;

bool is_within(const Faces& a, std::size_t i, const Faces& b, std::size_t j, double within) {
  if (within == 0 && !a.boxes[i].intersects(b.boxes[j])) return false;
  // Squares of smaller numbers lose digits.
  constexpr double kLeastSquare = 1e-280;
  if (const double square = within * within; square > kLeastSquare) {
    if (a.boxes[i].squaredExteriorDistance(b.boxes[j]) * (1 - kMargin) > square) return false;
    for (const Vector3d& p : a.x[i])
      for (const Vector3d& q : b.x[j])
        if ((p - q).squaredNorm() < square * (1 - kMargin)) return true;
  }
  return oracle::distance_sq(a.doubles(i), b.doubles(j)) <= oracle::square(within);
}

oracle::RationalPoint normal_of(const RationalPoints& t) {
  return oracle::cross(oracle::minus(t[1], t[0]), oracle::minus(t[2], t[0]));
}

bool has_area(const RationalPoints& t) {
  const oracle::RationalPoint n = normal_of(t);
  return oracle::dot(n, n) != 0;
}

/// Returns true if two features share a point: corners, edges or triangles.
bool share_point(const RationalPoints& f, const RationalPoints& g) {
  for (unsigned which_f = 1; which_f < 1U << f.size(); ++which_f)
    for (unsigned which_g = 1; which_g < 1U << g.size(); ++which_g) {
      RationalPoints p, q;
      for (std::size_t k = 0; k < f.size(); ++k)
        if ((which_f >> k & 1) != 0) p.push_back(f[k]);
      for (std::size_t k = 0; k < g.size(); ++k)
        if ((which_g >> k & 1) != 0) q.push_back(g[k]);
      const auto closest = oracle::closest_of_features(p, q);
      if (closest && closest->distance_sq == 0) return true;
    }
  return false;
}

/// Returns true if two triangles with area share a point beyond the corners and edges that they share by
/// index.
bool intersect_beyond_shared(const Faces& f, std::size_t i, std::size_t j) {
  const RationalPoints &s = f.exact[i], &t = f.exact[j];
  std::vector<std::size_t> shared_i, shared_j;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      if (f.corners[i][k] == f.corners[j][l]) shared_i.push_back(k), shared_j.push_back(l);
  switch (shared_i.size()) {
    case 0:
      return !oracle::clearly_apart(s, t) && oracle::triangles_meet(s, t);
    case 1: {
      // Both triangles are starlike about the corner: a ray from it leaves them in their opposite edges, and
      // the intersection in the nearer of the two.
      const std::size_t k = shared_i[0], l = shared_j[0];
      return share_point({s[(k + 1) % 3], s[(k + 2) % 3]}, t) ||
             share_point(s, {t[(l + 1) % 3], t[(l + 2) % 3]});
    }
    case 2: {
      // Only in a common plane, on the same side of the edge.
      const oracle::RationalPoint edge = oracle::minus(s[shared_i[1]], s[shared_i[0]]);
      const auto side = [&](const RationalPoints& all, const std::vector<std::size_t>& of) {
        return oracle::cross(edge, oracle::minus(all[3 - of[0] - of[1]], all[of[0]]));
      };
      const oracle::RationalPoint u = side(s, shared_i), v = side(t, shared_j), out = oracle::cross(u, v);
      return oracle::dot(out, out) == 0 && oracle::dot(u, v) > 0;
    }
    default:
      return true;  // the same triangle twice
  }
}

}  // namespace

std::vector<SimplexPair> true_near_pairs(const LrbRep& a, const LrbRep& b, double within) {
  const Faces of_a(a), of_b(b);
  std::vector<SimplexPair> out;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    for (std::size_t j = 0; j < of_b.size(); ++j)
      if (is_within(of_a, i, of_b, j, within))
        out.push_back({static_cast<SimplexId>(i), static_cast<SimplexId>(j)});
  return out;
}

std::vector<SimplexPair> true_self_intersections(const LrbRep& body) {
  const Faces f(body);
  std::vector<bool> area;
  for (const RationalPoints& t : f.exact) area.push_back(has_area(t));
  std::vector<SimplexPair> out;
  for (std::size_t i = 0; i < f.size(); ++i)
    for (std::size_t j = i + 1; j < f.size(); ++j)
      if (area[i] && area[j] && f.boxes[i].intersects(f.boxes[j]) && intersect_beyond_shared(f, i, j))
        out.push_back({static_cast<SimplexId>(i), static_cast<SimplexId>(j)});
  return out;
}

}  // namespace lrb::stability
