#pragma once
/// Bodies that make things hard: faces with many corners, vertices with many faces, many pieces.

#include <cstdint>

#include <lrbscope/mesh.hpp>

namespace lrb::hard {

/// An uneven ball of 20 * 4^level triangles: an easy body, to compare.
Mesh rock(std::uint32_t level);

/// A prism over a regular polygon: two faces of n corners, at z = 0 and 1, and n quads.
Mesh drum(std::uint32_t n);
/// The same over a star of n corners, every other one nearer to the middle: its two large faces are concave.
Mesh cog(std::uint32_t n);
/// A prism over a square with n / 4 corners on each side: straight sides with corners in their middle.
Mesh fine_box(std::uint32_t n);
/// n triangles from an apex to a ring, and one face of n corners below.
Mesh cone(std::uint32_t n);
/// n triangles from an apex to a ring, and n to another apex.
Mesh bipyramid(std::uint32_t n);
/// The same with a ring that goes up and down and in and out: neither half is convex.
Mesh crown(std::uint32_t n);
/// n triangles about the middle of a disk: open.
Mesh fan_disk(std::uint32_t n);
/// A cone cut off near its apex: n long narrow quads, closer together at one end.
Mesh frustum(std::uint32_t n);

/// Balls, each in the one before, facing outward and inward by turns.
Mesh nested(std::uint32_t depth);
/// Balls in a row.
Mesh pieces(std::uint32_t count);
/// A plate of n x n quads on either side.
Mesh tiles(std::uint32_t n);

}  // namespace lrb::hard
