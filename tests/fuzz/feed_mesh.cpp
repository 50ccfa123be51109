#include "tests/fuzz/choices.hpp"
#include "tests/fuzz/feed.hpp"
#include "tests/support/polygon_triangles.hpp"
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
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      std::vector<Eigen::Vector3d> corners;
      for (const VertexId v : mesh.face(f)) corners.push_back(mesh.vertices[v]);
      if (corners.size() <= 3 || corners.size() > kSmall) continue;
      const char* const fault = test::fault_of_triangles(corners);
      judge(fault == nullptr, fault);
    }
    const MeshReport report = check_mesh(mesh, mesh.face_vertices.size() <= 4 * kSmall);
    static_cast<void>(report.lines(mesh));
    if (report.when_turned().buildable()) orient_outward(mesh);
  });
}

}  // namespace lrb::fuzz
