#pragma once

#include <vector>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Returns the thickness of each region: an upper bound on the distance from any point of its lids to the
/// nearest real face, in the mesh's unit. Rounded upward. The search ends a hundredth above the largest
/// distance that it came across, or after a limit of steps, which makes the bound larger. Infinite for a
/// region without lids, which nothing hides. Says nothing of points inside the region: under a lid over the
/// neck of a bottle they may be further off.
///
/// The one-sided Hausdorff distance from the lids to the set of all real faces, by branch and bound: see
/// thickness.cpp. Takes `threads` threads (see BuildOptions); the result does not depend on them.
std::vector<double> region_thickness(const LrbRep& rep, unsigned threads = 1);

}  // namespace lrb
