#pragma once

#include <span>
#include <string>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb::run {

/// Says what regions are: of one, its layer, lids, floor, parent and neighbours; of several, how many there
/// are. `owner`: behind a region's number, such as " of A".
std::string region_words(const LrbRep& rep, std::span<const RegionId> regions, const std::string& owner);

}  // namespace lrb::run
