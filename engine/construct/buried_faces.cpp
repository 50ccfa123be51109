// Finds the faces of a self-intersecting body that lie inside other components:
// 1. Connect the triangles that intersect nothing into sheets. A sheet is on one side of every component.
// 2. Count for one vertex of each sheet how many solids cover the space in front of it, by exact rays.
// 3. A sheet with a positive count is buried.

#include "engine/construct/buried_faces.hpp"

#include <algorithm>

#include "engine/core/disjoint_sets.hpp"
#include "engine/mesh/point_inside.hpp"
#include "engine/mesh/volume_sign.hpp"

namespace lrb::construct {
namespace {

using Slot = HullMesh::Slot;

/// Returns +1 for components that are solid, -1 for voids.
std::vector<int> signs_of(const Mesh& mesh, const HullMesh& hull) {
  // Faces per component, without repetition: the triangles of a polygon are consecutive.
  std::vector<std::vector<FaceId>> faces(hull.component_count());
  for (Slot s = 0; s < hull.slot_count(); ++s) {
    auto& own = faces[hull[s].component];
    if (own.empty() || own.back() != hull[s].face) own.push_back(hull[s].face);
  }
  std::vector<int> signs;
  for (const auto& own : faces) signs.push_back(volume_sign(mesh, own) < 0 ? -1 : 1);
  return signs;
}

}  // namespace

std::vector<FaceId> find_buried(const Mesh& mesh, const HullMesh& hull, const std::vector<FaceId>& meeting) {
  // Nothing can be buried in a body that does not cross itself, or that has a single component.
  if (meeting.empty() || hull.component_count() == 1) return {};
  const auto meets = [&](Slot s) { return std::binary_search(meeting.begin(), meeting.end(), hull[s].face); };
  std::vector<std::uint32_t> component_of(mesh.face_count(), kNull);
  DisjointSets sheets(hull.slot_count());  // connected over edges; nothing passes through one
  for (Slot s = 0; s < hull.slot_count(); ++s) {
    // Step 1. Intersecting triangles are the borders of sheets.
    component_of[hull[s].face] = hull[s].component;
    if (meets(s)) continue;
    for (const Slot t : hull[s].across)
      if (!meets(t)) sheets.join(s, t);
  }
  const SideFinder finder(mesh, std::move(component_of));
  const std::vector<int> signs = signs_of(mesh, hull);
  enum class SheetKind : std::uint8_t { unknown, free, buried };
  // Step 2. The space in front of a face is in a solid if more solids than voids contain it. Undecided where
  // the first vertex is on another component's surface.
  const auto look_at = [&](Slot s) {
    // In front of a void's wall, the component itself counts as a void.
    int solids = signs[hull[s].component] < 0 ? -1 : 0;
    for (const SideFinder::Side& side : finder.sides(hull.x(hull[s].v[0]))) {
      if (side.surface == hull[s].component) continue;
      if (side.side == PointSide::on_surface) return SheetKind::unknown;
      solids += signs[side.surface];
    }
    return solids > 0 ? SheetKind::buried : SheetKind::free;
  };
  std::vector<SheetKind> known(hull.slot_count(), SheetKind::unknown);  // at a sheet's leader
  // A sheet with an undecided vertex is tried again from its next triangle. At worst, this is one query for
  // each triangle.
  for (Slot s = 0; s < hull.slot_count(); ++s)
    if (SheetKind& sheet = known[sheets.leader(s)]; !meets(s) && sheet == SheetKind::unknown)
      sheet = look_at(s);
  // Step 3. Undecided sheets count as buried: covering them could not be proven safe.
  std::vector<FaceId> buried;
  for (Slot s = 0; s < hull.slot_count(); ++s)
    if (!meets(s) && known[sheets.leader(s)] != SheetKind::free) buried.push_back(hull[s].face);
  return buried;
}

}  // namespace lrb::construct
