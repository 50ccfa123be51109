#pragma once

#include <string>
#include <string_view>

namespace lrb {

/// The whole file. InputError if it is missing, a directory or unreadable.
std::string read_file(const std::string& path);

/// `text` for a message: control characters and bytes beyond ASCII's printable ones as \xNN, cut after
/// `limit` characters, in single quotes. A message stays one line whatever a file contains.
std::string quoted(std::string_view text, std::size_t limit = 40);

/// A file's name for the front of a message: as given, on one line.
std::string printable_name(std::string_view name);

}  // namespace lrb
