#include "engine/construct/patch_grow.hpp"

#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"

namespace lrb::construct {
namespace {

/// V - E + F of a set of triangles.
int euler(const FrontMesh& front, const std::vector<FrontMesh::Slot>& slots) {
  std::set<FrontMesh::Corner> vertices;
  std::set<std::pair<FrontMesh::Corner, FrontMesh::Corner>> edges;
  for (const auto s : slots)
    for (int i = 0; i < 3; ++i) {
      vertices.insert(front[s].v[i]);
      edges.insert(std::minmax(front[s].v[i], front[s].v[(i + 1) % 3]));
    }
  return static_cast<int>(vertices.size() + slots.size()) - static_cast<int>(edges.size());
}

void check_patches(const Mesh& mesh, std::uint32_t interior) {
  CAPTURE(mesh.name);
  const FrontMesh front(mesh);
  PatchGrower grower(front, {interior, 4 * interior});
  std::set<FrontMesh::Slot> all;
  Patch patch;
  for (FrontMesh::Corner seed = 0; seed < front.point_count(); ++seed) {
    if (!grower.grow(seed, patch)) continue;
    CHECK(euler(front, patch.slots) == 1);
    CHECK(std::set(patch.ring.begin(), patch.ring.end()).size() == patch.ring.size());
    CHECK(patch.slots.size() == 2 * patch.interior.size() + patch.ring.size() - 2);
    for (std::size_t i = 0; i < patch.ring.size(); ++i) {
      const auto& outside = front[patch.outside[i]];
      const int from = front.index_of(patch.outside[i], patch.ring[(i + 1) % patch.ring.size()]);
      CHECK(outside.v[(from + 1) % 3] == patch.ring[i]);
      CHECK(std::find(patch.slots.begin(), patch.slots.end(), outside.across[from]) != patch.slots.end());
    }
    for (const auto s : patch.slots) {
      CHECK(all.insert(s).second);
      const auto unit = front.unit(s);
      for (auto t = unit.first; t < unit.last; ++t)
        CHECK(std::find(patch.slots.begin(), patch.slots.end(), t) != patch.slots.end());
      grower.take(s);
    }
  }
  CHECK(all.size() * 4 > front.triangle_count());
}

TEST_CASE("patches are disks with a simple ring, of whole polygons, and do not overlap") {
  check_patches(shapes::icosphere(3), 16);
  check_patches(shapes::torus(12, 8), 16);
  check_patches(shapes::torus(4, 3), 8);  // rings close round the tube
  check_patches(shapes::quad_torus(12, 8), 16);
  check_patches(shapes::comb(4), 4);
  check_patches(shapes::tetrahedron(), 16);
  check_patches(shapes::box_with_void(), 16);
}

TEST_CASE("a vertex shared by two fans occurs twice in the front") {
  const Mesh mesh = shapes::voxels(2, 2, 2, [](int x, int y, int z) { return x == y && y == z; });
  const FrontMesh front(mesh);
  CHECK(front.point_count() == mesh.vertices.size() + 1);
  CHECK(front.component_count() == 2);
}

}  // namespace
}  // namespace lrb::construct
