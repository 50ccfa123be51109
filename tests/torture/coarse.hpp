#pragma once

#include <cstdint>

namespace lrb::torture {

/// `count` coarse queries of bodies near contact, flush ones among them, against the exact query and against
/// distances: prints a table, a row for each pair of bodies. The number of wrong answers.
std::uint64_t torture_coarse(std::uint64_t count, std::uint64_t seed, unsigned jobs);

}  // namespace lrb::torture
