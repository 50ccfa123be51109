// Makes sure that a cap covers each polygon of the mesh wholly or not at all.

#include <algorithm>

#include "engine/construct/cap_surface.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::construct {

bool CapSurface::keep_polygons_whole(const HullMesh& hull, const Patch& patch) {
  if (!hull.has_polygons()) return true;
  // Mark the patch's triangles that remain in the cap.
  std::vector<bool> stays(patch.slots.size(), false);
  for (const Face& f : faces_)
    if (f.alive && f.kept >= 0) stays[f.kept] = true;
  // A kept triangle of a polygon, of which another triangle was covered.
  const auto is_partial = [&](const Face& f) {
    if (!f.alive || f.kept < 0) return false;
    const auto unit = hull.unit(patch.slots[f.kept]);
    for (HullMesh::Slot s = unit.first; s < unit.last; ++s)
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

/// Replaces the edge a, b that face f (a, b, c) shares with a new face g (b, a, w) by the edge c, w, if w
/// lies in front of f: the tetrahedron between them goes under the cap.
bool CapSurface::flip_outward(int f, int i) {
  Face& face = faces_[f];
  const int g = face.across[i];
  // Flipping needs a new triangle on the other side.
  if (g < 0 || faces_[g].kept >= 0) return false;
  Face& other = faces_[g];
  const int a = face.v[i], b = face.v[(i + 1) % 3], c = face.v[(i + 2) % 3];
  const int j = index_of(g, b), w = other.v[(j + 2) % 3];
  // The flipped surface must lie in front of the old one: exact.
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
  // The deviation must be measured again: see CapGauge::measure_again().
  face.extra = other.extra = 0;
  face.since = other.since = ++version_;
  --kept_;
  other.v = {c, a, w};
  other.across = {beyond_ca, beyond_aw, f};
  set_across(beyond_wb, w, b, f);
  set_across(beyond_ca, c, a, g);
  face.plane = plane_of(b, c, w);
  other.plane = plane_of(c, a, w);
  // a and b each lost a triangle: refer them to the one that they still have.
  if (!is_ring(a)) face_of_[a] = g;
  if (!is_ring(b)) face_of_[b] = f;
  return true;
}

}  // namespace lrb::construct
