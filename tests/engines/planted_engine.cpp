/// planted_engine A B POSES: a program of another engine for the tests of `command:PROGRAM`. Its trees are a
/// root and a leaf for each triangle. If the centres of B and A are less than 0.5 apart it tests all pairs of
/// leaves, otherwise only the roots. $PLANTED makes it fail, or the tree of A faulty.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include <unistd.h>

#define LRBCAP_IMPLEMENTATION
#include "lrbscope_capture.h"

namespace {

struct Body {
  std::vector<double> vertices;
  std::vector<std::uint32_t> corners;
  std::uint32_t tree = 0;
  std::uint32_t triangles() const { return static_cast<std::uint32_t>(corners.size() / 3); }
};

Body read(const char* path, const std::string& planted) {
  Body body;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    double x[3];
    unsigned c[3];
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", x, x + 1, x + 2) == 3)
      body.vertices.insert(body.vertices.end(), x, x + 3);
    if (std::sscanf(line.c_str(), "f %u %u %u", c, c + 1, c + 2) == 3)
      for (const unsigned k : c) body.corners.push_back(k - 1);
  }
  const std::uint32_t n = body.triangles();
  const std::uint32_t mesh =
      LRBCAP_MESH(path, body.vertices.size() / 3, body.vertices.data(), n, body.corners.data());
  // Children of the root are nodes 1 to n; node i + 1 has triangle i.
  std::vector<std::uint32_t> first_child(n + 2, n), child(n), first_prim(n + 2, 0), prim(n);
  first_child[0] = 0;
  std::iota(child.begin(), child.end(), 1);
  std::iota(prim.begin(), prim.end(), 0);
  std::iota(first_prim.begin() + 1, first_prim.end(), 0);
  if (planted == "tree") prim[0] = prim[1];
  std::vector<double> boxes;
  for (std::uint32_t i = 0; i <= n; ++i) boxes.insert(boxes.end(), {-9, -9, -9, 9, 9, 9});
  lrbcap_tree tree{};
  tree.mesh = mesh;
  tree.nodes = n + 1;
  tree.volume = LRBCAP_AABB;
  tree.first_child = first_child.data();
  tree.child = child.data();
  tree.first_prim = first_prim.data();
  tree.prim = prim.data();
  tree.volumes = boxes.data();
  body.tree = LRBCAP_TREE(&tree);
  return body;
}

void answer(const Body& a, const Body& b, const double (&pose)[12]) {
  static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a.tree, identity, b.tree, pose);
  // Both bodies of the test are centred at 0.
  const bool near = std::hypot(pose[3], pose[7], pose[11]) < 0.5;
  static const std::uint32_t roots = LRBCAP_NAME("roots"), leaves = LRBCAP_NAME("leaves");
  LRBCAP_PHASE(roots);
  LRBCAP_NODE(0, 0, near, LRBCAP_NO_AXIS);
  LRBCAP_PHASE(leaves);
  for (std::uint32_t f = 0; near && f < a.triangles(); ++f)
    for (std::uint32_t g = 0; g < b.triangles(); ++g) LRBCAP_NODE(f + 1, g + 1, false, LRBCAP_NO_AXIS);
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
  std::ifstream in(argv[3]);
  for (std::string line; std::getline(in, line);) {
    double pose[12];
    const char* at = line.c_str();
    for (double& x : pose) {
      char* end = nullptr;
      x = std::strtod(at, &end);
      at = end;
    }
    if (planted == "shift") pose[3] += 1;
    answer(a, b, pose);
    if (planted == "short") break;
  }
  LRBCAP_CLOSE();
  return 0;
}
