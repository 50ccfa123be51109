// The surface of a cap under edge collapses, with half-edge-like adjacency (the face across each edge) over
// local vertex numbers. A collapse replaces the star of an edge by a fan from one vertex over the star's rim.

#include "engine/construct/cap_surface.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::construct {

void CapSurface::load(const FrontMesh& front, const Patch& patch, VertexId first_id) {
  next_id_ = first_id;
  load_points(front, patch);
  load_faces(front, patch);
  load_surroundings(front, patch);
}

void CapSurface::load_points(const FrontMesh& front, const Patch& patch) {
  // The maps are never cleared: an entry is valid only if the local element refers back to it. Loading
  // therefore takes time proportional to the patch, not to the front.
  if (local_point_.size() < front.point_count()) local_point_.resize(front.point_count(), -1);
  points_.clear();
  corners_.clear();
  // Ring vertices first, in order: is_ring() is a comparison, and ring edge k starts at vertex k.
  for (const auto* list : {&patch.ring, &patch.interior}) {
    for (const FrontMesh::Corner v : *list) {
      local_point_[v] = vertex_count();
      points_.push_back(front.point(v));
      corners_.push_back(v);
    }
  }
  ring_size_ = static_cast<int>(patch.ring.size());
  first_new_ = vertex_count();
  face_of_.assign(points_.size(), -1);
  mark_.assign(points_.size(), 0);
  marker_ = 0;
}

void CapSurface::load_faces(const FrontMesh& front, const Patch& patch) {
  if (local_face_.size() < front.slot_count()) local_face_.resize(front.slot_count(), -1);
  for (std::size_t i = 0; i < patch.slots.size(); ++i) local_face_[patch.slots[i]] = static_cast<int>(i);
  faces_.resize(patch.slots.size());
  ring_face_.assign(patch.ring.size(), -1);
  alive_ = kept_ = static_cast<int>(faces_.size());
  version_ = 1;
  patch_area_ = 0;
  for (int f = 0; f < alive_; ++f) {
    const auto& t = front[patch.slots[f]];
    Face& face = faces_[f];
    for (int i = 0; i < 3; ++i) {
      face.v[i] = local_point_[t.v[i]];
      // A neighbour outside the patch becomes -1 now, and the code of its ring edge below.
      face.across[i] = local_face(patch, t.across[i]);
    }
    for (int i = 0; i < 3; ++i) {
      const int v = face.v[i];
      if (face.across[i] < 0) {  // on the ring, edge v starts at vertex v
        face.across[i] = -1 - v;
        ring_face_[v] = f;
        face_of_[v] = f;
      } else if (!is_ring(v)) {
        face_of_[v] = f;
      }
    }
    face.plane = plane_of(face.v[0], face.v[1], face.v[2]);
    face.kept = f;
    face.alive = true;
    face.since = version_;
    face.rejected = {};
    patch_area_ += face.plane.area;
  }
}

void CapSurface::load_surroundings(const FrontMesh& front, const Patch& patch) {
  beyond_.resize(patch.ring.size());
  chords_.assign(patch.ring.size() * patch.ring.size(), false);
  // Local number of a ring vertex, or -1.
  const auto local = [&](FrontMesh::Corner c) {
    const int v = local_point_[c];
    return v >= 0 && v < ring_size_ && corners_[v] == c ? v : -1;
  };
  for (int k = 0; k < ring_size_; ++k) {
    const FrontMesh::Slot s = patch.outside[k];
    const int next = (k + 1) % ring_size_;
    const int i = front.index_of(s, patch.ring[next]);  // opposite to the direction of the ring
    // The outer neighbour's third vertex and plane: they limit the positions of vertices near the ring.
    beyond_[k].tip = front.x(front[s].v[(i + 2) % 3]);
    const Eigen::Vector3d &a = front.x(front[s].v[0]), &b = front.x(front[s].v[1]),
                          &c = front.x(front[s].v[2]);
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    // A degenerate triangle has no plane: its normal is zero.
    const double length = norm3(normal);
    beyond_[k].plane.n = length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d(0, 0, 0);
    beyond_[k].plane.d = dot3(beyond_[k].plane.n, a);
    beyond_[k].plane.area = length / 2;
    // Record the edges from this vertex to others of the ring that are neither ring edges nor in the patch.
    front.for_each_around(patch.ring[k], [&](FrontMesh::Slot t, int j) {
      if (local_face(patch, t) >= 0) return;
      const int other = local(front[t].v[(j + 1) % 3]);
      if (other < 0 || other == next || (other + 1) % ring_size_ == k) return;
      chords_[k * ring_size_ + other] = chords_[other * ring_size_ + k] = true;
    });
  }
}

