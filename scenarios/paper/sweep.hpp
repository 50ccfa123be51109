#pragma once
/// Runs all collisions of the experiment, distributed over threads and, as shards, over processes and
/// machines. The result of a collision does not depend on who computes it.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/paper/protocol.hpp"

namespace lrb::paper {

struct PaperObject {
  std::string name;
  LrbRep rep;
  std::string draws = {};  ///< the object whose directions and rotations it gets; empty: its own
};

/// Part `index` of `count`: the collisions whose number, counted over all objects, is index modulo count.
struct Shard {
  std::uint32_t index = 0, count = 1;
};

struct SweepOptions {
  PaperProtocol protocol;
  Shard shard;
  std::uint32_t jobs = 1;  ///< number of threads
};

/// Collides objects[0] with each of the others; returns the steps in the order (object, collision, step).
/// `progress(done, of)` is called from one thread at a time.
std::vector<ContactStep> run_sweep(std::span<const PaperObject> objects, const SweepOptions& options,
                                   const std::function<void(std::uint64_t, std::uint64_t)>& progress);

/// Returns one JSON object on a line for each step.
std::string to_json_lines(std::span<const ContactStep> steps);
/// Reads them back; throws InputError that names `file` and the line.
std::vector<ContactStep> read_json_lines(const std::string& text, const std::string& file);
/// Puts the steps of several shards in order. Throws InputError if a step is there twice.
std::vector<ContactStep> merged(std::vector<ContactStep> steps);

}  // namespace lrb::paper
