// Simplifies a patch into its cap by edge collapses that only move the surface outward (progressive hulls:
// Sander, Gu, Gortler, Hoppe and Snyder 2000).
// 1. Propose a collapse for every edge with an interior end: to a new vertex, or onto its other end if that
//    is on the ring, the boundary loop of the patch.
// 2. Pop the cheapest one from a priority queue; evaluate it again if its star has changed, and put it back
//    if its cost has risen.
// 3. Collapse the edge, and propose the edges around the new vertex. Repeat until no collapse is accepted.
//
// Three functions reject collapses: find_star() if the result would not be a surface; measure_star() by the
// position of the vertex, the added volume or the shape of triangles; confirm() by an exact test. Rejections,
// except those by EmbedCheck, are recorded in the surface and remain valid until the star or its neighbours
// change.

#include "engine/construct/patch_cap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/plane_side.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

}  // namespace

void PatchCap::simplify(const Patch& patch, const Limits& limits) {
  patch_ = &patch;
  limits_ = limits;
  cap_.forget_rejected();
  // A collapse that is rejected now may be accepted after others: repeat until nothing changes.
  for (std::uint32_t before = cap_.version() + 1; before != cap_.version();) {
    before = cap_.version();
    propose_all();
    // Lazy deletion: candidates that became stale are detected when they are popped.
    while (!queue_.empty() && cap_.alive_faces() > limits_.faces) {
      std::pop_heap(queue_.begin(), queue_.end());
      const Candidate c = queue_.back();
      queue_.pop_back();
      if (!cap_.is_used(c.u) || !cap_.is_used(c.v)) continue;
      const auto now = evaluate_again(c);
      if (!now) continue;
      // Its cost has risen: put it back, because others may be cheaper now.
      if (now->cost > c.cost) {
        queue_.push_back(*now);
        std::push_heap(queue_.begin(), queue_.end());
        continue;
      }
      if (confirm(*now) == CapVerdict::accepted)
        collapse(*now);
      else if (!limits_.check)  // its verdict may change with distant collapses
        cap_.reject(star_);
    }
  }
}

/// Collapses the edge whose star is in star_, and proposes collapses that may have become possible.
void PatchCap::collapse(const Candidate& c) {
  const bool onto_ring = cap_.is_ring(c.v);
  int w = c.v;
  if (onto_ring)
    cap_.collapse_onto_ring(star_);
  else
    w = cap_.collapse_to_new(star_, c.w);
  if (!onto_ring) return propose_around(w);
  rim_ = star_.rim;
  for (const auto& r : rim_)
    if (!cap_.is_ring(r.a)) propose(r.a, w);
}

void PatchCap::propose_all() {
  queue_.clear();
  // Each edge once; edges between two ring vertices never collapse.
  for (int u = cap_.ring_size(); u < cap_.vertex_count(); ++u) {
    if (!cap_.is_used(u)) continue;
    cap_.for_each_neighbour(u, [&](int v) {
      if (cap_.is_ring(v) || u < v) propose(u, v);
    });
  }
}

void PatchCap::propose_around(int w) {
  cap_.for_each_neighbour(w, [&](int v) {
    if (cap_.is_ring(v))
      propose(w, v);
    else
      propose(v, w);
  });
}

void PatchCap::propose(int u, int v) {
  if (const auto c = evaluate(u, v)) {
    queue_.push_back(*c);
    std::push_heap(queue_.begin(), queue_.end());
  }
}

/// Evaluates the collapse of an edge; leaves the edge's star in star_.
std::optional<PatchCap::Candidate> PatchCap::evaluate(int u, int v) {
  // Cheap rejection of about four in five edges, before the star is gathered.
  if (cap_.is_ring(v) && cap_.is_behind_a_face_at(u, v)) return std::nullopt;
  if (!cap_.find_star(u, v, star_) || cap_.was_rejected(star_)) return std::nullopt;
  return evaluate_star(u, v);
}

/// Returns the candidate's current state, or nullopt if it is rejected; leaves the edge's star in star_.
std::optional<PatchCap::Candidate> PatchCap::evaluate_again(const Candidate& c) {
  if (!cap_.find_star(c.u, c.v, star_) || cap_.was_rejected(star_)) return std::nullopt;
  return c.version < star_.since ? evaluate_star(c.u, c.v) : c;
}