CapSurface::Plane CapSurface::plane_of(int a, int b, int c) const {
  const Eigen::Vector3d normal = (x(b) - x(a)).cross(x(c) - x(a));
  const double length = norm3(normal);
  Plane p;
  p.n = length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d(0, 0, 0);
  p.d = dot3(p.n, x(a));
  p.area = length / 2;
  return p;
}

bool CapSurface::find_star(int u, int v, Star& star) {
  star.u = u;
  star.v = v;
  star.faces.clear();
  star.rim.clear();
  star.since = 0;
  ++marker_;
  // Step 1: find the triangle u, v, x by traversing the fan of u.
  int first = face_of_[u];
  for (int i = index_of(first, u); faces_[first].v[(i + 1) % 3] != v; i = index_of(first, u)) {
    first = faces_[first].across[(i + 2) % 3];
    if (first == face_of_[u]) return false;  // u and v are no longer neighbours
  }
  // Step 2: traverse the fan of u from the triangle u, v, x to the triangle u, y, v. Mark its neighbours and
  // collect its rim.
  int last = first;
  for (int f = first;;) {
    const int i = index_of(f, u);
    const Face& t = faces_[f];
    const int a = t.v[(i + 1) % 3], b = t.v[(i + 2) % 3];
    star.faces.push_back(f);
    mark_[a] = marker_;
    // The two triangles at the edge u, v are removed; each other one contributes one rim edge.
    if (a != v && b != v) add_to_rim(star, {a, b, t.across[(i + 1) % 3], f});
    star.since = std::max(star.since, t.since);
    if (a == v) star.across_first = t.across[(i + 1) % 3];
    if (b == v) star.across_last = t.across[(i + 1) % 3];
    last = f;
    f = t.across[(i + 2) % 3];
    if (f == first) break;
  }
  mark_[v] = 0;
  // Link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999): u and v must have exactly two common
  // neighbours.
  if (is_ring(v)) {
    if (count_marked_neighbours_of_ring(v) != 2) return false;
    // The fan from v has new edges to rim vertices. An edge between ring vertices may already exist in the
    // front.
    for (const auto& r : star.rim)
      if (is_ring(r.b) && r.b != v && &r != &star.rim.back() && chord_outside(r.b, v)) return false;
    return true;
  }
  // Step 3: the fan of v, and the rest of the rim.
  int common = 0;
  for (int f = last;;) {
    const int i = index_of(f, v);
    const Face& t = faces_[f];
    const int a = t.v[(i + 1) % 3], b = t.v[(i + 2) % 3];
    common += mark_[a] == marker_;
    if (a != u && b != u) {
      star.faces.push_back(f);
      add_to_rim(star, {a, b, t.across[(i + 1) % 3], f});
      star.since = std::max(star.since, t.since);
    }
    f = t.across[(i + 2) % 3];
    if (f == last) break;
  }
  // A rim of two edges would leave two triangles with the same three vertices.
  return common == 2 && star.rim.size() >= 3;
}

void CapSurface::add_to_rim(Star& star, const Star::Rim& rim) const {
  star.rim.push_back(rim);
  if (rim.across >= 0) star.since = std::max(star.since, faces_[rim.across].since);
}

