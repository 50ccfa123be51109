#pragma once
/// The volume that two closed bodies share.

#include "engine/query/clash/clash.hpp"
#include "engine/query/clash/unit_bodies.hpp"

namespace lrb::parting {

/// Returns an interval that holds the volume, in the unit's cube. The bodies must be closed and not intersect
/// themselves.
///
/// Seen along x, a closed surface is a sum of prisms: a point is inside if one more of the triangles above it
/// faces up than down. So the shared volume is the sum over pairs of triangles, one of each body, of the
/// height of the lower one over where both are seen, with the sign of how they face. There is no case that
/// is degenerate, only rounding.
ProvedInterval shared_volume(const UnitBodies& bodies);

}  // namespace lrb::parting
