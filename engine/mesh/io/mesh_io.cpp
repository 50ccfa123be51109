#include "engine/mesh/io/mesh_io.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "engine/core/ids.hpp"
#include "engine/mesh/io/file_format.hpp"
#include "engine/mesh/io/readers.hpp"

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

void refuse_without_faces(const Mesh& mesh, std::string_view name) {
  if (mesh.face_count() == 0)
    throw InputError(printable_name(name) + ": found " + std::to_string(mesh.vertices.size()) +
                     " vertices and no face, expected a body's boundary; export the mesh with its faces");
}

Mesh read_mesh(const std::string& bytes, const std::string& name) {
  static constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";
  // A UTF-8 byte order mark in front of the text is skipped.
  std::string_view content = bytes;
  if (content.starts_with(kUtf8Mark)) content.remove_prefix(kUtf8Mark.size());
  Mesh mesh = read_as(tell_format(content, name), content, name);
  mesh.name = printable_name(std::filesystem::path(name).filename().string());
  return mesh;
}

Mesh read_mesh(const std::string& path) {
  return read_mesh(read_file(path), path);
}

}  // namespace lrb
