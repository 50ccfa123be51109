#include "tests/fuzz/seeds.hpp"

#define LRBCAP_IMPLEMENTATION
#include "tests/trace/captures.hpp"

namespace lrb::fuzz {
namespace {

std::string recorded(std::uint32_t volume, const std::uint32_t* ids) {
  const capture::Bytes bytes = capture::record([&] {
    const double numbers[36] = {0.5, 1, 0, 1}, directions[] = {1, 0, 0, 0, 1, 1};
    const float floats[36] = {0.25F, 1};
    lrbcap_tree tree = capture::shape_of_tree(capture::a_mesh());
    tree.volume = volume;
    tree.directions = volume == LRBCAP_KDOP ? 2 : 0;
    tree.ids = ids;
    tree.volumes = ids == nullptr ? numbers : nullptr;
    tree.float_volumes = floats;
    tree.direction = directions;
    const std::uint32_t a = LRBCAP_TREE(&tree), name = LRBCAP_NAME("n");
    const std::uint32_t row = volume == LRBCAP_AABB ? capture::a_row(a) : 0;
    const auto id = [&](std::uint32_t node) { return ids == nullptr ? node : ids[node]; };
    for (const std::uint32_t b : {a, 0u}) {
      LRBCAP_RAY(LRBCAP_ANY, a, nullptr, numbers);
      LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a, nullptr, b, nullptr);
      LRBCAP_PHASE(name);
      LRBCAP_NODE(id(0), id(0), 1, LRBCAP_NO_AXIS);
      LRBCAP_NODES(id(1), id(2), 4, 2, 7);
      LRBCAP_PRIM(1, 0, 0);
      LRBCAP_COUNT(name, 70000);
      LRBCAP_END(LRBCAP_INTERSECTING, 1);
      if (row == 0) continue;
      LRBCAP_BEGIN(LRBCAP_ANY, row, nullptr, row, nullptr);
      LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);
      LRBCAP_ENTER(2, LRBCAP_TOP);
      LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);
      LRBCAP_ENTER(3, 0);
      LRBCAP_PRIM(3, 1, 1);
      LRBCAP_END(LRBCAP_INTERSECTING, 1);
    }
  });
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::vector<std::string> captures() {
  static constexpr std::uint32_t kIds[] = {7, 300, 5};
  return {recorded(LRBCAP_AABB, nullptr), recorded(LRBCAP_KDOP, kIds), '\1' + recorded(LRBCAP_SPHERE, kIds)};
}

}  // namespace lrb::fuzz
