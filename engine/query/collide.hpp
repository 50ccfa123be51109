#pragma once
/// The two-body query: finds whether two bodies meet, which real faces do, and how the bodies lie to each
/// other.
///
/// There are two algorithms. `complete` never misses: it descends an OBB tree over real faces whose bounds
/// hold everything beneath, so that every pair that meets is reached, and tests exactly at the leaves (see
/// tree_query.hpp for the proof). `paper` is section 4 of the paper to the letter: recursion through lids
/// that hit. It misses contacts under lids that nothing touches, and is kept to reproduce the paper's figures
/// and to show where it fails.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/enum_words.hpp"
#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/walk/result.hpp"

namespace lrb {

/// Queries body `a` at pose_a against body `b` at pose_b; both must be 3D, or both 2D (else InputError).
/// Poses must be finite, and so must be the world coordinates of every vertex that a face uses (else
/// InputError, naming it). A vertex that no face uses need not, but may be refused where the body comes
/// near 1.8e308. To watch a query: collide_probe.hpp.
CollideResult collide(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                      const CollideRequest& request = {});

}  // namespace lrb
