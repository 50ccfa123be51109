#pragma once
/// Writes one case into a folder, so that it can be given to any program: meshes, poses, the right answer
/// with a proof that needs only fractions, and the answers of engines.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/cases/families.hpp"
#include "bench/stability/stability_experiment.hpp"

namespace lrb::stability {

/// Returns the proof of whether two simplices intersect, in exact fractions ("-1/3"): the world coordinates
/// of their corners, and either a common point, or a direction along which all corners of A are before all of
/// B.
nlohmann::ordered_json pair_proof(const cases::Case& c, const SimplexPair& pair);

/// Returns the pair that decides: the first that an engine missed or added, else the first of the right
/// answer. Returns nullopt if there is none.
std::optional<SimplexPair> deciding_pair(const std::vector<Replay>& replays);

/// Writes a.obj and b.obj, a_world.obj and b_world.obj (at their poses, if those are representable as
/// doubles) and case.json. `replays`: of the same case, at least one. Returns the names of the files.
std::vector<std::string> save_case(const cases::Case& c, const std::vector<Replay>& replays,
                                   const std::string& folder);

}  // namespace lrb::stability
