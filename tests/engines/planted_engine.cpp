/// planted_engine A B POSES: a program of another engine for the tests of `command:PROGRAM`. Its trees are a
/// root and a leaf for each triangle. If the centres of B and A are less than 0.5 apart it tests all pairs of
/// leaves, otherwise only the roots. $PLANTED makes it fail, the tree of A faulty, or a pair wrong.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#define LRBCAP_IMPLEMENTATION
#include "examples/capture/bodies.hpp"

namespace {

struct Body {
  std::uint32_t triangles, tree;
};

Body read(const char* path, const std::string& planted) {
  const Triangles mesh = read_obj(path);
  const auto n = static_cast<std::uint32_t>(mesh.corners.size() / 3);
  // Children of the root are nodes 1 to n; node i + 1 has triangle i.
  std::vector<Node> nodes(n + 1);
  for (std::uint32_t i = 0; i < n; ++i) {
    nodes[0].children.push_back(i + 1);
    nodes[i + 1].triangles = {i};
  }
  if (planted == "tree") nodes[1].triangles = nodes[2].triangles;
  std::vector<double> boxes;
  for (std::uint32_t i = 0; i <= n; ++i) boxes.insert(boxes.end(), {-9, -9, -9, 9, 9, 9});
  return {n, describe(mesh, path, LRBCAP_AABB, nodes, boxes)};
}

void answer(const Body& a, const Body& b, const Pose& pose, bool wrong_pair) {
  static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a.tree, identity, b.tree, pose.data());
  // Both bodies of the test are centred at 0.
  const bool near = std::hypot(pose[3], pose[7], pose[11]) < 0.5;
  static const std::uint32_t roots = LRBCAP_NAME("roots"), leaves = LRBCAP_NAME("leaves");
  LRBCAP_PHASE(roots);
  LRBCAP_NODE(0, 0, near, LRBCAP_NO_AXIS);
  LRBCAP_PHASE(leaves);
  for (std::uint32_t f = 0; near && f < a.triangles; ++f)
    for (std::uint32_t g = 0; g < b.triangles; ++g) LRBCAP_NODE(f + 1, g + 1, false, LRBCAP_NO_AXIS);
  if (wrong_pair && !near) LRBCAP_PRIM(0, 0, true);
  LRBCAP_END(LRBCAP_SEPARATE, 0);
}

}  // namespace

int main(int argc, char** argv) {
  const char* given = std::getenv("PLANTED");
  const std::string planted = given == nullptr ? "" : given;
  if (argc != 4) return 64;
  if (planted == "fail") {
    std::fprintf(stderr, "first words\nthe planted fault\n");
    return 3;
  }
  if (planted == "crash") std::abort();
  if (planted == "hang") sleep(60);
  if (planted == "nothing") return 0;
  if (planted == "junk") {
    std::ofstream(std::getenv("LRBCAP_OUT")) << "no capture";
    return 0;
  }
  LRBCAP_OPEN("planted engine", NULL);
  const Body a = read(argv[1], planted), b = read(argv[2], "");
  for (Pose pose : read_poses(argv[3])) {
    if (planted == "shift") pose[3] += 1;
    answer(a, b, pose, planted == "pair");
    if (planted == "short") break;
  }
  LRBCAP_CLOSE();
  return 0;
}
