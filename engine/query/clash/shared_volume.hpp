#pragma once
/// The volume of the intersection of two closed bodies.

#include "engine/query/clash/clash.hpp"
#include "engine/query/clash/unit_bodies.hpp"

namespace lrb::parting {

/// Returns an interval that contains the volume, in units cubed. The bodies must be closed and must not
/// intersect themselves.
///
/// Along x a closed surface is a signed sum of prisms: a point is inside if one more of the triangles above
/// it faces up than down. So the common volume is the sum over pairs of triangles, one of each body, of the
/// integral of the lower height over the intersection of their projections, with the product of their
/// orientations as sign. No configuration is degenerate; there is only rounding.
ProvedInterval shared_volume(const UnitBodies& bodies);

}  // namespace lrb::parting
