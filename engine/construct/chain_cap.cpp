// Caps over chains of segments in 2D.
// - find_cap(): the chord if the chain is behind it, otherwise two segments with an apex in front of all
//   lines of the chain.
// - measure_cap(): samples the deviation, for fitting.
// - judge_chain_cap(): exact proof that the front stays embedded, as in embed_check.cpp.

#include "engine/construct/chain_cap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::construct {
namespace {

using Slot = FrontLoops::Slot;
using Vector3 = Eigen::Vector3d;

int turn(const Vector3& a, const Vector3& b, const Vector3& c) {
  return exact::orient2d(a.data(), b.data(), c.data());
}

/// Returns the half-plane in front (to the right) of the line through a segment by `margin`; relative to
/// `origin`.
HalfSpace in_front(const Vector3& a, const Vector3& b, const Vector3& origin, double margin) {
  // The solid is to the left of a -> b, so the outer normal points to the right.
  const Vector3 n = normalized3(Vector3(b.y() - a.y(), a.x() - b.x(), 0));
  return {n, dot3(n, a - origin) + margin};
}

/// Returns true if p is strictly inside the sector between the rays from `centre` through `from` and,
/// counter-clockwise, through `to`.
bool in_sector(const Vector3& centre, const Vector3& from, const Vector3& to, const Vector3& p) {
  // Convex sector: inside both half-planes. Reflex sector: outside the closed complement. Exact in all cases.
  const int sector = turn(centre, from, to);
  if (sector > 0) return turn(centre, from, p) > 0 && turn(centre, p, to) > 0;
  if (sector < 0) return !(turn(centre, to, p) >= 0 && turn(centre, p, from) >= 0);
  return turn(centre, from, p) > 0;  // a straight angle
}

struct CheckedSegment {
  const Vector3 *a, *b;
  VertexId ia, ib;
  Eigen::AlignedBox3d box;
  CheckedSegment(const Vector3& pa, VertexId va, const Vector3& pb, VertexId vb)
      : a(&pa), b(&pb), ia(va), ib(vb), box(pa) {
    box.extend(pb);
  }
  bool clear_of(const CheckedSegment& o) const {
    // Disjoint boxes are exact proof as well: coordinates are compared without rounding.
    if (!box.intersects(o.box)) return true;
    const double *pa[2] = {a->data(), b->data()}, *pb[2] = {o.a->data(), o.b->data()};
    const VertexId va[2] = {ia, ib}, vb[2] = {o.ia, o.ib};
    return exact::meet_only_in_shared_2d(pa, va, pb, vb);
  }
};

CheckedSegment checked(const FrontLoops& front, Slot s) {
  return {front.start(s), front[s].a, front.end(s), front[s].b};
}

bool region_holds(const FrontLoops& front, const std::vector<Slot>& chain,
                  const std::vector<CheckedSegment>& cap, const Vector3& p) {
  // Parity of the crossings of an exact ray with the region's boundary, that is chain and cap.
  bool inside = false;
  const auto cast = [&](const Vector3& a, const Vector3& b) {
    const double* segment[2] = {a.data(), b.data()};
    inside ^= exact::ray_crosses_2d(p.data(), segment) == exact::RayHit::crosses;
  };
  for (const Slot s : chain) cast(front.start(s), front.end(s));
  for (const CheckedSegment& s : cap) cast(*s.a, *s.b);
  return inside;
}

/// Returns the deviation of q according to the chain's segments.
double off_by_chain(const FrontLoops& front, const std::vector<Slot>& chain, const Vector3& q) {
  // The triangle inequality bounds the deviation of q via any point of the chain: take the least bound.
  double least = std::numeric_limits<double>::infinity();
  for (const Slot s : chain) {
    // Deviation at the foot: interpolated between the ends, plus the segment's own excess.
    const SimplexPoint near = nearest_on_segment(q, front.start(s), front.end(s));
    least = std::min(least, std::sqrt(near.distance_sq) + near.weight[0] * front.deviation(front[s].a) +
                                near.weight[1] * front.deviation(front[s].b) + front[s].excess_deviation);
  }
  return least;
}

/// Measures the excess deviation of a segment over a chain at sample points; the deviation of its ends is
/// known. Returns false if a point deviates by more than `most`.
bool excess_of_segment(const FrontLoops& front, const std::vector<Slot>& chain, const Vector3& a,
                       double off_a, const Vector3& b, double off_b, double most, double& excess_deviation) {
  // Seven sample points. The maximum between samples is not bounded: this estimate only guides the builder.
  constexpr int kParts = 8;
  excess_deviation = 0;
  for (int i = 1; i < kParts; ++i) {
    const double t = static_cast<double>(i) / kParts;
    const double deviation = off_by_chain(front, chain, a + t * (b - a));
    // Written so that NaN is rejected.
    if (!(deviation <= most)) return false;
    // Store only the excess over linear interpolation, because the ends have their own deviations.
    excess_deviation = std::max(excess_deviation, deviation - (1 - t) * off_a - t * off_b);
  }
  return true;
}

std::optional<Vector3> find_apex(const FrontLoops& front, const std::vector<Slot>& chain,
                                 std::span<const HalfSpace> bounds, double radius) {
  const Vector3 &a = front.start(chain.front()), &b = front.end(chain.back());
  // Coordinates relative to the chord's midpoint, halved first to avoid overflow.
  const Vector3 centre = a / 2 + b / 2;
  std::vector<HalfSpace> half_spaces;
  // In front of every line: the triangles from the apex to the segments then all have the same orientation.
  for (const Slot s : chain)
    half_spaces.push_back(in_front(front.start(s), front.end(s), centre, kPlacementMargin * radius));
  // If the outline is concave at an end, the neighbour rises in front of the chain: stay in front of its line
  // as well, so that the new segment does not intersect it.
  const Slot before = front[chain.front()].prev, after = front[chain.back()].next;
  if (turn(front.start(before), a, front.end(chain.front())) < 0)
    half_spaces.push_back(in_front(front.start(before), a, centre, kPlacementMargin * radius));
  if (turn(front.start(chain.back()), b, front.end(after)) < 0)
    half_spaces.push_back(in_front(b, front.end(after), centre, kPlacementMargin * radius));
  // Within the planned wrapper.
  for (const HalfSpace& h : bounds) half_spaces.push_back({h.n, h.d - dot3(h.n, centre)});
  // Project a point behind the chord: the apex is above the midpoint and as low as possible.
  const Vector3 inward = normalized3(Vector3(a.y() - b.y(), b.x() - a.x(), 0));
  auto apex = nearest_point(inward * radius, half_spaces, kPlacementSlack * radius);
  if (!apex) return std::nullopt;
  *apex += centre;
  // The 3D solver may leave a rounding error in z.
  apex->z() = 0;
  return apex;
}

}  // namespace

