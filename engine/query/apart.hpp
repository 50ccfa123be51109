#pragma once

#include <cstdint>

namespace lrb {

/// Proves two simplices (triangles, or segments in the plane) further apart than `margin`: a plane between
/// them keeps that distance from both. False: not proved; within a few margins both answers can come. World
/// coordinates, of which `margin` must be kWrapperMargin of the largest at least.
bool apart_by(double margin, int dim, const double* const a[3], const double* const b[3]);

/// The widest slab found between two simplices, at least what keeps them apart: 0 if there is none, or none
/// wider than `margin`. Looks no further once one is wider than `enough`. `hint`: the direction to be tried
/// first, from an earlier search of the same pair (0 at first); afterwards the best one.
double gap_between(double margin, double enough, int dim, const double* const a[3], const double* const b[3],
                   std::uint8_t& hint);

/// The same for the three likeliest directions alone.
double likely_gap(double margin, double enough, int dim, const double* const a[3], const double* const b[3]);

/// For triangles that may cross: a depth > 0 proves that an edge of one passes through the interior of the
/// other, and still will when points of either have moved by less than that; 0: not proved. `enough` and
/// `hint` as above.
double crossing_depth(double enough, const double* const a[3], const double* const b[3], std::uint8_t& hint);

}  // namespace lrb