/// Evaluates the collapse of the edge whose star is in star_, and records a rejection. The result depends
/// only on the star and the triangles across its rim, so a rejection remains valid until one of these
/// changes.
std::optional<PatchCap::Candidate> PatchCap::evaluate_star(int u, int v) {
  auto c = measure_star(u, v);
  if (!c) cap_.reject(star_);
  return c;
}

/// As evaluate_star(), but does not record a rejection; its reason is in why_.
std::optional<PatchCap::Candidate> PatchCap::measure_star(int u, int v) {
  // Step 1: centre and radius of the rim set the scale of all tolerances.
  Vector3 centre = Vector3::Zero();
  for (const auto& r : star_.rim) centre += cap_.x(r.a);
  centre /= static_cast<double>(star_.rim.size());
  double radius_sq = 0;
  for (const auto& r : star_.rim) radius_sq = std::max(radius_sq, squared_norm3(cap_.x(r.a) - centre));
  const double radius = std::sqrt(radius_sq);
  // Step 2: the position of the fan's centre: the ring vertex, or a new vertex.
  Candidate c{0, u, v, cap_.version(), {}};
  if (cap_.is_ring(v)) {
    if (!ring_vertex_is_in_front(v, radius)) return reject(CapVerdict::no_place);
    c.w = cap_.x(v);
  } else {
    const auto w = place(radius, centre);
    if (!w) return reject(CapVerdict::no_place);
    c.w = *w;
  }
  // Step 3: the added volume, as pyramids from w over the star's triangles; then a penalty for needles.
  double volume = 0, area = 0;
  for (const int f : star_.faces) {
    const auto& plane = cap_.faces()[f].plane;
    volume += (dot3(plane.n, c.w) - plane.d) * plane.area;
    area += plane.area;
  }
  c.cost = volume / 3;
  if (c.cost > limits_.volume) return reject(CapVerdict::too_much_volume);
  c.cost += kCapShapeWeight * area * std::sqrt(area) / shape_of_fan(c.w);
  if (!(c.cost <= limits_.volume)) return reject(CapVerdict::too_thin);
  return c;
}

/// Returns the position of the new vertex, or nullopt if no position is feasible. Projects a target,
/// limits_.depth radii below the star's centre, onto the intersection of the half-spaces in front of the
/// planes, so that the vertex is as low as possible and above the centre. (The lowest vertex by a linear
/// program drifts sideways where the star is flat.)
std::optional<Vector3> PatchCap::place(double radius, const Vector3& centre) {
  // The margin keeps the floating-point position strictly in front, so that the exact confirmation succeeds.
  const double margin = kPlacementMargin * radius, slack = kPlacementSlack * radius;
  Vector3 outward = Vector3::Zero();
  for (const int f : star_.faces) outward += cap_.faces()[f].plane.n * cap_.faces()[f].plane.area;
  const double length = norm3(outward);
  if (!(length > 0)) return std::nullopt;
  collect_half_spaces(centre, margin);
  const Vector3 target = outward * (-limits_.depth * radius / length);
  const auto nearest = [&] { return nearest_point(target, half_spaces_, slack); };
  auto w = nearest();
  if (!w) return std::nullopt;
  const double reach = 2 * radius;
  // The bounds are rarely active: add them only if the position violates them.
  if (w->cwiseAbs().maxCoeff() > reach || !bounds_.contains(*w + centre)) {
    for (int i = 0; i < 3; ++i)
      for (const double sign : {-1.0, 1.0}) half_spaces_.push_back({sign * Vector3::Unit(i), -reach});
    for (const HalfSpace& h : bounds_.half_spaces()) half_spaces_.push_back({h.n, h.d - dot3(h.n, centre)});
    w = nearest();
    if (!w) return std::nullopt;
  }
  return Vector3(*w + centre);
}

/// Collects the half-spaces in front of the star's planes and, where the surface is concave at the rim, in
/// front of the neighbours' planes.
void PatchCap::collect_half_spaces(const Vector3& centre, double margin) {
  half_spaces_.clear();
  // In front of the star itself.
  for (const int f : star_.faces) {
    const auto& p = cap_.faces()[f].plane;
    half_spaces_.push_back({p.n, p.d - dot3(p.n, centre) + margin});
  }
  for (const auto& r : star_.rim) {
    const auto& own = cap_.faces()[r.face].plane;
    // In front of the neighbour at a reflex rim edge, where the fan could intersect it.
    if (r.across < 0) {
      const auto& p = cap_.plane_beyond(-1 - r.across);
      if (dot3(own.n, cap_.tip_beyond(-1 - r.across)) > own.d)
        half_spaces_.push_back({p.n, p.d - dot3(p.n, centre) + margin});
      continue;
    }
    const auto& other = cap_.faces()[r.across];
    const int tip = other.v[0] != r.a && other.v[0] != r.b   ? other.v[0]
                    : other.v[1] != r.a && other.v[1] != r.b ? other.v[1]
                                                             : other.v[2];
    if (dot3(own.n, cap_.x(tip)) > own.d)
      half_spaces_.push_back({other.plane.n, other.plane.d - dot3(other.plane.n, centre) + margin});
  }
}

