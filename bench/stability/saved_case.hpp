#pragma once
/// Writes one case into a folder, so that it can be given to any program: meshes, poses, the right answer
/// with a proof that needs only fractions, and the answers of engines. Reads such folders. Writes a minimised
/// case as a counterexample: the same, a picture, and a text for the issue tracker of the engine.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/cases/families.hpp"
#include "bench/stability/case_meshes.hpp"
#include "bench/stability/minimise.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "bench/workers/workers.hpp"

namespace lrb::stability {

/// Returns the proof of whether two simplices intersect, in exact fractions ("-1/3"): the world coordinates
/// of their corners, and either a common point, or a direction along which all corners of A are before all of
/// B.
nlohmann::ordered_json pair_proof(const cases::Case& c, const SimplexPair& pair);

/// Writes a.obj and b.obj, a_world.obj and b_world.obj (at their poses, if those are representable as
/// doubles) and case.json. `replays`: of the same case, at least one. `minimised`: how the case was made
/// from another; null if it was not. Returns the names of the files.
std::vector<std::string> save_case(const cases::Case& c, const std::vector<Replay>& replays,
                                   const std::string& folder,
                                   const nlohmann::ordered_json* minimised = nullptr);

/// A case of such a folder.
struct SavedCase {
  CaseMeshes meshes;
  Record origin;  ///< family, difficulty, case and seed; an empty family if they are not known
};

/// Reads a.obj, b.obj and the poses in case.json. Throws InputError that names the file and its mistake.
SavedCase load_case(const std::string& folder);

struct Counterexample {
  Minimised found;  ///< its record names the case that was minimised
  workers::WorkerMethod method;
  std::string command;  ///< that makes it again
};

/// Writes the files of save_case(), report.md for the engine's tracker, picture.png and, for FCL, fcl.cpp, a
/// program that shows the failure with the engine alone. Returns their names.
std::vector<std::string> save_counterexample(const Counterexample& c, const std::string& folder);

}  // namespace lrb::stability
