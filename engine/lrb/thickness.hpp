#pragma once

#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// How much a region hides: for each region an upper bound of the distance from any of its points (its lids
/// included) to the nearest real face, in the mesh's unit. Rounded upward; infinite where regions hide each
/// other in a circle.
///
/// From a point of a lid it is at most max over the lid's triangles T of min over the floor's triangles F of
/// (max over T's corners of the distance to F, which is convex, + what F itself is off); lids are cut in four
/// where that is not tight. A point inside is no further from the region's boundary than half the region's
/// width in any direction.
std::vector<double> region_thickness(const LrbRep& rep);

}  // namespace lrb
