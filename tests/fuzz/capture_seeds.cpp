#include "tests/fuzz/seeds.hpp"

#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>

namespace lrb::fuzz {
namespace {

int append(void* user, const void* bytes, std::uint64_t size) {
  static_cast<std::string*>(user)->append(static_cast<const char*>(bytes), size);
  return 1;
}

std::string recorded(std::uint32_t volume, const std::uint32_t* ids) {
  std::string out;
  LRBCAP_OPEN_SINK("e", append, &out);
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, numbers[36] = {0.5, 1}, directions[] = {1, 0, 0, 0, 1, 1};
  const float floats[36] = {0.25F, 1};
  const std::uint32_t corners[] = {0, 1, 2, 0, 2, 1}, first_child[] = {0, 2, 2, 2}, child[] = {1, 2},
                      first_prim[] = {0, 0, 1, 2}, prim[] = {0, 1};
  lrbcap_tree tree{};
  tree.mesh = LRBCAP_MESH("m", 3, xyz, 2, corners);
  tree.nodes = 3;
  tree.volume = volume;
  tree.directions = volume == LRBCAP_KDOP ? 2 : 0;
  tree.ids = ids;
  tree.first_child = first_child;
  tree.child = child;
  tree.first_prim = first_prim;
  tree.prim = prim;
  tree.volumes = ids == nullptr ? numbers : nullptr;
  tree.float_volumes = floats;
  tree.direction = directions;
  const std::uint32_t a = LRBCAP_TREE(&tree), name = LRBCAP_NAME("n");
  const auto id = [&](std::uint32_t node) { return ids == nullptr ? node : ids[node]; };
  for (const std::uint32_t b : {a, 0u}) {
    LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a, nullptr, b, nullptr);
    LRBCAP_PHASE(name);
    LRBCAP_NODE(id(0), id(0), 1, LRBCAP_NO_AXIS);
    LRBCAP_NODES(id(1), id(2), 4, 2, 7);
    LRBCAP_PRIM(1, 0, 0);
    LRBCAP_COUNT(name, 70000);
    LRBCAP_END(LRBCAP_INTERSECTING, 1);
  }
  LRBCAP_CLOSE();
  return out;
}

}  // namespace

std::vector<std::string> captures() {
  static constexpr std::uint32_t kIds[] = {7, 300, 5};
  return {recorded(LRBCAP_AABB, nullptr), recorded(LRBCAP_KDOP, kIds), '\1' + recorded(LRBCAP_SPHERE, kIds)};
}

}  // namespace lrb::fuzz
