#pragma once
/// The pieces of two surfaces: inside, outside or on the other solid.

#include <array>
#include <optional>

#include "engine/query/clash/clash.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb::parting {

/// Counts the pieces, exactly. `result`: all pairs of intersecting simplices. Returns nullopt, and sets
/// `reason` unless it is null, if a body is not closed or intersects itself, if a face that intersects the
/// other body has no area, or if exact::CutFace gives up.
///
/// A face that intersects the other surface is cut into cells by it, each of which is inside, outside or on
/// the other solid. Cells and uncut faces belong to one piece if they share a part of an edge that is not on
/// the other surface: edges are cut where they intersect it, and a point of each part decides.
/// only_rational: cut all faces in rational arithmetic, not only those that are not simple; same answer.
std::optional<std::array<SurfacePieces, 2>> surface_pieces(QueryContext& context, const CollideResult& result,
                                                           bool only_rational = false,
                                                           ClashReason* reason = nullptr);

}  // namespace lrb::parting
