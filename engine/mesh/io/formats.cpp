// Format detection by content, with the file's extension as a fallback. The order matters: the size of a
// binary STL is the most specific evidence, then keywords, then known other formats, which are rejected by
// name. The extension decides the remaining cases.
#include "engine/mesh/io/formats.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/mesh/io/scan.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kAdvice = "export the mesh as OBJ, STL, PLY or OFF";

struct Lookalike {
  std::string_view start;  ///< in lower case
  std::string_view what;
};

/// Signatures of files that are often mistaken for meshes.
constexpr std::array<Lookalike, 20> kLookalikes = {{
    {"<!doctype html"sv, "an HTML page (a failed download?)"},
    {"<html"sv, "an HTML page (a failed download?)"},
    {"<?xml"sv, "XML (COLLADA, X3D or an error page?)"},
    {"version https://git-lfs"sv, "a Git LFS pointer (run git lfs pull)"},
    {"\xff\xfe"sv, "UTF-16 text (save it as UTF-8)"},
    {"\xfe\xff"sv, "UTF-16 text (save it as UTF-8)"},
    {"pk\x03\x04"sv, "a ZIP archive (3MF, or a packed mesh: unpack it)"},
    {"\x1f\x8b"sv, "gzip data (unpack it)"},
    {"bzh"sv, "bzip2 data (unpack it)"},
    {"\xfd"
     "7zxz"sv,
     "xz data (unpack it)"},
    {"gltf"sv, "binary glTF"},
    {"{"sv, "JSON (glTF, a scenario?)"},
    {"kaydara fbx"sv, "FBX"},
    {"blender"sv, "a Blender file"},
    {"\x89png"sv, "a PNG image"},
    {"%pdf"sv, "a PDF document"},
    {"\x7f"
     "elf"sv,
     "a program"},
    {"# vtk datafile"sv, "VTK"},
    {"$meshformat"sv, "Gmsh"},
    {"iso-10303-21"sv, "STEP"},
}};

constexpr std::array<std::string_view, 18> kObjKeywords = {"v",      "vn",     "vt", "vp", "f",      "l",
                                                           "p",      "o",      "g",  "s",  "mtllib", "usemtl",
                                                           "usemap", "maplib", "mg", "fo", "cstype", "deg"};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

[[noreturn]] void reject(std::string_view name, std::string_view found, std::string_view advice = kAdvice) {
  throw InputError(printable_name(name) + ":1: found " + std::string(found) +
                   ", expected an OBJ, STL, PLY or OFF mesh; " + std::string(advice));
}

std::optional<std::string_view> looks_like(std::string_view bytes) {
  static constexpr std::size_t kLongest = 32;
  // Compared with and without leading blanks, because binary signatures may begin with any byte.
  const std::size_t text = bytes.find_first_not_of(" \t\r\n");
  const std::string raw = lower(bytes.substr(0, kLongest)), start = lower(bytes.substr(text, kLongest));
  for (const Lookalike& l : kLookalikes)
    if (raw.starts_with(l.start) || start.starts_with(l.start)) return l.what;
  return std::nullopt;
}

/// Returns true for UTF-16 without a byte order mark: every second byte of ASCII is zero.
bool is_utf16_without_mark(std::string_view bytes) {
  // Two characters are enough: ASCII and zero bytes alternate.
  if (bytes.size() < 4) return false;
  return (bytes[0] != 0 && bytes[1] == 0 && bytes[2] != 0 && bytes[3] == 0) ||
         (bytes[0] == 0 && bytes[1] != 0 && bytes[2] == 0 && bytes[3] != 0);
}

bool is_text(std::string_view bytes) {
  static constexpr std::size_t kSample = 1024;
  const std::string_view sample = bytes.substr(0, kSample);
  // Bytes above 127 count as text: names and comments may be in UTF-8 or Latin-1.
  return std::none_of(sample.begin(), sample.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\v' &&
           c != '\f';
  });
}

bool is_number(std::string_view token) {
  return !token.empty() && token.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
}

}  // namespace

std::string extension_of(std::string_view path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return lower(extension.empty() ? extension : extension.substr(1));
}

bool has_mesh_extension(std::string_view path) {
  constexpr std::array kExtensions = {"obj"sv, "stl"sv, "ply"sv, "off"sv};
  return std::find(kExtensions.begin(), kExtensions.end(), extension_of(path)) != kExtensions.end();
}

MeshFormat tell_format(std::string_view bytes, std::string_view name) {
  const std::string extension = extension_of(name);
  // The header of a binary STL may begin with "solid", so its size is tested before that keyword.
  if (has_size_of_binary_stl(bytes)) return MeshFormat::stl_binary;
  if (bytes.find_first_not_of(" \t\r\n\v\f") == std::string_view::npos)
    reject(name, bytes.empty() ? "an empty file" : "only white space", "export or copy the file again");

  // First token with and without "#" comments, which PLY and STL do not have.
  const std::string_view first = TextCursor(bytes, name, {.hash_comments = true}).any_token();
  const std::string_view first_of_all = TextCursor(bytes, name, {}).any_token();
  if (first_of_all == "ply") return MeshFormat::ply;
  // A binary STL of a wrong size may also begin with "solid"; its reader reports the sizes.
  if (lower(first_of_all) == "solid") return is_text(bytes) ? MeshFormat::stl_ascii : MeshFormat::stl_binary;
  if (parse_off_header(first)) return MeshFormat::off;
  // Unsupported formats are named in the message.
  if (const auto what = looks_like(bytes)) reject(name, *what);
  if (is_utf16_without_mark(bytes)) reject(name, "UTF-16 text (save it as UTF-8)");
  // Binary data: only the extension is left as evidence.
  if (!is_text(bytes)) {
    if (extension == "stl") return MeshFormat::stl_binary;
    if (extension != "obj") reject(name, "binary data of an unknown format");
  }
  if (first.empty()) reject(name, "only comments", "export or copy the file again");
  // OBJ has no signature, so its first statement identifies it.
  if (std::find(kObjKeywords.begin(), kObjKeywords.end(), first) != kObjKeywords.end())
    return MeshFormat::obj;
  if (extension == "obj") return MeshFormat::obj;  // the OBJ reader reports the invalid line
  if (extension == "off" && is_number(first)) return MeshFormat::off;  // the keyword OFF is optional
  reject(name, "text that begins with " + in_quotes(first));
}

}  // namespace lrb
