#pragma once
/// The pieces of two surfaces: inside, outside or on the other solid.

#include <array>
#include <optional>

#include "engine/collide/query_context.hpp"
#include <lrbscope/clash.hpp>

namespace lrb {

/// Counts the pieces, exactly. Returns nullopt, and sets `reason`, if a body is not closed or intersects
/// itself, if a face that intersects the other body is degenerate, or if exact::CutFace fails. `result`: all
/// pairs of intersecting simplices.
///
/// A face that intersects the other surface is cut into cells by it. Each cell is inside, outside or on the
/// other solid. Cells and uncut faces belong to the same piece if they share a part of an edge that is not on
/// the other surface: edges are cut where they intersect it, and one point of each part decides.
/// solid_inside, unless null: set to whether a piece inside has its own solid beside it, and not only
/// faces that cancel each other (has_solid_beside()).
std::optional<std::array<SurfacePieces, 2>> surface_pieces(QueryContext& context, const CollideResult& result,
                                                           ClashReason& reason, bool* solid_inside);

}  // namespace lrb
