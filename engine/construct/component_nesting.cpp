// Nesting of a body's components: voids have negative volume (exact); an exact ray decides which components
// contain each other; a solid component belongs to the innermost void that contains it.

#include "engine/construct/component_nesting.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/mesh/point_inside.hpp"
#include "engine/mesh/volume_sign.hpp"

namespace lrb::construct {
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
