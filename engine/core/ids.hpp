#pragma once
/// Index types of the engine. They are plain 32-bit indices into flat arrays; the alias says into which.

#include <cstdint>
#include <limits>

#include "engine/core/enum_words.hpp"

namespace lrb {

using VertexId = std::uint32_t;  ///< into LrbRep::vertices() / Mesh::vertices
using FaceId = std::uint32_t;    ///< a polygon (3D) or a segment (2D); real faces come first, in file order
using SimplexId =
    std::uint32_t;  ///< a triangle of a face's fan (3D) or the segment itself (2D); real ones first
using RegionId = std::uint32_t;  ///< a region of an LRB-rep, 0 .. region_count() - 1

/// A cell of the complex: a RegionId, or one of the two cells that every body has.
using CellId = std::uint32_t;

inline constexpr std::uint32_t kNull = std::numeric_limits<std::uint32_t>::max();
inline constexpr CellId kOutside = kNull - 1;  ///< all of space that no wrapper ever includes
inline constexpr CellId kSolid = kNull - 2;    ///< the body itself, always included
inline constexpr std::uint32_t kMaxId = kNull - 3;

constexpr bool is_region(CellId cell) {
  return cell <= kMaxId;
}

/// Which of the two bodies of a query.
enum class Side : std::uint8_t { a = 0, b = 1 };
constexpr auto words_of(Side) {
  return std::to_array<EnumWord<Side>>({{Side::a, "A"}, {Side::b, "B"}});
}

constexpr Side other(Side s) {
  return s == Side::a ? Side::b : Side::a;
}

}  // namespace lrb
