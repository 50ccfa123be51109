#include "tests/fuzz/feed.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::fuzz {

bool feed_mesh(std::string_view bytes) {
  static constexpr const char* kNames[] = {"m.obj", "m.stl", "m.ply", "m.off"};
  static constexpr std::size_t kSmall = 40;  // faces: the check of every pair must not slow the fuzzer down
  if (bytes.empty()) return false;
  const std::string name = kNames[static_cast<unsigned char>(bytes[0]) % std::size(kNames)];
  return accepted(name, [&] {
    Mesh mesh = read_mesh(std::string(bytes.substr(1)), name);
    const MeshReport report = check_mesh(mesh, mesh.face_vertices.size() <= 4 * kSmall);
    static_cast<void>(report.lines(mesh));
    if (report.when_turned().buildable()) orient_outward(mesh);
  });
}

}  // namespace lrb::fuzz
