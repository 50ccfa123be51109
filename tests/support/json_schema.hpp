#pragma once
/// JSON Schema (draft 7) by an independent validator, compiled once for all tests that ask it.

#include <string>

#include <nlohmann/json.hpp>

#include <lrbscope/enum_names.hpp>

namespace lrb::test {

/// Returns what a schema finds wrong with a document, a line each, "place: what"; empty if nothing.
/// `referred` is the schema that any $ref to another file leads to.
std::string schema_faults(const nlohmann::json& schema, const nlohmann::json& document,
                          const nlohmann::json& referred = {});

/// Returns the words of an enumeration.
template <class Enum>
nlohmann::json words() {
  nlohmann::json out = nlohmann::json::array();
  for (const EnumName<Enum>& entry : kEnumNames<Enum>) out.push_back(entry.name);
  return out;
}

}  // namespace lrb::test
