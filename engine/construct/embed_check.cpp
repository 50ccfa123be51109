// Exact proof that a cap leaves the front (the current progressive hull) embedded:
// 1. At each ring edge, the cap starts between the patch and the outer neighbour, on the outer side.
// 2. New triangles intersect each other only in shared vertices and edges.
// 3. They intersect the covered patch in the same way only.
// 4. They intersect the rest of the front in the same way only; an AABB tree and plane tests cull the pairs.
// 5. No other component is between patch and cap.
//
// Every decision is an exact predicate. Floating point is used only for conservative culling.

#include "engine/construct/embed_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/point_inside.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::construct {
namespace {

using Box = Eigen::AlignedBox3d;
using Vector3 = Eigen::Vector3d;

FrontMesh::Point point_of(const CapSurface& cap, int v) {
  return {cap.x(v), cap.id(v)};
}

int side(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return exact::orient3d(a.data(), b.data(), c.data(), d.data());
}

}  // namespace

bool turns_outward(const Vector3& a, const Vector3& b, const Vector3& p, const Vector3& w, const Vector3& q) {
  // Measure angles about the edge from the old triangle. Three signs order w and q without computing angles.
  const int new_side = side(a, b, p, w), far_side = side(a, b, p, q);
  // w is at less than 180 degrees. q comes later if it is at 180 or more, or in front of the new triangle.
  if (new_side > 0) return far_side <= 0 || side(a, b, w, q) > 0;
  // w is at 180 degrees, so q must be beyond. (At 0 degrees it overlaps the patch, which the overlap test
  // detects.)
  if (new_side == 0) return far_side < 0;
  // w is at more than 180 degrees: q must be as well, and in front of the new triangle.
  return far_side < 0 && side(a, b, w, q) > 0;
}

CheckedTriangle::CheckedTriangle(const FrontMesh::Point& a, const FrontMesh::Point& b,
                                 const FrontMesh::Point& c)
    : x{a.x.data(), b.x.data(), c.x.data()}, id{a.id, b.id, c.id}, box(a.x) {
  box.extend(b.x);
  box.extend(c.x);
}

bool CheckedTriangle::clear_of(const CheckedTriangle& other) const {
  return !box.intersects(other.box) ||
         exact::meet_only_in_shared(x.data(), id.data(), other.x.data(), other.id.data());
}

TriangleReach::TriangleReach(const CheckedTriangle& t)
    : box_(t.box), corner_(t.x[0][0], t.x[0][1], t.x[0][2]) {
  const Vector3 u = Vector3(t.x[1][0], t.x[1][1], t.x[1][2]) - corner_;
  const Vector3 v = Vector3(t.x[2][0], t.x[2][1], t.x[2][2]) - corner_;
  // The normal is not normalised, which saves a square root: all terms of the plane test scale with it.
  normal_ = u.cross(v);
  // The error of the normal is below 2^-50 |u| |v|; the error of a product with it is below this times the
  // other factor. The slack of 2^-40 far exceeds their sum.
  slack_ = 0x1p-40 * norm3(u) * norm3(v);
}

bool TriangleReach::may_meet(const Box& other) const {
  if (!box_.intersects(other)) return false;
  // Plane against box (Ericson 2005): the radius of the box along the normal, plus the rounding slack.
  const Vector3 half = other.sizes() / 2, from_corner = other.center() - corner_;
  const double reach = dot3(normal_.cwiseAbs(), half) + slack_ * (norm3(half) + norm3(from_corner));
  // Written so that NaN and infinity keep the box.
  return !(std::abs(dot3(normal_, from_corner)) > reach);
}

