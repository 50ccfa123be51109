#pragma once
/// What patches cannot do: close holes, fill deep concavities, join components.

#include <cstdint>
#include <vector>

#include "engine/construct/complex_builder.hpp"
#include "engine/construct/hull_mesh.hpp"

namespace lrb::construct {

/// Covers the concavities of a set of components with the faces of their convex hull: the pockets between
/// become regions of this layer, and the components one. `joined` (components): those to cover. False, and
/// nothing happens, if that would not make the surface simpler, or if faces of the convex hull would meet
/// others (vertices in one plane).
bool bridge_concavities(HullMesh& hull, ComplexBuilder& complex, const std::vector<bool>& joined,
                        std::uint16_t layer);

}  // namespace lrb::construct
