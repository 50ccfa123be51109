#pragma once
/// The tables of fields of the experiment's records and settings.

#include "engine/core/fields.hpp"
#include "scenarios/bodies/resolutions/resolutions.hpp"
#include "scenarios/paper/protocol.hpp"

namespace lrb {

template <>
inline constexpr auto kFields<paper::PaperProtocol> =
    std::tuple{field("collisions", &paper::PaperProtocol::collisions),
               field("time_step_of_diagonal", &paper::PaperProtocol::step),
               field("steps_after_first_contact", &paper::PaperProtocol::steps_after),
               field("seed", &paper::PaperProtocol::seed)};
static_assert(covers_all_fields<paper::PaperProtocol>);

/// Without the time that a recursion took, which is never the same again and has a file of its own.
template <>
inline constexpr auto kFields<paper::RecursionCount> =
    std::tuple{field("comparisons", &paper::RecursionCount::comparisons),
               field("refinements", &paper::RecursionCount::refinements),
               field("pairs", &paper::RecursionCount::pairs), field("missed", &paper::RecursionCount::missed),
               field("bound_tests", &paper::RecursionCount::bound_tests)};

/// Without `least_faces`, which experiments leave as it is.
template <>
inline constexpr auto kFields<resolutions::ResolutionOptions> =
    std::tuple{field("resolutions", &resolutions::ResolutionOptions::most),
               field("subdivisions", &resolutions::ResolutionOptions::subdivisions)};

}  // namespace lrb
