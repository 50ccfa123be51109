#pragma once
/// Bridging does what patches cannot: it closes holes, fills deep concavities, joins components.

#include <cstdint>
#include <vector>

#include "engine/construct/complex_builder.hpp"
#include "engine/construct/construct_probe.hpp"
#include "engine/construct/hull_mesh.hpp"

namespace lrb::construct {

/// Covers the concavities of a set of components with the faces of their convex hull: the pockets between
/// become regions of this layer, and the components become one. `joined` (components): which ones to cover.
/// Does nothing and returns why if that would not make the surface simpler, or if faces of the convex hull
/// would meet others (vertices in one plane). Tells `probe` of the cap and its regions, if there is one.
CapVerdict bridge_concavities(HullMesh& hull, ComplexBuilder& complex, const std::vector<bool>& joined,
                              std::uint16_t layer, ConstructProbe* probe);

}  // namespace lrb::construct
