#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>

#include "engine/error.hpp"
#include "engine/mesh/atomic_file.hpp"
#include "engine/mesh/file_bytes.hpp"
#include "engine/mesh/file_format.hpp"
#include "engine/mesh/mesh_io.hpp"

namespace lrb {
namespace {

template <class T>
void put(AtomicFile& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
  out.write({bytes.data(), bytes.size()});
}

/// The shortest digits that read back as the same double.
void put_number(std::string& line, double x) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr;
  line.append(digits.data(), end);
}

/// The list as MeshLab and Blender expect it, `uchar int`; only corners beyond 255 need a wider count.
void write_ply(const Mesh& mesh, AtomicFile& out) {
  bool wide = false;
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    wide |= mesh.face(f).size() > std::numeric_limits<std::uint8_t>::max();
  out.write("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
            "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
            std::to_string(mesh.face_count()) + "\nproperty list " + (wide ? "uint" : "uchar") +
            " int vertex_indices\nend_header\n");
  for (const Eigen::Vector3d& v : mesh.vertices)
    for (const double x : v) put(out, x);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f);
    if (wide)
      put(out, static_cast<std::uint32_t>(corners.size()));
    else
      put(out, static_cast<std::uint8_t>(corners.size()));
    for (const VertexId v : corners) put(out, static_cast<std::int32_t>(v));
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
    line.assign(1, mesh.dim == 2 ? 'l' : 'f');
    for (const VertexId v : mesh.face(f)) line.append(" ").append(std::to_string(std::uint64_t{v} + 1));
    out.write(line += '\n');
  }
}

}  // namespace

void write_mesh(const Mesh& mesh, const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != "ply" && extension != "obj")
    throw InputError(printable_name(path) + ": found the extension " + quoted(extension) +
                     ", expected ply or obj; choose one of them");
  if (mesh.dim == 2 && extension == "ply")
    throw InputError(printable_name(path) + ": found a 2D body, expected a 3D one for PLY; write it as OBJ");
  AtomicFile out(path);
  extension == "ply" ? write_ply(mesh, out) : write_obj(mesh, out);
  out.commit();
}

}  // namespace lrb
