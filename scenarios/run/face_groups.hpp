#pragma once
/// Groups of a body's faces, and sums over them.

#include <cstdint>
#include <vector>

#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

/// Returns the region that a face belongs to, one that covers a real face or that a pseudo face hides; kNull:
/// none.
std::uint32_t region_of(const LrbRep& rep, FaceId face);

/// Returns a face's level, the number of regions between it and the outside.
std::uint32_t level_of(const LrbRep& rep, FaceId face);

/// Returns, for each face (|F|), the sum of the values over its region or its level; a face without a region
/// keeps its own.
std::vector<double> grouped(std::vector<double> values, render::FrameSpec::ColourPer per, const LrbRep& rep);

}  // namespace lrb::run
