#pragma once

#include <string>
#include <string_view>

#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// The version of the file format that save_lrb writes, and the newest that load_lrb reads.
inline constexpr std::uint32_t kLrbFileVersion = 3;

/// Writes an LRB-rep to a binary file (`.lrb`): magic, version, the arrays of LrbData, each preceded by its
/// length, their hash, the query's tree, the levels if they were made (LrbRep::levels()), and a checksum of
/// everything before it (lrb_checksum()); little-endian. Version 2 had no levels; version 1 had neither hash
/// nor tree, and FNV-1a as its checksum. The file appears whole or not at all. Throws EnvironmentError or
/// InputError as AtomicFile does.
void save_lrb(const LrbRep& rep, const std::string& path);

/// Reads an LRB-rep from a `.lrb` file of this version or an older one. If the checksum is right, trees are
/// trusted to be those that were stored: their structure is checked, their bounds only by validate(). So are
/// levels: which faces each has follows from how thick its regions are said to be, and it is checked that it
/// encloses the body; that no region is thicker is found by validate() alone. A file that lies about it gets
/// an error bound that is too small, never a wrong relation. Throws InputError if the file is damaged, cut
/// short, of a newer version or not a `.lrb` file at all. Lengths are checked against the file's size before
/// memory is allocated.
LrbRep load_lrb(const std::string& path);

/// Does the same from memory; `name` stands for the file in messages.
LrbRep load_lrb(std::string_view bytes, const std::string& name);

/// Returns the checksum that a file of this version holds in its last eight bytes, computed over the bytes
/// before.
std::uint64_t lrb_checksum(std::string_view bytes, std::uint32_t version = kLrbFileVersion);

/// Returns true if bytes begin like a `.lrb` file.
bool looks_like_lrb(std::string_view bytes);

}  // namespace lrb
