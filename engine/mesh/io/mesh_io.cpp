// Reading and writing of mesh files.
//
// Format detection by content, with the file's extension as a fallback. The order matters: the size of a
// binary STL is the most specific evidence, then keywords, then known other formats, which are rejected by
// name. The extension decides the remaining cases.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "engine/mesh/io/formats.hpp"
#include "engine/mesh/io/scan.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb {

namespace {

using namespace std::string_view_literals;

enum class MeshFormat : std::uint8_t { obj, stl_ascii, stl_binary, ply, off };

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

/// Returns the extension in lower case, without the dot, or an empty string if there is none.
std::string extension_of(std::string_view path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return lower(extension.empty() ? extension : extension.substr(1));
}

/// Returns the format. Throws InputError with a description of the content if it is none of the formats.
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
  if (off_header_size(first) > 0) return MeshFormat::off;
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

Mesh read_as(MeshFormat format, std::string_view bytes, std::string_view name) {
  switch (format) {
    case MeshFormat::stl_ascii:
      return read_stl_ascii(bytes, name);
    case MeshFormat::stl_binary:
      return read_stl_binary(bytes, name);
    case MeshFormat::ply:
      return read_ply(bytes, name);
    case MeshFormat::off:
      return read_off(bytes, name);
    default:
      return read_obj(bytes, name);
  }
}

}  // namespace

bool has_mesh_extension(std::string_view path) {
  constexpr std::array kExtensions = {"obj"sv, "stl"sv, "ply"sv, "off"sv};
  return std::find(kExtensions.begin(), kExtensions.end(), extension_of(path)) != kExtensions.end();
}

void check_index_limits(std::uint64_t vertices, std::uint64_t corners, std::string_view name) {
  if (vertices > kMaxId || corners > kMaxId)
    throw InputError(printable_name(name) + ": found " + std::to_string(std::max(vertices, corners)) +
                     (vertices > kMaxId ? " vertices" : " corners of faces") + ", expected at most " +
                     std::to_string(kMaxId) + "; simplify or split the mesh");
}

void reject_without_faces(const Mesh& mesh, std::string_view name) {
  if (mesh.face_count() == 0)
    throw InputError(printable_name(name) + ": found " + std::to_string(mesh.vertices.size()) +
                     " vertices and no faces, expected a surface mesh; export the mesh with its faces");
}

Mesh read_mesh(const std::string& bytes, const std::string& name) {
  const FloatMode float_mode;
  static constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
  // Skip a UTF-8 byte order mark.
  std::string_view content = bytes;
  if (content.starts_with(kUtf8Mark)) content.remove_prefix(kUtf8Mark.size());
  Mesh mesh = read_as(tell_format(content, name), content, name);
  mesh.name = printable_name(std::filesystem::path(name).filename().string());
  return mesh;
}

Mesh read_mesh(const std::string& path) {
  return read_mesh(read_file(path), path);
}

namespace {

template <class T>
void put(AtomicFile& out, T value) {
  // PLY is written little-endian on every machine.
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
  out.write({bytes.data(), bytes.size()});
}

/// Appends the shortest text that reads back as the same double.
void put_number(std::string& line, double x) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr;
  line.append(digits.data(), end);
}

/// Returns the header. The face list has the types that MeshLab and Blender expect, `uchar int`; faces with
/// more than 255 corners require a wider count.
std::string ply_header(const Mesh& mesh, bool wide, bool coloured) {
  // Indices are signed as usual, and unsigned only for more than 2^31 - 1 vertices.
  const bool many = mesh.vertices.size() > std::size_t{std::numeric_limits<std::int32_t>::max()};
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text.append("element vertex ").append(std::to_string(mesh.vertices.size()));
  text.append("\nproperty double x\nproperty double y\nproperty double z\n");
  text.append("element face ").append(std::to_string(mesh.face_count()));
  text.append("\nproperty list ").append(wide ? "uint" : "uchar").append(many ? " uint" : " int");
  text.append(" vertex_indices\n");
  if (coloured) text.append("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  return text.append("end_header\n");
}

void write_ply(const Mesh& mesh, std::span<const FaceColour> colours, AtomicFile& out) {
  // The header fixes the type of all counts, so the largest face decides.
  bool wide = false;
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    wide |= mesh.face(f).size() > std::numeric_limits<std::uint8_t>::max();
  out.write(ply_header(mesh, wide, !colours.empty()));
  // Doubles are written unchanged: reading the file restores the same coordinates.
  for (const Eigen::Vector3d& v : mesh.vertices)
    for (const double x : v) put(out, x);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    if (wide)
      put(out, static_cast<std::uint32_t>(corners.size()));
    else
      put(out, static_cast<std::uint8_t>(corners.size()));
    for (const VertexId v : corners) put(out, v);
    if (!colours.empty())
      for (const std::uint8_t c : colours[f]) put(out, c);
  }
}

void write_obj(const Mesh& mesh, AtomicFile& out) {
  std::string line;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    line.assign(1, 'v');
    for (const double x : v) put_number(line += ' ', x);
    out.write(line += '\n');
  }
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    // Segments are line elements (l), polygons faces (f). OBJ indices start at 1.
    line.assign(1, mesh.dim == 2 ? 'l' : 'f');
    for (const VertexId v : mesh.face(f)) line.append(" ").append(std::to_string(std::uint64_t{v} + 1));
    out.write(line += '\n');
  }
}

}  // namespace

void check_mesh_name(const std::string& path, int dim) {
  const std::string extension = extension_of(path);
  if (extension != "ply" && extension != "obj")
    throw InputError(printable_name(path) + ": found the extension " + in_quotes(extension) +
                     ", expected ply or obj; choose one of them");
  if (dim == 2 && extension == "ply")
    throw InputError(printable_name(path) + ": found a 2D body, expected a 3D one for PLY; write it as OBJ");
}

void write_mesh(const Mesh& mesh, const std::string& path, std::span<const FaceColour> face_colours) {
  const FloatMode float_mode;
  check_mesh_name(path, mesh.dim);
  if (!face_colours.empty() && face_colours.size() != mesh.face_count())
    throw InputError(printable_name(path) + ": found " + std::to_string(face_colours.size()) +
                     " colours, expected " + std::to_string(mesh.face_count()) +
                     ", the number of faces; pass one for each face, or none");
  // The file appears atomically at commit().
  AtomicFile out(path);
  extension_of(path) == "ply" ? write_ply(mesh, face_colours, out) : write_obj(mesh, out);
  out.commit();
}

}  // namespace lrb
