#pragma once

#include <cstdint>

namespace lrb::torture {

/// First contacts of `count` motions: straight through, screws, many turns within a motion, along each
/// other's surfaces, from contact, thin sheets at any speed; each against the exact query at many times.
/// Prints a table, a row for each pair of bodies. The number of wrong answers.
std::uint64_t torture_sweeps(std::uint64_t count, std::uint64_t seed, unsigned jobs);

}  // namespace lrb::torture
