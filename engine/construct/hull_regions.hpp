#pragma once
/// The regions that a builder makes of whole hulls when no cap shrinks them further, for HullMesh and
/// HullLoops alike. `home`: (components) the void in front of a component, itself for a void; kNull for the
/// outside.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/construct/complex_builder.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Makes what is left of each void one region, which has only a floor.
template <class Hull>
void fill_voids(const Hull& hull, std::span<const std::uint32_t> home, std::uint16_t layer,
                ComplexBuilder& complex) {
  std::vector<RegionId> core(home.size(), kNull);
  for (std::uint32_t c = 0; c < core.size(); ++c)
    if (home[c] == c) core[c] = complex.add_region(layer);
  for (const typename Hull::Slot s : hull.alive_slots()) {
    const std::uint32_t in = home[hull[s].component];
    if (in != kNull) complex.set_outer_cell(hull[s].face, core[in]);
  }
}

/// Makes `wrapper` the outermost wrapper: what lies between it and the outer hulls is one region.
template <class Hull>
void enclose(const Hull& hull, std::span<const std::uint32_t> home, const Mesh& wrapper, std::uint16_t layer,
             ComplexBuilder& complex) {
  const RegionId region = complex.add_region(layer);
  for (const typename Hull::Slot s : hull.alive_slots())
    if (home[hull[s].component] == kNull) complex.set_outer_cell(hull[s].face, region);
  std::vector<VertexId> ids;
  for (const Eigen::Vector3d& v : wrapper.vertices) ids.push_back(complex.add_vertex(v));
  std::vector<VertexId> corners;
  for (FaceId f = 0; f < wrapper.face_count(); ++f) {
    corners.clear();
    for (const VertexId v : wrapper.face(f)) corners.push_back(ids[v]);
    complex.add_pseudo_face(corners, region, kOutside);
  }
}

}  // namespace lrb::construct
