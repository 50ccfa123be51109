#pragma once
/// Every small constant of the engine: its unit, its reason, and what breaks if it is changed. The answer of
/// a query depends on none of them: they decide how much work is left to the exact tests.

namespace lrb {

/// Weight of a simplex's corners in the principal axes of a tree node, relative to the area of a node's box
/// squared. Keeps segments and points (area 0) from having no axes at all. Larger: frames follow the
/// tessellation.
inline constexpr double kFrameCornerWeight = 1e-12;

/// Growth of quantized boxes, relative to the box's coordinates: covers the rounding of three products, two
/// sums and one difference in double (under 2^-50) and of the decoding in float (under 2^-22). Smaller: a box
/// could lose a corner by a rounding error; larger: more pairs to test.
inline constexpr double kTreeRounding = 0x1p-21;
/// The same for the rounding of a difference of coordinates, which are at most 1 in units.
inline constexpr double kTreeRoundingUnits = 0x1p-50;

}  // namespace lrb
