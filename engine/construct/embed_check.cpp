// LidProof: the proof that a lid leaves the committed front embedded:
// 1. At each rim edge, the lid starts between the floor and the outer neighbour, on the outer side.
// 2. Faces of the lid intersect each other only in shared vertices and edges.
// 3. They intersect the floor, and the rest of the committed front, in the same way only.
// 4. No other component of the body is between floor and lid.
//
// Every decision is an exact predicate. Floating point is used only for conservative culling.

#include "engine/construct/embed_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/construct/front_update.hpp"
#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/nesting.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::construct {

namespace {

using Box = Eigen::AlignedBox3d;
using Vector3 = Eigen::Vector3d;

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

void LidProof::Boxes::clear() {
  for (auto& side : sides_) side.clear();
}

void LidProof::Boxes::add(const Eigen::AlignedBox3d& b, double unit) {
  // A float is within 2^-24 of the double, relative to it, unless that is subnormal.
  constexpr float kRelative = 0x1p-22f, kTiny = 1e-37f;
  for (int i = 0; i < 3; ++i) {
    const auto low = static_cast<float>(b.min()[i] / unit), high = static_cast<float>(b.max()[i] / unit);
    sides_[i].push_back(low - (std::abs(low) * kRelative + kTiny));
    sides_[3 + i].push_back(high + (std::abs(high) * kRelative + kTiny));
  }
}

const std::vector<std::uint32_t>& LidProof::Boxes::meeting(const Boxes& other, std::uint32_t k,
                                                           std::uint32_t last) {
  flags_.resize(last);
  float low[3], high[3];
  for (int i = 0; i < 3; ++i) low[i] = other.sides_[i][k], high[i] = other.sides_[3 + i][k];
  // One loop without branches, which compilers turn into vector instructions. Written so that a box with
  // infinite ends is kept.
  const float *a = sides_[0].data(), *b = sides_[1].data(), *c = sides_[2].data();
  const float *d = sides_[3].data(), *e = sides_[4].data(), *f = sides_[5].data();
  std::uint32_t* flags = flags_.data();
  for (std::uint32_t i = 0; i < last; ++i)
    flags[i] = static_cast<std::uint32_t>(a[i] <= high[0]) & static_cast<std::uint32_t>(b[i] <= high[1]) &
               static_cast<std::uint32_t>(c[i] <= high[2]) & static_cast<std::uint32_t>(d[i] >= low[0]) &
               static_cast<std::uint32_t>(e[i] >= low[1]) & static_cast<std::uint32_t>(f[i] >= low[2]);
  found_.clear();
  for (std::uint32_t i = 0; i < last; ++i)
    if (flags[i] != 0) found_.push_back(i);
  return found_;
}

LidProof::Corners LidProof::corners_of(Index f) const {
  const auto& v = open_[f].v;
  return {{open_.x(v[0]).data(), open_.x(v[1]).data(), open_.x(v[2]).data()},
          {open_.id(v[0]), open_.id(v[1]), open_.id(v[2])}};
}

LidProof::Corners LidProof::corners_of_slot(FrontMesh::Slot s) const {
  const auto& v = front_[s].v;
  return {{front_.x(v[0]).data(), front_.x(v[1]).data(), front_.x(v[2]).data()},
          {front_.point(v[0]).id, front_.point(v[1]).id, front_.point(v[2]).id}};
}

/// Returns true if all corners of g that it does not share with f are certainly on one side of f's plane: the
/// two then intersect in shared corners and edges at most.
bool LidProof::parts(const exact::PlaneSide& plane, const Corners& f, const Corners& g) {
  int side = 0;
  for (int i = 0; i < 3; ++i) {
    if (g.id[i] == f.id[0] || g.id[i] == f.id[1] || g.id[i] == f.id[2]) continue;
    const int s = plane.side(g.x[i]);
    if (s == 0 || s == -side) return false;
    side = s;
  }
  return side != 0;
}

bool LidProof::clear(const Corners& f, const Corners& g) {
  return exact::meet_only_in_shared(f.x, f.id, g.x, g.id);
}

CapVerdict LidProof::judge(const OpenFront::Lid& lid, const AabbTree& tree) {
  if (!rim_turns_outward(lid)) return CapVerdict::turns_inward;
  lid_.clear(), planes_.clear(), lid_boxes_.clear();
  Eigen::AlignedBox3d box;
  for (const Index f : lid.faces) {
    const Corners c = corners_of(f);
    lid_.push_back(c);
    planes_.emplace_back(c.x[0], c.x[1], c.x[2]);
    lid_boxes_.add(open_.box(f), open_.unit());
    box.extend(open_.box(f));
  }
  // Step 2. The plane of one of the two separates most pairs.
  for (std::uint32_t k = 1; k < lid_.size(); ++k)
    for (const std::uint32_t j : lid_boxes_.meeting(lid_boxes_, k, k))
      if (!parts(planes_[k], lid_[k], lid_[j]) && !parts(planes_[j], lid_[j], lid_[k]) &&
          !clear(lid_[k], lid_[j]))
        return CapVerdict::meets_itself;
  // Step 3.
  beneath_.clear(), slots_.clear(), beneath_boxes_.clear();
  tree.for_each_in(box, [&](FrontMesh::Slot s) {
    if (!front_.alive(s)) return;
    beneath_.push_back(corners_of_slot(s));
    slots_.push_back(s);
    beneath_boxes_.add(box_of(front_, s), open_.unit());
  });
  for (std::uint32_t k = 0; k < lid_.size(); ++k)
    for (const std::uint32_t j : beneath_boxes_.meeting(lid_boxes_, k, beneath_boxes_.size()))
      if (!parts(planes_[k], lid_[k], beneath_[j]) && !clear(lid_[k], beneath_[j])) {
        const Index f = open_.face_at(slots_[j]);
        const bool own = !open_.state(f).alive && open_.leader(open_[f].component) == lid.component;
        return own ? CapVerdict::meets_patch : CapVerdict::meets_front;
      }
  if (component_boxes_.size() < 2) return CapVerdict::accepted;
  return encloses_component(lid, tree) ? CapVerdict::encloses_component : CapVerdict::accepted;
}

/// If one neighbour is outside, so is the rest of the connected surface, which intersects the region's
/// boundary only in the rim.
bool LidProof::rim_turns_outward(const OpenFront::Lid& lid) const {
  std::vector<PointTriangle> old;
  const auto& floor = open_.floor(lid.component);
  for (const Index f : floor) old.push_back(open_[f].v);
  const EdgeIndex edges(old);
  for (const Index f : lid.faces) {
    const auto& face = open_[f];
    for (int i = 0; i < 3; ++i) {
      const Index beyond = face.across[i], a = face.v[i], b = face.v[(i + 1) % 3];
      if (open_[beyond].component != kNull && open_.leader(open_[beyond].component) == lid.component)
        continue;
      const std::uint32_t below = edges.find(a, b);
      if (below == kNull) return false;
      // The neighbour in the committed front: `beyond` may be in the lid of another component.
      const FrontMesh::Slot own = open_.state(floor[below]).slot;
      const Index outer = open_.face_at(front_[own].across[front_.index_of(own, open_.corner(a))]);
      const auto tip = [&](Index g) { return open_.x(open_.corner_opposite(g, a, b)); };
      if (!turns_outward(open_.x(a), open_.x(b), tip(floor[below]), open_.x(face.v[(i + 2) % 3]), tip(outer)))
        return false;
    }
  }
  return true;
}

/// Returns true if another component of the body may be between floor and lid.
bool LidProof::encloses_component(const OpenFront::Lid& lid, const AabbTree& tree) const {
  Eigen::AlignedBox3d box;
  for (const Index f : lid.faces) box.extend(open_.box(f));
  const auto& floor = open_.floor(lid.component);
  for (const Index f : floor) box.extend(open_.box(f));
  const std::uint32_t own = front_[open_.state(floor[0]).slot].component;
  std::vector<std::uint32_t> met;
  std::vector<FrontMesh::Slot> strangers;
  tree.for_each_in(box, [&](FrontMesh::Slot s) {
    if (!front_.alive(s)) return;
    const std::uint32_t component = front_[s].component;
    // Only a component that is entirely within the box can be enclosed without crossing the boundary.
    if (component == own || !box.contains(component_boxes_[component])) return;
    if (std::find(met.begin(), met.end(), component) != met.end()) return;
    met.push_back(component);
    strangers.push_back(s);
  });
  if (strangers.empty()) return false;
  // The boundary of the region. Its orientation does not affect the parity of ray crossings.
  Mesh region;
  std::vector<FaceId> faces;
  const auto add = [&](Index f) {
    VertexId corners[3];
    for (int i = 0; i < 3; ++i) {
      corners[i] = static_cast<VertexId>(region.vertices.size());
      region.vertices.push_back(open_.x(open_[f].v[i]));
    }
    faces.push_back(FaceId(static_cast<std::uint32_t>(region.face_count())));
    region.add_face(corners);
  };
  for (const Index f : lid.faces) add(f);
  for (const Index f : floor) add(f);
  // The component does not cross the boundary, so one vertex that is not on the boundary decides. If all
  // three are, assume that it is inside.
  return std::any_of(strangers.begin(), strangers.end(), [&](FrontMesh::Slot s) {
    for (const FrontMesh::Corner c : front_[s].v)
      if (const PointSide side = point_side(region, faces, front_.x(c)); side != PointSide::on_surface)
        return side == PointSide::inside;
    return true;
  });
}

CapVerdict LidProof::judge_fan(const OpenFront::Star& star, std::span<const Index> united,
                               const Eigen::Vector3d& w, const AabbTree& tree) {
  added_.clear(), obstacles_.clear(), reach_.clear();
  const VertexId id = star.onto_v ? open_.id(star.v) : VertexId(kNull);
  const auto triangle = [&](const Corners& c) {
    CheckedTriangle t;
    for (int i = 0; i < 3; ++i)
      t.x[i] = c.x[i], t.id[i] = c.id[i], t.box.extend(Eigen::Vector3d(c.x[i][0], c.x[i][1], c.x[i][2]));
    return t;
  };
  Eigen::AlignedBox3d box(w);
  for (const auto& r : star.rim) {
    if (!turns_outward(open_.x(r.a), open_.x(r.b), open_.x(open_.corner_opposite(r.face, r.a, r.b)), w,
                       open_.x(open_.corner_opposite(r.across, r.a, r.b))))
      return CapVerdict::turns_inward;
    added_.push_back(
        triangle({{open_.x(r.a).data(), open_.x(r.b).data(), w.data()}, {open_.id(r.a), open_.id(r.b), id}}));
    box.extend(added_.back().box);
  }
  for (std::size_t i = 0; i < added_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!added_[i].clear_of(added_[j])) return CapVerdict::meets_itself;
  for (const CheckedTriangle& t : added_) reach_.emplace_back(t);
  // The lids that it joins, found by walking over them from the rim.
  marks_.resize(open_.face_count(), 0);
  ++marker_;
  for (const Index f : star.faces) marks_[f] = marker_;
  stack_.clear();
  for (const auto& r : star.rim) stack_.push_back(r.across);
  while (!stack_.empty()) {
    const Index f = stack_.back();
    stack_.pop_back();
    if (marks_[f] == marker_ || open_[f].component == kNull) continue;
    marks_[f] = marker_;
    if (std::find(united.begin(), united.end(), open_.leader(open_[f].component)) == united.end()) continue;
    obstacles_.push_back(triangle(corners_of(f)));
    stack_.insert(stack_.end(), open_[f].across.begin(), open_[f].across.end());
  }
  const auto near = [&](const Eigen::AlignedBox3d& b) {
    return std::any_of(reach_.begin(), reach_.end(), [&](const TriangleReach& r) { return r.may_meet(b); });
  };
  tree.for_each_near(box, near, [&](FrontMesh::Slot s) {
    if (front_.alive(s)) obstacles_.push_back(triangle(corners_of_slot(s)));
  });
  for (const CheckedTriangle& a : added_)
    for (const CheckedTriangle& o : obstacles_)
      if (!a.clear_of(o)) return CapVerdict::meets_front;
  return CapVerdict::accepted;
}

}  // namespace lrb::construct
