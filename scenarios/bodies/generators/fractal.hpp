#pragma once
/// The fractal bodies of the paper's section 4: a basic shape to which local detail is added again and again,
/// as dents under lids. The regions are known by construction, so that no builder is needed.

#include <cstdint>
#include <span>
#include <string>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::generators {

struct FractalSpec {
  std::string name = "fractal";
  std::uint32_t real_faces = 2004;
  std::uint32_t total_faces = 2532;  ///< real and pseudo
  std::uint64_t seed = 1;
};

/// Makes a body with exactly these numbers of faces. Its outermost wrapper is the basic shape's, a prism over
/// a pentagon (7 faces); its size is about 2. It is closed and free of self-intersections (a dent stays
/// within the room that its face's edges leave it; tests prove it exactly for the paper's bodies). All
/// coordinates are integer multiples of one power of two, so that corners of one face are coplanar in double
/// arithmetic, and so are lids and the rims they cover.
///
/// Every dent turns one face into a lid (a pseudo face) and adds 3 to 11 faces, so that the numbers have to
/// fit: throws InputError if they do not ((real_faces - 7) / pseudo faces must be between 2.5 and 7).
LrbRep fractal_body(const FractalSpec& spec);

/// Returns the paper's table 1: objects A to H.
std::span<const FractalSpec> paper_objects();

}  // namespace lrb::generators
