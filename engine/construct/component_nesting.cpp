#include "engine/construct/component_nesting.hpp"

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
    Component& c = out[hull[s].component];
    if (c.faces.empty() || c.faces.back() != hull[s].face) c.faces.push_back(hull[s].face);
    c.box.extend(box_of(hull, s));
  }
  return out;
}

bool is_inside(const Mesh& mesh, const Component& inner, const Component& outer) {
  if (!outer.box.contains(inner.box)) return false;
  for (const FaceId f : inner.faces) {
    const PointSide side = point_side(mesh, outer.faces, mesh.vertices[mesh.face(f)[0]]);
    if (side != PointSide::on_surface) return side == PointSide::inside;
  }
  return false;
}

}  // namespace

std::vector<std::uint32_t> find_nesting(const Mesh& mesh, const HullMesh& hull) {
  const std::uint32_t count = hull.component_count();
  std::vector<std::uint32_t> home(count, kNull);
  if (count == 1) return home;
  const std::vector<Component> components = components_of(hull);
  std::vector<bool> is_void(count);
  for (std::uint32_t c = 0; c < count; ++c) is_void[c] = volume_sign(mesh, components[c].faces) < 0;
  for (std::uint32_t c = 0; c < count; ++c) {
    if (is_void[c]) {
      home[c] = c;
      continue;
    }
    // Of the voids around it the innermost is in all others.
    for (std::uint32_t v = 0; v < count; ++v) {
      if (!is_void[v] || !is_inside(mesh, components[c], components[v])) continue;
      if (home[c] == kNull || is_inside(mesh, components[v], components[home[c]])) home[c] = v;
    }
  }
  return home;
}

}  // namespace lrb::construct
