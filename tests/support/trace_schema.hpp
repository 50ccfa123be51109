#pragma once

#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/json_schema.hpp"

namespace lrb::test {

/// Returns the published schema of traces.
inline const nlohmann::json& trace_schema() {
  static const nlohmann::json schema =
      nlohmann::json::parse(std::ifstream(LRB_SOURCE_DIR "/trace/schema/trace.schema.json"));
  return schema;
}

/// Returns what it finds wrong with a document; empty if nothing.
inline std::string trace_faults(const nlohmann::json& document) {
  return schema_faults(trace_schema(), document);
}

}  // namespace lrb::test
