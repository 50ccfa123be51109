#pragma once

#include <string>
#include <string_view>

namespace lrb {

/// Returns the contents of a file. Throws InputError if it is missing, a directory, a device or unreadable.
std::string read_file(const std::string& path);

/// Returns `text` in single quotes for use in a message: control characters and bytes beyond printable ASCII
/// appear as \xNN, and what follows the first `limit` characters is cut off. The message stays on one line
/// whatever a file contains.
std::string quoted(std::string_view text, std::size_t limit = 40);

/// Returns a file's name for the front of a message: as given, but on one line.
std::string printable_name(std::string_view name);

}  // namespace lrb
