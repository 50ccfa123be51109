#pragma once

#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Returns the thickness of each region: an upper bound on the distance from any of its points (its lids
/// included) to the nearest real face, in the mesh's unit. Rounded upward; infinite where regions hide each
/// other in a circle.
///
/// From a point of a lid this distance is at most the max over the lid's triangles T of the min over the
/// floor's triangles F of (the max over T's corners of the distance to F, which is convex, + F's own bound);
/// lids are cut in four where that is not tight. A point inside the region is no further from the region's
/// boundary than half the region's width in any direction.
std::vector<double> region_thickness(const LrbRep& rep);

}  // namespace lrb
