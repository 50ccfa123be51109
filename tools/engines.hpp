#pragma once
/// The options that name two bodies and the engines that are queried about them.

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "bench/tails/engine.hpp"
#include "bench/tails/pose_space.hpp"
#include "tools/commands.hpp"
#include <lrbscope/pose.hpp>

namespace lrb::cli {

struct EngineOptions {
  std::string a, b, command;
  std::vector<std::string> methods;  ///< empty: ours, unless there is a command
  double timeout = 60;
  bodies::Corners corners = bodies::Corners::joined;

  tails::BodyFiles files() const { return {a, b, corners}; }
  std::chrono::duration<double> limit() const { return std::chrono::duration<double>(timeout); }
};

/// Adds --method, --command, --timeout and --no-join.
void add_engine_options(App& app, EngineOptions& options);

/// Two bodies, and the engines that were named.
struct Contest {
  std::unique_ptr<std::array<bodies::LoadedBody, 2>> bodies;
  tails::PoseSpace space;
  std::vector<std::unique_ptr<tails::Engine>> engines;
};

/// Reads the bodies and prepares the engines. Throws InputError for bodies that are not 3D and for an unknown
/// method, and EnvironmentError for an absent one.
Contest make_contest(const EngineOptions& options);

/// The words of the command that records one pose of B, given in a file, into a folder: `xray` for engines
/// that it records, `import` of a capture for a --command, else `collide`.
std::vector<std::string> record_words(const EngineOptions& options, const std::string& engine,
                                      const std::string& pose_file, const std::string& folder);

/// Returns the shell command of record_words(); for a --command, after the one that writes the capture.
std::string record_line(const EngineOptions& options, const std::string& engine, const std::string& pose_file,
                        const std::string& folder);

/// Returns a name for files: letters, digits and dashes.
std::string file_word(const std::string& name);

}  // namespace lrb::cli