bool PatchCap::ring_vertex_is_in_front(int r, double radius) const {
  const Vector3& x = cap_.x(r);
  // Triangles with the corner r are removed: no condition.
  for (const int f : star_.faces) {
    const auto& face = cap_.faces()[f];
    if (face.v[0] == r || face.v[1] == r || face.v[2] == r) continue;
    if (dot3(face.plane.n, x) - face.plane.d < kPlacementMargin * radius) return false;
  }
  return true;
}

/// Returns the shape of the worst triangle between w and the rim: 1 for an equilateral, 0 for a degenerate
/// one.
double PatchCap::shape_of_fan(const Vector3& w) const {
  double worst = std::numeric_limits<double>::infinity();
  // Quality: area over the sum of squared edges, scaled so that an equilateral triangle has 1.
  for (const auto& r : star_.rim) {
    const Vector3 a = cap_.x(r.a) - w, b = cap_.x(r.b) - w;
    const double twice_area = norm3(a.cross(b));
    worst = std::min(worst, twice_area / (squared_norm3(a) + squared_norm3(b) + squared_norm3(a - b)));
  }
  return worst * (2 * std::sqrt(3.0));
}

/// Returns CapVerdict::accepted if the collapse is accepted, otherwise the reason of the rejection.
CapVerdict PatchCap::confirm(const Candidate& c) const {
  for (const int f : star_.faces) {
    const auto& v = cap_.faces()[f].v;
    if (v[0] == c.v && cap_.is_ring(c.v)) continue;
    if ((v[1] == c.v || v[2] == c.v) && cap_.is_ring(c.v)) continue;
    // Exact: the vertex must be strictly in front of every triangle that the fan covers.
    if (exact::PlaneSide(cap_.x(v[0]).data(), cap_.x(v[1]).data(), cap_.x(v[2]).data()).side(c.w.data()) <= 0)
      return CapVerdict::no_place;
  }
  if (!limits_.check) return CapVerdict::accepted;
  return limits_.check->judge_fan(*patch_, cap_, star_, {c.w, cap_.is_ring(c.v) ? cap_.id(c.v) : kNull});
}

CapVerdict PatchCap::verdict_on_edge(int u, int v) {
  if (cap_.is_ring(v) && cap_.is_behind_a_face_at(u, v)) return CapVerdict::no_place;
  if (!cap_.find_star(u, v, star_)) return CapVerdict::no_surface;
  const auto candidate = measure_star(u, v);
  return candidate ? confirm(*candidate) : why_;
}

CapVerdict PatchCap::what_holds_back() {
  // Count the verdicts of all remaining edges. Return the most frequent one of the limits or, if there is
  // none, of the geometric reasons.
  std::array<std::uint32_t, kEnumNames<CapVerdict>.size()> edges{};
  for (int u = cap_.ring_size(); u < cap_.vertex_count(); ++u) {
    if (!cap_.is_used(u)) continue;
    cap_.for_each_neighbour(u, [&](int v) {
      if (cap_.is_ring(v) || u < v) ++edges[static_cast<std::size_t>(verdict_on_edge(u, v))];
    });
  }
  const auto most = [&](std::initializer_list<CapVerdict> of) {
    CapVerdict best = CapVerdict::accepted;
    std::uint32_t count = 0;
    for (const CapVerdict v : of)
      if (edges[static_cast<std::size_t>(v)] > count) best = v, count = edges[static_cast<std::size_t>(v)];
    return best;
  };
  using enum CapVerdict;
  const CapVerdict limit =
      most({too_thick, too_much_volume, too_thin, meets_front, meets_patch, meets_itself, turns_inward});
  if (limit != accepted) return limit;
  const CapVerdict geometry = most({no_place, no_surface});
  return geometry != accepted ? geometry : too_many_faces;
}

}  // namespace lrb::construct