CapVerdict EmbedCheck::judge_cap(const Patch& patch, const CapSurface& cap) {
  // Step 1 is local and cheap, and rejects most caps that turn inward.
  if (!ring_turns_outward(patch, cap)) return CapVerdict::turns_inward;
  added_.clear();
  obstacles_.clear();
  Box box;
  // The checked triangles refer to these points, which therefore must not be reallocated: reserve first.
  std::vector<FrontMesh::Point> points;
  points.reserve(cap.vertex_count());
  for (int v = 0; v < cap.vertex_count(); ++v) points.push_back(point_of(cap, v));
  for (const auto& f : cap.faces()) {
    // Retained triangles belong to the front already, so they need no test.
    if (!f.alive || f.kept >= 0) continue;
    added_.emplace_back(points[f.v[0]], points[f.v[1]], points[f.v[2]]);
    box.extend(added_.back().box);
  }
  // Step 2. Quadratic, but a cap has at most a few dozen faces.
  if (added_meet_each_other()) return CapVerdict::meets_itself;
  // Steps 3 and 4. The patch comes first in the list, so that the verdict can identify the obstacle.
  add_patch(patch);
  const std::size_t of_patch = obstacles_.size();
  if (component_boxes_.size() > 1)  // another component may be under the cap
    for (const CheckedTriangle& t : obstacles_) box.extend(t.box);
  // For a body of one component, the box of the new triangles suffices.
  gather_front(patch, cap, box);
  const CapVerdict verdict = judge_added(of_patch);
  if (verdict != CapVerdict::accepted || component_boxes_.size() < 2) return verdict;
  // Step 5, only if there are several components.
  return encloses_component(patch, cap, box) ? CapVerdict::encloses_component : CapVerdict::accepted;
}

CapVerdict EmbedCheck::judge_fan(const Patch& patch, const CapSurface& cap, const CapSurface::Star& star,
                                 const FrontMesh::Point& w) {
  if (!rim_turns_outward(cap, star, w.x)) return CapVerdict::turns_inward;
  added_.clear();
  obstacles_.clear();
  Box box;
  // The same steps for a single collapse; the cap's own new faces are obstacles as well. Enclosed components
  // are not searched: judge_cap() does that once, for the finished cap.
  std::vector<FrontMesh::Point> points;
  points.reserve(cap.vertex_count());
  for (int v = 0; v < cap.vertex_count(); ++v) points.push_back(point_of(cap, v));
  // The fan from w over the star's rim.
  for (const auto& r : star.rim) {
    added_.emplace_back(points[r.a], points[r.b], w);
    box.extend(added_.back().box);
  }
  // This includes the star's faces, which the fan is about to cover: it may touch them only in the rim.
  for (const auto& f : cap.faces())
    if (f.alive && f.kept < 0) obstacles_.emplace_back(points[f.v[0]], points[f.v[1]], points[f.v[2]]);
  if (added_meet_each_other()) return CapVerdict::meets_itself;
  add_patch(patch);
  const std::size_t of_patch = obstacles_.size();
  gather_front(patch, cap, box);
  return judge_added(of_patch);
}

void EmbedCheck::add_patch(const Patch& patch) {
  for (const FrontMesh::Slot s : patch.slots) {
    const auto& t = front_[s].v;
    obstacles_.emplace_back(front_.point(t[0]), front_.point(t[1]), front_.point(t[2]));
  }
}

/// Gathers only triangles that the new triangles may intersect: the box of a cap over a large part of a
/// component contains everything nested in it.
void EmbedCheck::gather_front(const Patch& patch, const CapSurface& cap, const Box& box) {
  // Record the region of space that the verdict depends on: later changes outside it cannot invalidate the
  // proof.
  seen_.extend(box);
  reach_.clear();
  for (const CheckedTriangle& t : added_) reach_.emplace_back(t);
  // A box that no new triangle can reach is culled with its entire subtree.
  const auto near = [&](const Box& other) {
    return std::any_of(reach_.begin(), reach_.end(),
                       [&](const TriangleReach& t) { return t.may_meet(other); });
  };
  tree_.for_each_near(box, near, [&](FrontMesh::Slot s) {
    // The tree retains empty slots; the patch's own triangles are in the list already.
    if (!front_.alive(s) || cap.local_face(patch, s) >= 0) return;
    const auto& t = front_[s];
    obstacles_.emplace_back(front_.point(t.v[0]), front_.point(t.v[1]), front_.point(t.v[2]));
  });
}

/// Finds a triangle of each other component that is entirely in the box.
void EmbedCheck::gather_strangers(const Patch& patch, const Box& box) {
  strangers_.clear();
  ++stamp_;
  met_.resize(front_.component_count(), 0);
  const std::uint32_t own = front_[patch.slots[0]].component;
  tree_.for_each_in(box, [&](FrontMesh::Slot s) {
    if (!front_.alive(s)) return;
    const std::uint32_t component = front_[s].component;
    // One triangle per component suffices: it represents the entire component.
    if (component == own || met_[component] == stamp_) return;
    met_[component] = stamp_;
    // Only a component that is entirely within the box can be enclosed without crossing the boundary.
    if (box.contains(component_boxes_[component])) strangers_.push_back(s);
  });
}