bool CapSurface::is_behind_a_face_at(int u, int v) const {
  int f = face_of_[u];
  do {
    const Face& t = faces_[f];
    // Collapsing u onto v would cut below this triangle.
    if (t.v[0] != v && t.v[1] != v && t.v[2] != v && dot3(t.plane.n, x(v)) < t.plane.d) return true;
    f = t.across[(index_of(f, u) + 2) % 3];
  } while (f != face_of_[u]);
  return false;
}

int CapSurface::count_marked_neighbours_of_ring(int r) const {
  int f = face_of_[r];
  // A ring vertex has an open fan: traverse from its ring edge to the other ring edge.
  int i = index_of(f, r);
  int count = mark_[faces_[f].v[(i + 1) % 3]] == marker_;
  for (;;) {
    i = index_of(f, r);
    count += mark_[faces_[f].v[(i + 2) % 3]] == marker_;
    f = faces_[f].across[(i + 2) % 3];
    if (f < 0) return count;
  }
}

int CapSurface::collapse_to_new(const Star& star, const Eigen::Vector3d& position) {
  // The caller has placed the new vertex; ids are provisional, see id().
  const int w = vertex_count();
  points_.push_back({position, next_id_++});
  face_of_.push_back(-1);
  mark_.push_back(0);
  replace(star, w);
  return w;
}

void CapSurface::collapse_onto_ring(const Star& star) {
  replace(star, star.v);
}

void CapSurface::move(int v, const Eigen::Vector3d& position) {
  // Only the planes of its fan change.
  points_[v].x = position;
  ++version_;
  int f = face_of_[v];
  do {
    const int i = index_of(f, v);
    faces_[f].plane = plane_of(faces_[f].v[0], faces_[f].v[1], faces_[f].v[2]);
    faces_[f].since = version_;
    f = faces_[f].across[(i + 2) % 3];
  } while (f != face_of_[v]);
}

/// Replaces the star's triangles by a fan from w over its rim. New faces reuse the entries of old ones.
void CapSurface::replace(const Star& star, int w) {
  ++version_;
  for (const int f : star.faces) {
    faces_[f].alive = false;
    kept_ -= faces_[f].kept >= 0;
  }
  alive_ -= static_cast<int>(star.faces.size());
  const int count = static_cast<int>(star.rim.size());
  // One new face per rim edge, stored in the entry of the old face at that edge. Around a ring vertex the fan
  // is open.
  const bool open = w == star.v;
  face_of_[star.u] = -1;
  if (!open) face_of_[star.v] = -1;
  for (int k = 0; k < count; ++k) {
    const auto& r = star.rim[k];
    Face& face = faces_[r.face];
    face.v = {r.a, r.b, w};
    face.across[0] = r.across;
    face.across[1] = k + 1 < count ? star.rim[k + 1].face : open ? star.across_last : star.rim[0].face;
    face.across[2] = k > 0 ? star.rim[k - 1].face : open ? star.across_first : star.rim[count - 1].face;
    face.plane = plane_of(r.a, r.b, w);
    face.kept = -1;
    face.alive = true;
    face.since = version_;
    face.rejected = {};
    // The neighbour across the rim, or the ring, refers back to it.
    set_across(r.across, r.a, r.b, r.face);
    if (!is_ring(r.a)) face_of_[r.a] = r.face;
    if (!is_ring(r.b)) face_of_[r.b] = r.face;
  }
  alive_ += count;
  // An open fan also has the two edges at w itself.
  if (open) {
    set_across(star.across_first, w, star.rim.front().a, star.rim.front().face);
    set_across(star.across_last, star.rim.back().b, w, star.rim.back().face);
  } else {
    face_of_[w] = star.rim[0].face;
  }
}

