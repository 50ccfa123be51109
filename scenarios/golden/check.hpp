#pragma once
/// Compares a run with the approved one, on the levels selected in the golden: answers, events and counters
/// exactly; pictures by hash, then within a tolerance for differences between processors.

#include <optional>
#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

/// Approves a run as the golden. Does not rewrite files with the same content; where a picture has changed,
/// removes its old variants. With `variant` the trace must equal the approved one, and differing pictures are
/// added beside the approved ones. Returns one line for each changed file. `dry`: changes nothing, and
/// returns the files that would change. Throws InputError.
std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, const std::string& variant, bool dry = false);

/// Writes the complete golden of a run, which approve_from() approves, into goldens/NAME. Replaces what it
/// wrote before.
void write_golden(const std::string& goldens, const GoldenSpec& spec, const GoldenRun& run);

/// Approves goldens that a test wrote, possibly on another machine: of its output folder or a ZIP archive of
/// it, those with these names, or all of them. Throws InputError, before anything is changed, if a file of
/// them is missing or damaged. Returns and `dry` as approve_golden().
std::vector<std::string> approve_from(const std::string& goldens, const std::string& from,
                                      const std::vector<std::string>& names, bool dry);
/// The folder, in the output folder of a test, with the goldens that failures may be approved from.
inline const char* const kApprovable = "approve";

struct ImageVerdict {
  std::string file;  ///< the nearest approved picture; for a frame without one, its own name
  bool passed = false;
  bool equal = false;       ///< in every pixel
  std::string text;         ///< one line: the size of the difference, and what moved or changed
  std::string change;       ///< only what moved or changed; may be empty
  std::size_t frame = 0;    ///< index into GoldenRun::frames and Golden::frames
  std::size_t variant = 0;  ///< index into Golden::frames[frame]; meaningless if has_expected is false
  bool has_expected = false, has_actual = false;
};

struct GoldenVerdict {
  std::string rejection;          ///< why the test could not run; all other fields are then empty
  std::vector<Effect> effects;    ///< differences in answers and counters
  bool answers_differ = false;    ///< and answers are compared
  std::vector<Effect> more_work;  ///< find_more_work(); empty if work is not compared
  std::optional<trace::Divergence> divergence;  ///< nullopt if events are not compared
  std::string diagnosis;  ///< the swapped, lost or added events at the divergence; may be empty
  std::vector<ImageVerdict> images;
  std::vector<std::string> causes;  ///< possible causes of a failure; empty if it passed
  std::string group;                ///< equal for failures with equal causes; empty if it passed
  bool images_passed() const;
  bool passed() const {
    return rejection.empty() && !answers_differ && more_work.empty() && !divergence && images_passed();
  }
};

GoldenVerdict check_golden(const Golden& golden, const GoldenRun& run);

// Finds possible causes of a difference from the approved run: a changed scenario, changed bodies, or
// neither.

/// Returns one line for each changed input of the run: the scenario's keys, a body's mesh, how its LRB-rep
/// was built, the request, a pose, the version of lrbscope.
std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run);

/// Describes a divergence by the events that follow it in its step: swapped, lost, added or replaced. Returns
/// one line; empty if the divergence is not at an event.
std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence);

}  // namespace lrb::golden
