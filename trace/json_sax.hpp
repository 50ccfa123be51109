#pragma once
/// What parsers of JSON text share: positions, checks and messages. See json_read.hpp.

#include <string>

#include <nlohmann/json.hpp>

#include "trace/json_read.hpp"

namespace lrb::io {

/// Throws InputError if a text has a NUL byte: nlohmann-json would take it for the end of the text and ignore
/// the rest.
void reject_nul(const std::string& text, const std::string& file);
/// Throws InputError "file:line:column: ..." for a text that nlohmann-json rejected. The arguments are those
/// of nlohmann::json_sax::parse_error().
[[noreturn]] void fail_json(const std::string& text, const std::string& file, std::size_t position,
                            const std::string& token, const nlohmann::json::exception& error);

/// Parses a text. `seen` is the parser's current position whenever it calls `handler`.
void parse_with(const std::string& text, const char*& seen, nlohmann::json_sax<nlohmann::json>& handler);

}  // namespace lrb::io
