/// The overlay of two patches, and the reduction of its corners.
///
/// 1. Project both patches along the normal. Faces that are too steep provide vertices only.
/// 2. Sweep over the projected boxes for pairs of simplices that may overlap.
/// 3. Collect vertices on faces and edges that cross, and merge those with the same features.
/// 4. Choose the deepest candidate, then those of largest spread.

#include "engine/distance/manifold_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/mesh/vertex_groups.hpp"

namespace lrb {

using Eigen::Vector2d;
using Eigen::Vector3d;

void VertexStars::begin(const LrbRep& rep) {
  if (serial_ == rep.serial()) return;
  serial_ = rep.serial();
  const std::span<const Vector3d> x = rep.vertices();
  place_ = first_at_positions(x);
  // Simplices by counting sort.
  const int n = rep.simplex_size();
  VertexId v[3];
  offsets_.assign(x.size() + 1, 0);
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    rep.simplex(s, v);
    for (int k = 0; k < n; ++k) ++offsets_[place_[v[k]] + 1];
  }
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  simplices_.resize(offsets_.back());
  std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  Eigen::AlignedBox3d box;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    rep.simplex(s, v);
    for (int k = 0; k < n; ++k) {
      simplices_[next[place_[v[k]]]++] = s;
      box.extend(x[v[k]]);
    }
  }
  diagonal_ = box.isEmpty() ? 0 : stable_norm3(box.sizes());
}

namespace {

/// A simplex in the frame of a manifold: two coordinates across the normal, and its height along it.
struct Projected {
  const PatchSimplex* simplex;
  Vector2d at[3];
  double height[3];
  bool is_face;      ///< not too steep to carry points
  double low, high;  ///< along the first coordinate
};

SurfaceFeatureId vertex_id(const PatchSimplex& s, int k) {
  return {FeatureKind::vertex, s.place[k], s.place[k]};
}

SurfaceFeatureId edge_id(const PatchSimplex& s, int k, int next) {
  const std::uint32_t v = s.place[k], w = s.place[next];
  return {FeatureKind::edge, std::min(v, w), std::max(v, w)};
}

SurfaceFeatureId interior_id(const PatchSimplex& s) {
  return {FeatureKind::triangle, s.id, s.id};
}

double cross_of(const Vector2d& p, const Vector2d& q) {
  return p.x() * q.y() - p.y() * q.x();
}

class Overlay {
 public:
  Overlay(int dim, const Vector3d& normal, double least) : dim_(dim), normal_(normal), least_(least) {
    // In 2D the second coordinate is along z, where all points are at 0.
    u_ = dim == 2 ? Vector3d(-normal.y(), normal.x(), 0) : normal.unitOrthogonal();
    v_ = normal.cross(u_);
  }

  std::vector<ManifoldCandidate> run(std::span<const PatchSimplex> of_a, std::span<const PatchSimplex> of_b) {
    const std::vector<Projected> a = projected(of_a, 1), b = projected(of_b, -1);
    double widest = 0;
    for (const Projected& t : b) widest = std::max(widest, t.high - t.low);
    for (const Projected& s : a) {
      auto t = std::lower_bound(b.begin(), b.end(), s.low - widest - margin_of(s.low, widest),
                                [](const Projected& x, double low) { return x.low < low; });
      for (; t != b.end() && t->low <= s.high + margin_of(s.high, widest); ++t)
        if (t->high >= s.low - margin_of(s.low, widest)) add_corners(s, *t);
    }
    return merged();
  }

 private:
  static double margin_of(double x, double y) { return kOverlayRounding * (std::abs(x) + std::abs(y)); }

  /// Projects a patch, sorted by `low`. sign: that of the outward normals along the manifold's normal.
  std::vector<Projected> projected(std::span<const PatchSimplex> patch, double sign) const {
    std::vector<Projected> out;
    for (const PatchSimplex& s : patch) {
      const double facing = sign * s.normal.dot(normal_);
      // Faces on the far side carry no contact.
      if (!s.two_sided && facing < -kSteepest) continue;
      Projected p;
      p.simplex = &s;
      p.is_face = (s.two_sided ? std::abs(facing) : facing) >= kSteepest;
      p.low = std::numeric_limits<double>::infinity();
      p.high = -p.low;
      for (int k = 0; k < dim_; ++k) {
        p.at[k] = {u_.dot(s.x[k]), dim_ == 2 ? 0 : v_.dot(s.x[k])};
        p.height[k] = normal_.dot(s.x[k]);
        p.low = std::min(p.low, p.at[k].x());
        p.high = std::max(p.high, p.at[k].x());
      }
      out.push_back(p);
    }
    std::sort(out.begin(), out.end(), [](const Projected& x, const Projected& y) {
      return x.low != y.low ? x.low < y.low : x.simplex->id < y.simplex->id;
    });
    return out;
  }

