#pragma once

#include <span>
#include <vector>

#include "engine/core/ids.hpp"

namespace lrb {

class LrbRep;

/// Returns one vertex of each connected piece of the given faces, in the order of the faces. Faces joined by
/// a vertex count as one piece.
std::vector<VertexId> piece_vertices(const LrbRep& rep, std::span<const FaceId> faces);

}  // namespace lrb