bool EmbedCheck::added_meet_each_other() const {
  for (std::size_t i = 0; i < added_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!added_[i].clear_of(added_[j])) return true;
  return false;
}

/// Tests the new triangles against the obstacles; the first `of_patch` are the cap's own and the patch's.
CapVerdict EmbedCheck::judge_added(std::size_t of_patch) const {
  for (const CheckedTriangle& t : added_)
    for (std::size_t i = 0; i < obstacles_.size(); ++i)
      if (!t.clear_of(obstacles_[i])) return i < of_patch ? CapVerdict::meets_patch : CapVerdict::meets_front;
  return CapVerdict::accepted;
}

/// If one neighbour is outside, so is the patch's entire component, which is connected and intersects the
/// region's boundary only in the ring.
bool EmbedCheck::ring_turns_outward(const Patch& patch, const CapSurface& cap) const {
  const int size = cap.ring_size();
  for (int k = 0; k < size; ++k) {
    const auto& face = cap.faces()[cap.face_at_ring(k)];
    // Nothing changes at this ring edge.
    if (face.kept >= 0) continue;
    const FrontMesh::Corner a = patch.ring[k], b = patch.ring[(k + 1) % size];
    // In the outer triangle the ring edge runs from b to a.
    const auto third = [&](const auto& t, auto first) {
      return t.v[0] == first ? t.v[2] : t.v[1] == first ? t.v[0] : t.v[1];
    };
    const FrontMesh::Slot beyond = patch.outside[k];
    // The patch's own triangle at the edge.
    const auto& old = front_[front_[beyond].across[front_.index_of(beyond, b)]];
    if (!turns_outward(front_.x(a), front_.x(b), front_.x(third(old, a)), cap.x(third(face, k)),
                       cap.tip_beyond(k)))
      return false;
  }
  return true;
}

bool EmbedCheck::rim_turns_outward(const CapSurface& cap, const CapSurface::Star& star,
                                   const Vector3& w) const {
  const auto third = [&](int f, int a, int b) {
    const auto& v = cap.faces()[f].v;
    return v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2];
  };
  for (const auto& r : star.rim) {
    // The vertex opposite the rim edge: beyond the ring it belongs to the front, otherwise to the cap.
    const Vector3& tip = r.across < 0 ? cap.tip_beyond(-1 - r.across) : cap.x(third(r.across, r.a, r.b));
    if (!turns_outward(cap.x(r.a), cap.x(r.b), cap.x(third(r.face, r.a, r.b)), w, tip)) return false;
  }
  return true;
}

/// Returns true if another component may be in the region between patch and cap. If so, it is entirely
/// inside.
bool EmbedCheck::encloses_component(const Patch& patch, const CapSurface& cap, const Box& box) {
  // Step 1: the candidates; usually there are no candidates.
  gather_strangers(patch, box);
  Mesh region;
  for (const FrontMesh::Slot stranger : strangers_) {
    // Step 2, once: the boundary of the region, that is cap and patch. Its orientation does not affect the
    // parity of ray crossings, and triangles in both cancel.
    if (region.vertices.empty()) {
      for (int v = 0; v < cap.vertex_count(); ++v) region.vertices.push_back(cap.x(v));
      for (const auto& f : cap.faces()) {
        if (!f.alive) continue;
        VertexId corners[3];
        for (int i = 0; i < 3; ++i) corners[i] = VertexId(static_cast<std::uint32_t>(f.v[i]));
        region.add_face(corners);
      }
      // The patch is indexed separately: point location needs no connectivity.
      for (const FrontMesh::Slot s : patch.slots) {
        VertexId corners[3];
        for (int i = 0; i < 3; ++i) {
          corners[i] = static_cast<VertexId>(region.vertices.size());
          region.vertices.push_back(front_.x(front_[s].v[i]));
        }
        region.add_face(corners);
      }
    }
    std::vector<FaceId> faces(region.face_count());
    for (FaceId f = 0; f < faces.size(); ++f) faces[f] = f;
    // Step 3: the component does not cross the boundary, so one vertex that is not on the boundary decides.
    bool decided = false;
    for (const FrontMesh::Corner c : front_[stranger].v) {
      const PointSide where = point_side(region, faces, front_.x(c));
      if (where == PointSide::on_surface) continue;
      if (where == PointSide::inside) return true;
      decided = true;
      break;
    }
    // All three vertices are on the boundary: assume that it is inside.
    if (!decided) return true;
  }
  return false;
}

}  // namespace lrb::construct
