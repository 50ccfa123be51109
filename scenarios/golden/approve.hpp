#pragma once
/// Approves runs: writes them as goldens, and replaces the files of goldens that differ.

#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"

namespace lrb::golden {

/// Writes the complete golden of a run, which approve_from() approves, into goldens/NAME. Replaces what it
/// wrote before.
void write_golden(const std::string& goldens, const GoldenSpec& spec, const GoldenRun& run);

/// Approves a run as the golden. Does not rewrite files with the same content; where a picture has changed,
/// removes its old variants. Returns one line for each changed file. `dry`: changes nothing, and returns the
/// files that would change. Throws InputError.
std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, bool dry);

/// Adds the differing pictures of a run beside the approved ones. The trace must equal the approved one.
/// Returns and `dry` as approve_golden().
std::vector<std::string> approve_variant(const std::string& goldens, const GoldenRun& run,
                                         const std::string& variant, bool dry);

/// Approves goldens that a test wrote, possibly on another machine: of its output folder, those with these
/// names, or all of them. Throws InputError, before anything is changed, if a file of them is missing or
/// damaged. Returns and `dry` as approve_golden().
std::vector<std::string> approve_from(const std::string& goldens, const std::string& from,
                                      const std::vector<std::string>& names, bool dry);
/// The folder, in the output folder of a test, with the goldens that failures may be approved from.
inline const char* const kApprovable = "approve";

}  // namespace lrb::golden
