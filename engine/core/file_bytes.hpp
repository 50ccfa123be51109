#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lrb {

/// Returns all bytes of a file. Throws InputError if it is missing or unreadable, if it is a directory or the
/// like (what_is_no_file()), or has more than `most` bytes, which are then not read.
std::string read_file(const std::string& path,
                      std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Returns what stands at a path in place of a file that can be read to its end: "a directory", "a device",
/// "a named pipe" (which might wait for ever) or "a socket"; nothing for files, for pipes without a name, as
/// shells make them, and where nothing is. Does not open it.
std::string_view what_is_no_file(const std::string& path);

/// Returns `text` in single quotes for use in a message: control characters and bytes beyond printable ASCII
/// appear as \xNN, and what follows the first `limit` characters is cut off. The message stays on one line
/// whatever a file contains.
std::string in_quotes(std::string_view text, std::size_t limit = 40);

/// Returns a file's name for the front of a message: as given, but on one line.
std::string printable_name(std::string_view name);

}  // namespace lrb
