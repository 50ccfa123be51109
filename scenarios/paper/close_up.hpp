#pragma once
/// Repeats single collisions of the sweep by the paper's recursion and records every event.

#include <array>
#include <span>
#include <string>

#include "scenarios/paper/sweep.hpp"
#include "trace/trace.hpp"

namespace lrb::paper {

/// Two bodies of the experiment.
struct PaperPair {
  const PaperObject &a, &x;
  const LrbRep& rep(Side side) const { return side == Side::a ? a.rep : x.rep; }
  const std::string& name(Side side) const { return side == Side::a ? a.name : x.name; }
};

struct CloseUp {
  std::uint32_t collision = 0;
  std::uint64_t comparisons = 0;   ///< number in all its counted time steps, by the paper's recursion
  std::vector<ContactStep> steps;  ///< with poses
  trace::Trace trace;              ///< of the paper's recursion: each counted step is a time step
};

/// Returns the collisions with this object that took the fewest and the most comparisons of the paper's
/// recursion over their counted time steps; of several, the first. Throws InputError if there is none.
std::array<std::uint32_t, 2> easiest_and_hardest(std::span<const ContactStep> steps,
                                                 const std::string& object);

/// Repeats a collision. Throws InputError if its counts are not those of `records`, which must then come from
/// another experiment.
CloseUp close_up(const PaperPair& pair, std::uint32_t collision, const PaperProtocol& protocol,
                 std::span<const ContactStep> records);

}  // namespace lrb::paper