std::vector<Slot> chain_of(const FrontLoops& front, Slot first, std::uint32_t length) {
  std::vector<Slot> chain;
  for (Slot s = first; chain.size() < length; s = front[s].next) chain.push_back(s);
  return chain;
}

std::optional<ChainCap> find_cap(const FrontLoops& front, Slot first, std::uint32_t length,
                                 std::span<const HalfSpace> bounds, double area_limit, CapVerdict& why) {
  const std::vector<Slot> chain = chain_of(front, first, length);
  const Vector3 &a = front.start(chain.front()), &b = front.end(chain.back());
  ChainCap cap{first, length, std::nullopt, 0, 0, {0, 0}};
  // One loop: the chain's length, whether the chord is valid, and the area by the shoelace formula.
  double size = 0;
  bool chord = true;
  for (const Slot s : chain) {
    size += norm3(front.end(s) - front.start(s));
    // Strictly behind the chord; a vertex on it would touch.
    if (s != chain.front()) chord = chord && turn(a, b, front.start(s)) > 0;
    cap.area -= cross_2d(front.start(s) - a, front.end(s) - a) / 2;
  }
  // The chord is not valid: find an apex.
  if (!chord) {
    why = CapVerdict::no_place;
    cap.apex = find_apex(front, chain, bounds, size / 2);
    if (!cap.apex) return std::nullopt;
    for (const Slot s : chain)
      // The placement was in floating point. Confirm exactly.
      if (turn(front.start(s), front.end(s), *cap.apex) >= 0) return std::nullopt;
    // Add the triangle between chord and apex.
    cap.area += cross_2d(*cap.apex - a, b - a) / 2;
  }
  why = CapVerdict::too_much_volume;
  // Relative to the squared length, so that the limit is independent of scale.
  if (!(cap.area <= area_limit * size * size)) return std::nullopt;
  return cap;
}

bool measure_cap(const FrontLoops& front, ChainCap& cap, double most) {
  const std::vector<Slot> chain = chain_of(front, cap.first, cap.length);
  const VertexId first = front[chain.front()].a, last = front[chain.back()].b;
  // The chord: one segment between two vertices of known deviation.
  if (!cap.apex)
    return excess_of_segment(front, chain, front.x(first), front.deviation(first), front.x(last),
                             front.deviation(last), most, cap.excess_deviation[0]);
  // The apex first, because its deviation is used for both segments.
  cap.apex_off = off_by_chain(front, chain, *cap.apex);
  return cap.apex_off <= most &&
         excess_of_segment(front, chain, front.x(first), front.deviation(first), *cap.apex, cap.apex_off,
                           most, cap.excess_deviation[0]) &&
         excess_of_segment(front, chain, *cap.apex, cap.apex_off, front.x(last), front.deviation(last), most,
                           cap.excess_deviation[1]);
}

