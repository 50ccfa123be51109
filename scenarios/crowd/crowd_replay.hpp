#pragma once
/// Reads a crowd's trace back: enough of it to draw its steps again.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"

namespace lrb::crowd {

struct CrowdTrace {
  /// The answer to one query.
  struct Answer {
    BodyPair bodies{0, 0};
    Relation relation = Relation::separate;
    std::uint64_t pairs = 0, fingerprint = 0;
    friend auto operator<=>(const Answer&, const Answer&) = default;
  };
  std::string file;         ///< for messages
  spec::Crowd crowd;        ///< as far as pictures need it; its steps are those that the trace holds whole
  std::uint32_t steps = 0;  ///< number of steps that were run
  std::vector<trace::BodyInfo> bodies;       ///< one for each kind
  std::vector<std::vector<Pose>> poses;      ///< by whole step and body
  std::vector<std::vector<Answer>> answers;  ///< by whole step, ascending by bodies
};

/// Returns true if a trace says that it is one of a crowd.
bool is_crowd_trace(std::string_view text);

/// Reads what write_crowd_trace() wrote. Throws InputError as trace_from_json() does, and for a trace that
/// holds no whole step; any bytes are safe.
CrowdTrace read_crowd_trace(std::string_view text, const std::string& file);

/// Asks the queries of the whole steps again, for what the trace does not hold (regions that were opened,
/// pairs of faces, contacts), and checks their answers against the trace. `kinds` are the bodies that were
/// recorded; throws InputError if they are others, or if answers differ.
CrowdRun replay_crowd(const CrowdTrace& trace, std::vector<bodies::LoadedBody> kinds, std::uint32_t threads,
                      const run::ProgressReport& progress);

}  // namespace lrb::crowd
