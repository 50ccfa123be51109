#pragma once

#include <string>
#include <string_view>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Version of the file form that save_lrb writes, and the newest that load_lrb reads.
inline constexpr std::uint32_t kLrbFileVersion = 1;

/// Writes an LRB-rep as a binary file (`.lrb`): magic, version, the arrays of LrbData each with its length,
/// and a checksum over all of it; little-endian. The file appears whole or not at all (EnvironmentError).
void save_lrb(const LrbRep& rep, const std::string& path);

/// Reads one back. InputError if it is damaged, cut short, of a newer version or not a `.lrb` at all; lengths
/// are checked against the file's size before memory is taken.
LrbRep load_lrb(const std::string& path);

/// The same from memory; `name` stands for the file in messages.
LrbRep load_lrb(std::string_view bytes, const std::string& name);

/// Whether bytes begin like a `.lrb` file.
bool looks_like_lrb(std::string_view bytes);

}  // namespace lrb
