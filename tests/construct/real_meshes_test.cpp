#include <doctest/doctest.h>

#include "engine/construct/closing.hpp"
#include "engine/construct/convex_hull.hpp"
#include "engine/mesh/io/mesh_io.hpp"
#include "tests/construct/build_checks.hpp"
#include "tests/support/shared_meshes.hpp"

namespace lrb::test {
namespace {

using construct::convex_hull;
using construct::volume_of;

TEST_CASE("real models meet the targets: faces, outer faces, volume, embedding") {
  const auto folder = shared_meshes();
  if (folder.empty()) {
    MESSAGE("skipped: no shared meshes (set LRB_MESHES to their directory)");
    return;
  }
  for (const char* name : {"spot", "homer", "fandisk", "cheburashka", "rocker-arm"}) {
    CAPTURE(name);
    const Mesh mesh = read_mesh((folder / (std::string(name) + ".obj")).string());
    const LrbRep rep = build_lrb(mesh);
    check_keeps_mesh(rep, mesh);
    check_valid(rep, 5);
    CHECK(rep.outermost_faces().size() <= 20);
    CHECK(rep.face_count() <= 1.6 * rep.real_face_count());
    Mesh hull;
    hull.vertices = mesh.vertices;
    for (const auto& t : convex_hull(mesh.vertices))
      hull.add_face(std::array{VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
    CHECK(enclosed_volume(rep, rep.outermost_faces()) <= 1.4 * volume_of(hull));
  }
}

}  // namespace
}  // namespace lrb::test
