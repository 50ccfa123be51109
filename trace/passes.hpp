#pragma once
/// The passes of a construction in numbers, from its events.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "trace/counters.hpp"
#include "trace/trace.hpp"

namespace lrb::trace {

/// One pass. Numbers of faces are those of the hull, a polygon counted once.
struct PassSummary {
  EventId first = kNull, last = kNull;  ///< its first event and its last one that is stored
  BuildStage stage = BuildStage::fit;
  std::uint32_t layer = 0;  ///< of the regions that it made
  float most_off = 0;       ///< how far caps may stand off the body, mesh's unit; 0: as far as they like
  float off = 0;            ///< how far the farthest of them does, as it was measured; 0: nobody measured
  std::uint32_t faces_before = 0, faces_after = 0;
  std::uint32_t regions = 0;  ///< that it made
  std::uint32_t merged = 0;   ///< pieces of space that became part of these
  std::uint32_t patches = 0;
  std::uint32_t retried = 0;  ///< patches whose first cap met something, so that another was made with proofs
  std::array<std::uint32_t, kWords<CapVerdict>.size()> caps{};  ///< patches by the verdict on their last cap
  std::uint32_t lids = 0, covered = 0;                          ///< faces of caps that stand, and under them
  std::uint32_t barred = 0, no_patch = 0, waiting = 0;          ///< see PassEnd
  bool given_up = false;                                        ///< see PassEnd

  std::uint32_t accepted() const { return caps[0]; }
  std::uint32_t refused() const { return patches - accepted(); }
  /// Returns the number that people know it by, from 1 on; passes that made nothing have none.
  std::uint32_t number() const { return layer + 1; }
};

/// Returns the passes of a construction, in order; none for other traces.
std::vector<PassSummary> passes_of(const Trace& trace);

/// Returns the number of faces of the hull over the events, from the body's on: at each event that changes
/// it, and at the last.
Chart chart_over_construction(const Trace& trace);
/// Returns curves over the passes: patches that got a cap, and those that did not by the commonest reasons.
Chart chart_over_passes(const Trace& trace);

/// Returns refusals by their reasons, most frequent first: "9 met the hull, 3 too thick".
std::string refusal_words(const std::array<std::uint32_t, kWords<CapVerdict>.size()>& caps);

/// Returns the number of a pass's caps, or of all passes', by verdict.
std::array<std::uint32_t, kWords<CapVerdict>.size()> caps_of(const std::vector<PassSummary>& passes);

}  // namespace lrb::trace