  void add_corners(const Projected& a, const Projected& b) {
    if (a.is_face)
      for (int k = 0; k < dim_; ++k) add_vertex(a, b, k, 0);
    if (b.is_face)
      for (int k = 0; k < dim_; ++k) add_vertex(b, a, k, 1);
    if (dim_ == 3 && a.is_face && b.is_face)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) add_edges(a, i, b, j);
  }

  /// Adds corner k of `other` if it is over the simplex `face`, which belongs to A (side 0) or B (1).
  void add_vertex(const Projected& face, const Projected& other, int k, int side) {
    const Vector2d& p = other.at[k];
    double weight[3];
    if (!weigh(face, p, weight)) return;
    const PatchSimplex& s = *face.simplex;
    SurfaceFeatureId on_face = interior_id(s);
    int positive = 0, last = 0, zero = 0;
    for (int i = 0; i < dim_; ++i)
      if (weight[i] > kOverlayRounding)
        ++positive, last = i;
      else
        zero = i;
    if (positive == 1)
      on_face = vertex_id(s, last);
    else if (positive == 2 && dim_ == 3)
      on_face = edge_id(s, (zero + 1) % 3, (zero + 2) % 3);
    // Distance along the normal to the simplex' plane.
    const Vector3d& x = other.simplex->x[k];
    const double ahead =
        positive == 1 ? normal_.dot(s.x[last] - x) : s.normal.dot(s.x[0] - x) / s.normal.dot(normal_);
    ManifoldCandidate c;
    c.depth = side == 0 ? ahead : -ahead;
    if (!(c.depth >= least_)) return;
    c.x[side] = positive == 1 ? s.x[last] : Vector3d(x + ahead * normal_);
    c.x[1 - side] = x;
    c.on[side] = on_face;
    c.on[1 - side] = vertex_id(*other.simplex, k);
    candidates_.push_back(c);
  }

  /// Writes the barycentric weights of a point. Returns false if it is outside the projected simplex.
  bool weigh(const Projected& face, const Vector2d& p, double weight[3]) const {
    if (dim_ == 2) {
      const double length = face.at[1].x() - face.at[0].x();
      weight[1] = (p.x() - face.at[0].x()) / length;
      weight[0] = 1 - weight[1];
    } else {
      const double area = cross_of(face.at[1] - face.at[0], face.at[2] - face.at[0]);
      for (int k = 0; k < 3; ++k)
        weight[k] = cross_of(face.at[(k + 1) % 3] - p, face.at[(k + 2) % 3] - p) / area;
    }
    for (int k = 0; k < dim_; ++k)
      if (!(weight[k] >= -kOverlayRounding)) return false;
    return true;
  }

  void add_edges(const Projected& a, int i, const Projected& b, int j) {
    const int i1 = (i + 1) % 3, j1 = (j + 1) % 3;
    const Vector2d e = a.at[i1] - a.at[i], f = b.at[j1] - b.at[j], between = b.at[j] - a.at[i];
    const double turn = cross_of(e, f);
    if (!(std::abs(turn) > kParallelEdges * e.norm() * f.norm())) return;
    const double s = cross_of(between, f) / turn, t = cross_of(between, e) / turn;
    // Crossings at the end of an edge are vertices on faces.
    const auto is_inner = [](double w) { return w > kOverlayRounding && w < 1 - kOverlayRounding; };
    if (!is_inner(s) || !is_inner(t)) return;
    ManifoldCandidate c;
    c.x[0] = a.simplex->x[i] + s * (a.simplex->x[i1] - a.simplex->x[i]);
    c.x[1] = b.simplex->x[j] + t * (b.simplex->x[j1] - b.simplex->x[j]);
    c.depth = normal_.dot(c.x[0] - c.x[1]);
    if (!(c.depth >= least_)) return;
    c.on[0] = edge_id(*a.simplex, i, i1);
    c.on[1] = edge_id(*b.simplex, j, j1);
    candidates_.push_back(c);
  }

  std::vector<ManifoldCandidate> merged() {
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const ManifoldCandidate& x, const ManifoldCandidate& y) {
                       return std::tie(x.on[0], x.on[1], y.depth) < std::tie(y.on[0], y.on[1], x.depth);
                     });
    const auto same = [](const ManifoldCandidate& x, const ManifoldCandidate& y) {
      return x.on[0] == y.on[0] && x.on[1] == y.on[1];
    };
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end(), same), candidates_.end());
    return std::move(candidates_);
  }

  int dim_;
  Vector3d normal_, u_, v_;
  double least_;
  std::vector<ManifoldCandidate> candidates_;
};

}  // namespace

