#pragma once
/// The pieces of two surfaces, by where they lie to the other solid.

#include <array>
#include <optional>

#include "engine/query/clash/clash.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb::parting {

/// Counts the pieces, exactly. `result`: all pairs of simplices that meet. Nothing if a body is not closed or
/// intersects itself, if a face that meets the other body has no area, or where exact::CutFace gives up; then
/// `reason`, unless null, is set.
///
/// A face that meets the other surface is cut into cells by it, each of which lies inside, outside or on the
/// other. Cells and whole faces belong to one piece if they share a part of an edge that is not on the other
/// surface: edges are cut where they meet it, and a point of each part decides. only_rational: asks rational
/// arithmetic for all faces, not only for those that are no SimpleCut; the answer is the same.
std::optional<std::array<SurfacePieces, 2>> surface_pieces(QueryContext& context, const CollideResult& result,
                                                           bool only_rational = false,
                                                           ClashReason* reason = nullptr);

}  // namespace lrb::parting
