/// inspect --draw: the faults of a mesh that are marked. The pictures: tests/commands/inspect.txt.

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/faulty_meshes.hpp"
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::test {

using namespace shapes;

TEST_CASE("faults with the same elements are drawn once") {
  const Mesh doubled = with_doubled(icosphere(1), {3, 9});  // they also meet
  CHECK(render::findings::kinds(check_mesh(doubled)) ==
        std::vector{MeshFault::duplicate_face, MeshFault::non_manifold_edge});
  const Mesh collapsed = with_face(icosphere(1), {}, {0, 0, 1});
  CHECK(render::findings::kinds(check_mesh(collapsed)) == std::vector{MeshFault::zero_area_face});
  CHECK(render::findings::kinds(check_mesh(icosphere(1))).empty());
}

}  // namespace lrb::test
