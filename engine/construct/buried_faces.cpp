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
  if (meeting.empty() || hull.component_count() == 1) return {};
  const auto meets = [&](Slot s) { return std::binary_search(meeting.begin(), meeting.end(), hull[s].face); };
  std::vector<std::uint32_t> component_of(mesh.face_count(), kNull);
  DisjointSets sheets(hull.slot_count());  // connected over edges; nothing passes through one
  for (Slot s = 0; s < hull.slot_count(); ++s) {
    component_of[hull[s].face] = hull[s].component;
    if (meets(s)) continue;
    for (const Slot t : hull[s].across)
      if (!meets(t)) sheets.join(s, t);
  }
  const SideFinder finder(mesh, std::move(component_of));
  const std::vector<int> signs = signs_of(mesh, hull);
  enum class SheetKind : std::uint8_t { unknown, free, buried };
  // By how often the space in front of a face is covered by solids; unknown where its first corner lies on
  // another component's surface.
  const auto look_at = [&](Slot s) {
    int solids = signs[hull[s].component] < 0 ? -1 : 0;
    for (const SideFinder::Side& side : finder.sides(hull.x(hull[s].v[0]))) {
      if (side.surface == hull[s].component) continue;
      if (side.side == PointSide::on_surface) return SheetKind::unknown;
      solids += signs[side.surface];
    }
    return solids > 0 ? SheetKind::buried : SheetKind::free;
  };
  std::vector<SheetKind> known(hull.slot_count(), SheetKind::unknown);  // at a sheet's leader
  for (Slot s = 0; s < hull.slot_count(); ++s)
    if (SheetKind& sheet = known[sheets.leader(s)]; !meets(s) && sheet == SheetKind::unknown)
      sheet = look_at(s);
  std::vector<FaceId> buried;
  for (Slot s = 0; s < hull.slot_count(); ++s)
    if (!meets(s) && known[sheets.leader(s)] != SheetKind::free) buried.push_back(hull[s].face);
  return buried;
}

}  // namespace lrb::construct
