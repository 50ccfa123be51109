#pragma once
/// Writes a minimised case as a counterexample: the files of save_case(), a picture, and a text for the issue
/// tracker of the engine.

#include <string>
#include <vector>

#include "bench/stability/minimise.hpp"
#include "bench/workers/workers.hpp"

namespace lrb::stability {

struct Counterexample {
  Minimised found;  ///< its record names the case that was minimised
  workers::WorkerMethod method;
  std::string command;  ///< that makes it again
};

/// Returns the failure in words: "misses a pair of triangles that cross".
std::string failure_text(const Counterexample& c);

/// Returns the text for the tracker, in Markdown: the function called, the meshes, the right answer with its
/// proof, the engine's answer, and versions.
std::string tracker_text(const Counterexample& c);

/// Returns a program in C++ that shows the failure with the engine alone, or an empty string for
/// other methods than FCL's.
std::string program_text(const Counterexample& c);

/// Writes the files of save_case(), report.md, picture.png and, for FCL, fcl.cpp. Returns their names.
std::vector<std::string> save_counterexample(const Counterexample& c, const std::string& folder);

}  // namespace lrb::stability
