#pragma once
/// JSON Schema (draft 7) by an independent validator, compiled once for all tests that ask it.

#include <string>

#include <nlohmann/json.hpp>

namespace lrb::test {

/// Returns what a schema finds wrong with a document, a line each, "place: what"; empty if nothing.
/// `referred` is the schema that any $ref to another file leads to.
std::string schema_faults(const nlohmann::json& schema, const nlohmann::json& document,
                          const nlohmann::json& referred = {});

}  // namespace lrb::test
