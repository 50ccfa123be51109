// Finds the faces of a self-intersecting body that lie inside other components:
// 1. Connect the triangles that intersect nothing into sheets. A sheet is on one side of every component.
// 2. Count for one vertex of each sheet how many solids cover the space in front of it, by exact rays.
// 3. A sheet with a positive count is buried.

#include "engine/construct/components.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/mesh/nesting.hpp"
#include "engine/mesh/point_inside.hpp"
#include <lrbscope/core/disjoint_sets.hpp>

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

// Nesting of a body's components: voids have negative volume (exact); an exact ray decides which components
// contain each other; a solid component belongs to the innermost void that contains it.

namespace {

struct Component {
  std::vector<FaceId> faces;
  Eigen::AlignedBox3d box;
};

std::vector<Component> components_of(const HullMesh& hull) {
  std::vector<Component> out(hull.component_count());
  for (HullMesh::Slot s = 0; s < hull.slot_count(); ++s) {
    // The triangles of a polygon are consecutive, so comparing with the last face removes duplicates.
    Component& c = out[hull[s].component];
    if (c.faces.empty() || c.faces.back() != hull[s].face) c.faces.push_back(hull[s].face);
    c.box.extend(box_of(hull, s));
  }
  return out;
}

/// The components around each one, ascending. The first corner of a face that does not lie on the other's
/// surface decides; where those of many faces do, the two have their surface in common.
std::vector<std::vector<std::uint32_t>> find_holders(const Mesh& mesh,
                                                     const std::vector<Component>& components) {
  std::vector<std::uint32_t> component_of(mesh.face_count(), kNull);
  for (std::uint32_t c = 0; c < components.size(); ++c)
    for (const FaceId f : components[c].faces) component_of[f] = c;
  // One ray per point answers for all components at once.
  const SideFinder finder(mesh, std::move(component_of));
  // Vertices on another component's surface decide nothing: try the next face, up to this many.
  constexpr std::size_t kTries = 64;
  std::vector<std::vector<std::uint32_t>> holders(components.size());
  for (std::uint32_t c = 0; c < components.size(); ++c) {
    const auto& faces = components[c].faces;
    holders[c] = finder.around(c, [&](std::size_t i) {
      return i < std::min(kTries, faces.size()) ? &mesh.vertices[mesh.face(faces[i])[0]] : nullptr;
    });
    // The box of a container contains that of the other. This excludes most components that merely cross.
    std::erase_if(holders[c],
                  [&](std::uint32_t h) { return !components[h].box.contains(components[c].box); });
  }
  return holders;
}

}  // namespace

std::vector<std::uint32_t> find_nesting(const Mesh& mesh, const HullMesh& hull) {
  const std::uint32_t count = hull.component_count();
  std::vector<std::uint32_t> home(count, kNull);
  // The usual case: nothing can be nested.
  if (count == 1) return home;
  const std::vector<Component> components = components_of(hull);
  // Exact sign of the volume: a component that faces inward bounds a void.
  std::vector<bool> is_void(count);
  for (std::uint32_t c = 0; c < count; ++c) is_void[c] = volume_sign(mesh, components[c].faces) < 0;
  const auto holders = find_holders(mesh, components);
  const auto is_inside = [&](std::uint32_t inner, std::uint32_t outer) {
    return std::binary_search(holders[inner].begin(), holders[inner].end(), outer);
  };
  for (std::uint32_t c = 0; c < count; ++c) {
    // A void is its own home: its front faces the space inside it.
    if (is_void[c]) {
      home[c] = c;
      continue;
    }
    // Of the voids around it the innermost is in all others.
    for (const std::uint32_t v : holders[c])
      if (is_void[v] && (home[c] == kNull || is_inside(v, home[c]))) home[c] = v;
  }
  return home;
}

}  // namespace lrb::construct
