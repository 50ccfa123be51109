#pragma once

namespace lrb {

/// Proves that two simplices (triangles, or segments in the plane) are further apart than `margin`: a plane
/// between them keeps that distance from both. Returns false if that is not proved; within a few margins
/// either answer can come. Takes world coordinates, and `margin` must be at least kWrapperMargin times the
/// largest of them.
bool separated_by(double margin, int dim, const double* const a[3], const double* const b[3]);

}  // namespace lrb
