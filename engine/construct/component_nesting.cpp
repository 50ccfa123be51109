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

ComponentNesting find_nesting(const Mesh& mesh, const HullMesh& hull) {
  ComponentNesting out;
  const std::uint32_t count = hull.component_count();
  out.is_void.assign(count, false);
  out.home.assign(count, kNull);
  if (count == 1) return out;
  const std::vector<Component> components = components_of(hull);
  for (std::uint32_t c = 0; c < count; ++c) out.is_void[c] = volume_sign(mesh, components[c].faces) < 0;
  for (std::uint32_t c = 0; c < count; ++c) {
    if (out.is_void[c]) {
      out.home[c] = c;
      continue;
    }
    // The innermost of the voids around a component is the one that lies in all the others.
    for (std::uint32_t v = 0; v < count; ++v) {
      if (!out.is_void[v] || !is_inside(mesh, components[c], components[v])) continue;
      if (out.home[c] == kNull || is_inside(mesh, components[v], components[out.home[c]])) out.home[c] = v;
    }
  }
  return out;
}

}  // namespace lrb::construct