std::vector<ManifoldCandidate> overlay_corners(std::span<const PatchSimplex> of_a,
                                               std::span<const PatchSimplex> of_b, int dim,
                                               const Vector3d& normal, double least) {
  return Overlay(dim, normal, least).run(of_a, of_b);
}

namespace {

/// Returns the index of the candidate with the highest score, or the number of candidates if none exceeds
/// `least`. Candidates that were chosen before count a little more, so that equivalent ones do not alternate.
template <class Score>
std::size_t best_candidate(const std::vector<ManifoldCandidate>& candidates, double least,
                           const Score& score) {
  std::size_t best = candidates.size();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double value = score(candidates[i]) * (candidates[i].was_chosen ? kChosenBefore : 1);
    if (value > least) {
      least = value;
      best = i;
    }
  }
  return best;
}

/// Returns the indices of the chosen candidates.
std::vector<std::size_t> choose_candidates(const std::vector<ManifoldCandidate>& candidates, int dim,
                                           const Vector3d& normal, double size) {
  std::vector<std::size_t> chosen;
  if (candidates.empty()) return chosen;
  const auto across = [&](const ManifoldCandidate& c) -> Vector3d {
    const Vector3d x = (c.x[0] + c.x[1]) / 2;
    return x - normal.dot(x) * normal;
  };
  const auto add = [&](double least, const auto& score) {
    const std::size_t best = best_candidate(candidates, least, score);
    if (best == candidates.size()) return false;
    chosen.push_back(best);
    return true;
  };
  // The deepest point; among points equally deep up to rounding, the farthest from the mean of all.
  double depth = -std::numeric_limits<double>::infinity();
  Vector3d mean = Vector3d::Zero();
  for (const ManifoldCandidate& c : candidates) {
    depth = std::max(depth, c.depth);
    mean += across(c) / static_cast<double>(candidates.size());
  }
  const double least_depth = depth - kDepthRounding * size;
  if (!add(-1, [&](const ManifoldCandidate& c) {
        return c.depth >= least_depth ? (across(c) - mean).squaredNorm() : -2;
      }))
    return chosen;  // coordinates overflowed
  const Vector3d p = across(candidates[chosen[0]]);
  const double tiny = kSpreadLeast * size;
  // The farthest from it.
  if (!add(tiny * tiny, [&](const ManifoldCandidate& c) { return (across(c) - p).squaredNorm(); }))
    return chosen;
  const Vector3d q = across(candidates[chosen[1]]);
  if (dim == 2) return chosen;
  // The one that spans the largest triangle.
  const double thin = kSpreadLeast * (q - p).squaredNorm();
  const auto area = [&](const Vector3d& x, const Vector3d& y, const Vector3d& z) {
    return normal.dot((y - x).cross(z - x));  // twice the area, signed
  };
  if (!add(thin, [&](const ManifoldCandidate& c) { return std::abs(area(p, q, across(c))); })) return chosen;
  const Vector3d r = across(candidates[chosen[2]]);
  // The one that adds the largest area beyond a side of the triangle.
  const double sign = area(p, q, r) > 0 ? 1 : -1;
  add(thin, [&](const ManifoldCandidate& c) {
    const Vector3d x = across(c);
    return std::max({-sign * area(p, q, x), -sign * area(q, r, x), -sign * area(r, p, x)});
  });
  return chosen;
}

}  // namespace

std::vector<ManifoldCandidate> reduce_candidates(
    std::vector<ManifoldCandidate> candidates, int dim, const Vector3d& normal, double size,
    const std::function<bool(const ManifoldCandidate&)>& is_valid) {
  while (true) {
    const std::vector<std::size_t> chosen = choose_candidates(candidates, dim, normal, size);
    const auto invalid = std::find_if(chosen.begin(), chosen.end(), [&](std::size_t i) {
      candidates[i].is_checked = candidates[i].is_checked || is_valid(candidates[i]);
      return !candidates[i].is_checked;
    });
    if (invalid != chosen.end()) {
      candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(*invalid));
      continue;
    }
    std::vector<ManifoldCandidate> out;
    for (const std::size_t i : chosen) out.push_back(candidates[i]);
    // The first is the deepest already.
    std::stable_sort(out.begin(), out.end(), [](const ManifoldCandidate& x, const ManifoldCandidate& y) {
      return x.depth > y.depth;
    });
    return out;
  }
}

}  // namespace lrb
