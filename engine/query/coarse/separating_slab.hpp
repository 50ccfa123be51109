#pragma once

namespace lrb {

/// Proves two simplices (triangles, or segments in the plane) further apart than `margin`: a plane between
/// them keeps that distance from both. False: not proved; within a few margins both answers can come. World
/// coordinates, of which `margin` must be kWrapperMargin of the largest at least.
bool separated_by(double margin, int dim, const double* const a[3], const double* const b[3]);

}  // namespace lrb
