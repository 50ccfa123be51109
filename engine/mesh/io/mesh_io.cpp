#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "engine/mesh/io/formats.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb {
namespace {

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
