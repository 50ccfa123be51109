#pragma once

#include <string>
#include <string_view>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// Version of the file form that save_lrb writes, and the newest that load_lrb reads.
inline constexpr std::uint32_t kLrbFileVersion = 2;

/// Writes an LRB-rep as a binary file (`.lrb`): magic, version, the arrays of LrbData each with its length,
/// their hash, the query's tree, and a checksum over all of it (lrb_checksum()); little-endian. Version 1 had
/// neither hash nor tree, and FNV-1a as its checksum. The file appears whole or not at all
/// (EnvironmentError).
void save_lrb(const LrbRep& rep, const std::string& path);

/// Reads one back, of this version or an older one. The tree of a file whose checksum is right is believed to
/// be the one that was stored: its structure is checked, its bounds only by validate(). InputError if it is
/// damaged, cut short, of a newer version or not a `.lrb` at all; lengths are checked against the file's size
/// before memory is taken.
LrbRep load_lrb(const std::string& path);

/// The same from memory; `name` stands for the file in messages.
LrbRep load_lrb(std::string_view bytes, const std::string& name);

/// The checksum that a file of this version has in its last eight bytes, over those before.
std::uint64_t lrb_checksum(std::string_view bytes, std::uint32_t version = kLrbFileVersion);

/// Whether bytes begin like a `.lrb` file.
bool looks_like_lrb(std::string_view bytes);

}  // namespace lrb