/// Makes face f the neighbour across its directed edge a, b, for the face or ring edge that `code` denotes.
void CapSurface::set_across(int code, int a, int b, int f) {
  if (code < 0)
    ring_face_[-1 - code] = face_of_[a] = f;
  else
    faces_[code].across[index_of(code, b)] = f;
}

// Ensures that a cap covers each polygon of the mesh entirely or not at all.

bool CapSurface::keep_polygons_whole(const FrontMesh& front, const Patch& patch) {
  if (!front.has_polygons()) return true;
  // Mark the patch's triangles that are retained in the cap.
  std::vector<bool> stays(patch.slots.size(), false);
  for (const Face& f : faces_)
    if (f.alive && f.kept >= 0) stays[f.kept] = true;
  // A retained triangle of a polygon with another triangle that was covered.
  const auto is_partial = [&](const Face& f) {
    if (!f.alive || f.kept < 0) return false;
    const auto unit = front.unit(patch.slots[f.kept]);
    for (FrontMesh::Slot s = unit.first; s < unit.last; ++s)
      if (!stays[local_face(patch, s)]) return true;
    return false;
  };
  // Flips may expose other polygons, so repeat until none is partial, or no flip helps.
  for (bool partial = true; partial;) {
    partial = false;
    bool progress = false;
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
      if (!is_partial(faces_[f])) continue;
      partial = true;
      const int kept = faces_[f].kept;
      for (int i = 0; i < 3 && stays[kept]; ++i)
        if (flip_outward(f, i)) stays[kept] = false;
      progress |= !stays[kept];
    }
    if (partial && !progress) return false;
  }
  return true;
}

bool CapSurface::are_neighbours(int a, int b) const {
  return std::any_of(faces_.begin(), faces_.end(), [&](const Face& f) {
    const auto has = [&](int v) { return f.v[0] == v || f.v[1] == v || f.v[2] == v; };
    // Linear search: flips are rare, and a cap has few faces.
    return f.alive && has(a) && has(b);
  });
}

/// Replaces the edge a, b that face f (a, b, c) shares with a new face g (b, a, w) by the edge c, w, if w is
/// in front of f: the tetrahedron between them is then under the cap.
bool CapSurface::flip_outward(int f, int i) {
  Face& face = faces_[f];
  const int g = face.across[i];
  // Flipping requires a new triangle on the other side.
  if (g < 0 || faces_[g].kept >= 0) return false;
  Face& other = faces_[g];
  const int a = face.v[i], b = face.v[(i + 1) % 3], c = face.v[(i + 2) % 3];
  const int j = index_of(g, b), w = other.v[(j + 2) % 3];
  // The flipped surface must be in front of the old one. Exact.
  if (exact::orient3d(x(face.v[0]).data(), x(face.v[1]).data(), x(face.v[2]).data(), x(w).data()) <= 0)
    return false;
  // The new edge must not exist yet, neither in the cap nor in the front outside the patch.
  if (are_neighbours(c, w) || (is_ring(c) && is_ring(w) && chord_outside(c, w))) return false;
  // The four outer neighbours of the quadrilateral.
  const int beyond_bc = face.across[(i + 1) % 3], beyond_ca = face.across[(i + 2) % 3];
  const int beyond_aw = other.across[(j + 1) % 3], beyond_wb = other.across[(j + 2) % 3];
  face.v = {b, c, w};
  face.across = {beyond_bc, g, beyond_wb};
  face.kept = -1;
  face.since = other.since = ++version_;
  --kept_;
  other.v = {c, a, w};
  other.across = {beyond_ca, beyond_aw, f};
  set_across(beyond_wb, w, b, f);
  set_across(beyond_ca, c, a, g);
  face.plane = plane_of(b, c, w);
  other.plane = plane_of(c, a, w);
  // a and b each lost a triangle: refer them to the remaining one.
  if (!is_ring(a)) face_of_[a] = g;
  if (!is_ring(b)) face_of_[b] = f;
  return true;
}

}  // namespace lrb::construct