double off_of(const FrontLoops& front, const ChainCap& cap) {
  const std::vector<Slot> chain = chain_of(front, cap.first, cap.length);
  // On each segment: the larger deviation of its ends, plus its excess.
  const double first = front.deviation(front[chain.front()].a), last = front.deviation(front[chain.back()].b);
  if (!cap.apex) return std::max(first, last) + cap.excess_deviation[0];
  return std::max(std::max(first, cap.apex_off) + cap.excess_deviation[0],
                  std::max(cap.apex_off, last) + cap.excess_deviation[1]);
}

CapVerdict judge_chain_cap(const FrontLoops& front, const AabbTree& tree, const ChainCap& cap,
                           std::span<const Eigen::AlignedBox3d> boxes) {
  const std::vector<Slot> chain = chain_of(front, cap.first, cap.length);
  const Slot first = chain.front(), last = chain.back();
  const Vector3 &a = front.start(first), &b = front.end(last);
  // Step 1: the new segments. The apex has no id yet, so it is not shared.
  std::vector<CheckedSegment> added;
  if (cap.apex) {
    added.emplace_back(a, front[first].a, *cap.apex, kNull);
    added.emplace_back(*cap.apex, kNull, b, front[last].b);
    // Both end at the apex: they overlap only if the cap is folded.
    if (!added[0].clear_of(added[1])) return CapVerdict::meets_itself;
  } else {
    added.emplace_back(a, front[first].a, b, front[last].b);
  }
  // Step 2: at both ends, the cap must start between the neighbour and the chain, on the outer side: in the
  // sector from the incoming segment to the outgoing one.
  if (!in_sector(a, front.start(front[first].prev), front.end(first), *added.front().b) ||
      !in_sector(b, front.start(last), front.end(front[last].next), *added.back().a))
    return CapVerdict::turns_inward;
  // Step 3: all segments in the box of chain and cap, found by the tree.
  Eigen::AlignedBox3d box = added.front().box;
  box.extend(added.back().box);
  for (const Slot s : chain) box.extend(box_of(front, s));  // another component may be in between
  CapVerdict verdict = CapVerdict::accepted;
  tree.for_each_in(box, [&](Slot s) {
    if (verdict != CapVerdict::accepted || !front.alive(s)) return;
    const CheckedSegment other = checked(front, s);
    // The chain itself is included: the cap may intersect it only in its two end points.
    for (const CheckedSegment& t : added)
      if (!t.clear_of(other)) verdict = CapVerdict::meets_front;
    const std::uint32_t component = front[s].component;
    // Step 4: a component that is entirely within the box and does not intersect the cap may be enclosed. One
    // vertex decides.
    if (verdict == CapVerdict::accepted && component != front[first].component &&
        box.contains(boxes[component]) && region_holds(front, chain, added, front.start(s)))
      verdict = CapVerdict::encloses_component;
  });
  return verdict;
}

FrontLoops::FrontLoops(const Mesh& mesh) : points_(mesh.vertices), deviation_(mesh.vertices.size(), 0) {
  // Every vertex has exactly one outgoing segment, which follows the incoming one.
  std::vector<Slot> leaving(points_.size(), kNull);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto c = mesh.face(f);
    segments_.push_back({c[0], c[1], kNull, kNull, f, kNull});
    leaving[c[0]] = f;
  }
  alive_ = slot_count();
  for (Slot s = 0; s < slot_count(); ++s) join(s, leaving[segments_[s].b]);
  // Each closed loop is one component.
  for (Slot first = 0; first < slot_count(); ++first) {
    if (segments_[first].component != kNull) continue;
    for (Slot s = first; segments_[s].component == kNull; s = segments_[s].next)
      segments_[s].component = components_;
    ++components_;
  }
}

std::vector<FrontLoops::Slot> FrontLoops::alive_slots() const {
  std::vector<Slot> slots;
  for (Slot s = 0; s < slot_count(); ++s)
    if (alive(s)) slots.push_back(s);
  return slots;
}

VertexId FrontLoops::add_point(const Eigen::Vector3d& x, double deviation) {
  points_.push_back(x);
  deviation_.push_back(deviation);
  return static_cast<VertexId>(points_.size() - 1);
}

void FrontLoops::remove(std::span<const Slot> slots) {
  for (const Slot s : slots) segments_[s].face = kNull;
  alive_ -= static_cast<std::uint32_t>(slots.size());
}

void FrontLoops::place(Slot s, VertexId a, VertexId b, FaceId face, std::uint32_t component) {
  if (s == slot_count()) segments_.emplace_back();
  segments_[s] = {a, b, kNull, kNull, face, component};
  ++alive_;
}

}  // namespace lrb::construct
