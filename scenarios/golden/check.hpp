#pragma once
/// Compares a run with what was approved, on the levels that the golden asks for: answers, events and
/// counters exactly; pictures by hash and, if that differs, within a tolerance: what processors differ by.

#include <optional>
#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

/// Makes a run the golden. Leaves files alone that say the same already; where a picture has changed, removes
/// its old variants. With `variant` the trace must be the approved one already, and pictures that differ are
/// put beside the approved ones. Returns what was done, a line for each file; throws InputError.
std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, const std::string& variant);

struct ImageVerdict {
  std::string file;  ///< the approved picture that comes nearest; for a frame that has none, its own name
  bool passed = false;
  bool equal = false;       ///< in every pixel
  std::string text;         ///< one line: by how much it differs, and what moved or changed
  std::size_t frame = 0;    ///< index into GoldenRun::frames and Golden::frames
  std::size_t variant = 0;  ///< index into Golden::frames[frame]; meaningless if has_expected is false
  bool has_expected = false, has_actual = false;
};

struct GoldenVerdict {
  std::string rejection;        ///< why it could not be tested at all; everything else is empty then
  std::vector<Effect> effects;  ///< what came out otherwise: answers and counters
  bool answers_differ = false;  ///< and answers are compared
  std::optional<trace::Divergence> divergence;  ///< nothing if events are not compared
  std::string diagnosis;  ///< what was swapped, lost or added at the divergence; may be empty
  std::vector<ImageVerdict> images;
  std::vector<std::string> causes;  ///< what may be behind a failure; none if it passed
  bool images_passed() const;
  bool passed() const { return rejection.empty() && !answers_differ && !divergence && images_passed(); }
};

GoldenVerdict check_golden(const Golden& golden, const GoldenRun& run);

// Finds what may be behind a difference from what was approved: another scenario, other bodies, or neither.

/// Returns one line for each thing that is not as it was approved and that what follows depends on: the
/// scenario's file, a body's mesh, how its LRB-rep was built, the request, a pose, the version of lrbscope.
std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run);

/// Tells what happened at a divergence from the events that follow it in its step: events swapped, lost,
/// added or replaced. Returns one line; empty if it is not about an event.
std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence);

}  // namespace lrb::golden
