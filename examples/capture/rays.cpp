// rays A.obj RAYS: the first hit of each ray with a mesh, by a tree of boxes, recorded by lrbscope_capture.h:
// see RayTracer.
#include <algorithm>
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

static Triangles mesh;
static std::vector<Node> nodes;
static std::vector<double> boxes;  // least and greatest x, y, z of each node

static std::uint32_t build(std::uint32_t first, std::uint32_t last) {  // halves of the mesh's own order
  const auto node = std::uint32_t(nodes.size()), half = (first + last) / 2;
  nodes.emplace_back(), boxes.resize(6 * nodes.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double &least = boxes[6 * node + k] = HUGE_VAL, &most = boxes[6 * node + 3 + k] = -HUGE_VAL;
    for (std::size_t i = 3 * first; i < 3 * last; ++i) {
      const double x = mesh.vertices[3 * mesh.corners[i] + k];
      least = std::min(least, x), most = std::max(most, x);
    }
  }
  for (auto t = first; t < last && last - first <= 2; ++t) nodes[node].triangles.push_back(t);
  if (last - first > 2) nodes[node].children = {node + 1, 0}, build(first, half);
  if (last - first > 2) nodes[node].children[1] = build(half, last);
  return node;
}

int main(int, char** argv) {
  mesh = read_obj(argv[1]);
  build(0, std::uint32_t(mesh.corners.size() / 3));
  return RayTracer(mesh, nodes, boxes).run("rays in C++", argv[1], argv[2]);
}
