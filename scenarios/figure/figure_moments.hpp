#pragma once
/// Which states of a run a figure shows.

#include <cstdint>
#include <string>
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

/// The largest number of panels of a figure that chooses them itself.
inline constexpr std::size_t kMostPanels = 26;

struct Chosen {
  std::vector<trace::EventId> events;  ///< after which the states stand, ascending, each once
  std::string left_out;                ///< what was asked for and is not among them; empty: nothing
};

/// Chooses the states. Of more than kMostPanels layers it takes so many evenly, the first and the last among
/// them. Throws InputError for numbers that the run does not have, and for choices that it cannot offer.
Chosen choose(const run::RecordedRun& recorded, const Choice& choice);

}  // namespace lrb::figure
