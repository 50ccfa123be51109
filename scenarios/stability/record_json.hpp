#pragma once
/// Writes and reads records as JSON Lines: what the experiment leaves behind, and what everything else is
/// counted from.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

nlohmann::ordered_json to_json(const Record& r);
/// Reads a record. Throws InputError that says what is wrong with the value.
Record record_from(const nlohmann::json& value);

/// Returns the records, one on each line.
std::string to_lines(const std::vector<Record>& records);
/// Reads them. Throws InputError that names file and line.
std::vector<Record> read_records(const std::string& path);

}  // namespace lrb::stability
