#pragma once
/// A new sheet on the hull: into the complex with its regions, and into the hull in place of what it covers.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/build/cap_surface.hpp"
#include "engine/build/complex_builder.hpp"
#include "engine/build/hull_mesh.hpp"
#include "engine/build/region_split.hpp"

namespace lrb {

/// Takes the triangles `removed` out of the hull and puts `added` (by the hull's vertices) in their place.
/// They become pseudo faces of `component` with regions of this layer behind them and, for now, the outside
/// in front; the faces they cover get those regions in front. `removed` and `added` have the same boundary.
/// Returns the new slots.
std::vector<HullMesh::Slot> cover(HullMesh& hull, ComplexBuilder& complex,
                                  std::span<const HullMesh::Slot> removed,
                                  std::span<const PointTriangle> added, std::uint16_t layer,
                                  std::uint32_t component);

/// The same for a patch and its finished cap: new vertices are added, triangles that the cap has kept stay.
/// Returns all of the cap's slots, the new ones first.
std::vector<HullMesh::Slot> cover(HullMesh& hull, ComplexBuilder& complex, const Patch& patch,
                                  const CapSurface& cap, std::uint16_t layer, std::size_t& new_count);

}  // namespace lrb
