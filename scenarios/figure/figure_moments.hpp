#pragma once
/// Which states of a run a figure shows.

#include <cstdint>
#include <vector>

#include "scenarios/run/frame_job.hpp"

namespace lrb::figure {

struct Choice {
  /// changes: where the picture changes. One body: in equal steps of the logarithm of the wrapper's faces;
  /// two: by time step, the first contact among them. layers: one body, once all regions of a layer are
  /// refined, and before. faces, events, steps: those nearest to, or of, the numbers given.
  enum class By : std::uint8_t { changes, layers, faces, events, steps } by = By::changes;
  std::vector<std::uint32_t> numbers;
  std::size_t panels = 0;  ///< the most for `changes`; 0: six of one body, four of two
};

/// Returns the events after which the states stand, ascending, each once. Throws InputError for numbers that
/// the run does not have, and for choices that it cannot offer.
std::vector<trace::EventId> choose(const run::RecordedRun& recorded, const Choice& choice);

}  // namespace lrb::figure
