#pragma once

#include "bench/cases/families.hpp"

namespace lrb::torture {

/// Gives a case's bodies regions by build_lrb(), where they have none and the mesh can be built and has at
/// most `max_simplices` simplices: the answer must not change. How many bodies got some.
int give_regions(cases::Case& c, cases::RandomEngine& random, std::uint32_t max_simplices);

}  // namespace lrb::torture
