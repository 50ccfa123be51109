#pragma once
/// Tells which format a file is in: its content decides, its extension helps only where the content leaves it
/// open.

#include <cstdint>
#include <string>
#include <string_view>

namespace lrb {

enum class MeshFormat : std::uint8_t { obj, stl_ascii, stl_binary, ply, off };

/// Returns the format. Throws InputError, saying what the content looks like, if it is none of the formats.
MeshFormat tell_format(std::string_view bytes, std::string_view name);

/// Returns the extension in lower case, without the dot; empty if there is none.
std::string extension_of(std::string_view path);

}  // namespace lrb
