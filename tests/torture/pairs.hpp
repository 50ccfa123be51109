#pragma once

#include <cstdint>

namespace lrb::torture {

/// `count` pairs of degenerate triangles in space, and a fifth as many of segments in the plane, tested
/// exactly in several roles and orders of corners, and compared with the rational oracle and CGAL: prints a
/// table, a row for each kind of degeneracy. The number of disagreements.
std::uint64_t torture_pairs(std::uint64_t count, std::uint64_t seed, unsigned jobs);

}  // namespace lrb::torture
