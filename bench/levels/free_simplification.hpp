#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lrbscope/lrb_rep.hpp>

namespace lrb::levels {

/// A simplification that need not enclose the body, as far as CGAL measures it.
struct FreeMesh {
  std::uint32_t faces;
  double to_body, from_body;  ///< largest distance of its points from the body, and the reverse; mesh's unit
};

/// Simplifies the real faces to about these numbers of faces (descending), by the program lrbscope-simplify,
/// which is there where CGAL was when this was built. Returns nothing without it, for a 2D body, or if CGAL
/// does not take the mesh.
std::vector<FreeMesh> simplify_freely(const LrbRep& rep, std::span<const std::uint32_t> face_counts);

}  // namespace lrb::levels
