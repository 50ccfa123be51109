#pragma once

#include <filesystem>
#include <limits>

#include "scenarios/io/json/json_node.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

/// The largest integer that every reader of JSON can hold.
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::int64_t>::max();

/// Reads a body of a scenario or an experiment. Files are looked up in `folder`; `seed` is for what does not
/// name one.
BodySpec read_body(const io::JsonNode& node, const std::filesystem::path& folder, std::uint64_t seed);

/// Reads the "query" part of a scenario, with what else is asked of steps where there is a place for it.
/// Refuses what the engine cannot give together.
CollideRequest read_query(const io::JsonNode& node, StepQuestions* more = nullptr);

/// Reads a name that a folder can have.
std::string read_name(const io::JsonNode& node);

}  // namespace lrb::spec
