#pragma once
/// LRB-reps small enough to know by heart, made without a builder.

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::shapes {

/// Returns a box [0, 4] x [0, 4] x [0, 2] whose top has a dent [1, 3] x [1, 3], 1 deep, under a lid: one
/// region of volume 4. Triangles; real volume 28, outermost wrapper 32.
LrbRep dented_box();

/// Returns a staircase in the plane under two nested lids: region 1 (layer 1) hides region 0 (layer 0).
/// Segments; real area 10, 10.5 with region 0, 16 with both.
LrbRep stairs_2d();

}  // namespace lrb::shapes
