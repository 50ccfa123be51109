#pragma once
/// Runs all collisions of the experiment, distributed over threads and, as shards, over processes and
/// machines. The result of a collision does not depend on the distribution.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/bodies/resolutions.hpp"
#include "scenarios/paper/protocol.hpp"
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::paper {

struct PaperObject {
  std::string name;
  LrbRep rep;
  std::string draws = {};  ///< the object whose directions and rotations it uses; empty: its own
};

/// Part `index` of `count`: the collisions with number mod count = index, numbered over all objects.
struct Shard {
  std::uint32_t index = 0, count = 1;
};

/// One collision of a sweep.
struct CollisionTask {
  const PaperObject &a, &x;
  const PaperProtocol& protocol;
  std::uint32_t collision;
  bool scalable_only = false;  ///< only the recursions of kScalable
};
std::vector<ContactStep> run(const CollisionTask& task, Workspace& workspace);

struct SweepOptions {
  PaperProtocol protocol;
  Shard shard;
  std::uint32_t jobs = 1;      ///< number of threads
  bool scalable_only = false;  ///< only the recursions of kScalable
  /// Called for each collision, from several threads; run(), or what an earlier run() of it returned.
  std::function<std::vector<ContactStep>(const CollisionTask&, Workspace&)> runner = run;
};

/// Collides objects[0] with each of the others, with the first seed; returns the steps in the order (object,
/// collision, step).
std::vector<ContactStep> run_sweep(std::span<const PaperObject> objects, const SweepOptions& options);
/// The same with all seeds of the protocol.
std::vector<ContactStep> run_seeds(std::span<const PaperObject> objects, const SweepOptions& options);

/// Returns the protocols of the report's part `settings`: other time steps, each with twice as many steps
/// after the first contact, and the first seed.
std::vector<PaperProtocol> other_settings(const PaperProtocol& protocol);

/// Returns one JSON object on a line for each step; with the times, which are not reproducible, on request.
std::string to_json_lines(std::span<const ContactStep> steps, bool times = false);
/// Parses them; throws InputError that names `file` and the line.
std::vector<ContactStep> read_json_lines(const std::string& text, const std::string& file);
/// Returns the steps of several sweeps in order.
std::vector<ContactStep> sorted(std::vector<ContactStep> steps);

// Repeats single collisions of the sweep by the paper's recursion and records every event.

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
/// recursion over their counted time steps; the first on a tie. Throws InputError if the object has no
/// collision.
std::array<std::uint32_t, 2> easiest_and_hardest(std::span<const ContactStep> steps,
                                                 const std::string& object);

/// Repeats a collision.
CloseUp close_up(const PaperPair& pair, std::uint32_t collision, const PaperProtocol& protocol);

// A run keeps its finished collisions in a file: a line, the head, that describes the run, and one for each
// collision. An interrupted run is continued from it, and the files of all shards together are a run.

struct KeptRun {
  Shard shard;
  PaperProtocol protocol;
  resolutions::ResolutionOptions resolutions;  ///< of the series; most = 0: no series
  bool lean = false;                           ///< the series' bodies are built lean (BuildOptions)
};
std::string head_of(const KeptRun& run, std::span<const PaperObject> objects);

struct KeptCollision {
  std::string key;      ///< of the bodies and the protocol
  std::string records;  ///< of its steps, as JSON lines
};
/// Reads a line after the head. Returns nullopt if it is not a collision.
std::optional<KeptCollision> kept_collision(const std::string& line);

/// Reads the files of shards. Returns their common run, as shard 0/1, and their collisions.
/// Throws InputError if one has no head or that of another run, or if they are not all n shards, once each.
std::pair<KeptRun, std::vector<KeptCollision>> read_shards(const std::vector<std::string>& files);

}  // namespace lrb::paper
