#pragma once

#include <filesystem>
#include <limits>

#include "scenarios/io/json/json_node.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

/// What every JSON reader can hold.
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::int64_t>::max();

/// A body of a scenario or an experiment; files are looked up in `folder`, and `seed` is for whatever has
/// none of its own.
BodySpec read_body(const io::JsonNode& node, const std::filesystem::path& folder, std::uint64_t seed);

/// The "query" part of a scenario. What the engine cannot give together is refused.
CollideRequest read_query(const io::JsonNode& node);

/// A name after which a folder can be called.
std::string read_name(const io::JsonNode& node);

}  // namespace lrb::spec
