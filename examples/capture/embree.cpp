// embree A.obj RAYS: as rays.cpp, with the tree of Embree's builder. Embree does not show its own traversal
// and trees, but builds trees for others (rtcBuildBVH), which are traversed here.
#include <embree3/rtcore.h>
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

struct Built {
  std::vector<Built*> children;
  std::vector<RTCBounds> boxes;  // of the children
  std::vector<std::uint32_t> triangles;
};
static Triangles mesh;
static Tree tree;
static void append(const Built& from, const RTCBounds& box) {
  const std::size_t node = tree.nodes.size();
  tree.nodes.push_back({{}, from.triangles});
  for (const float* x : {&box.lower_x, &box.upper_x}) tree.boxes.insert(tree.boxes.end(), x, x + 3);
  for (std::size_t i = 0; i < from.children.size(); ++i) {
    tree.nodes[node].children.push_back(std::uint32_t(tree.nodes.size()));
    append(*from.children[i], from.boxes[i]);
  }
}

static void build() {
  constexpr float inf = HUGE_VALF;
  std::vector<RTCBuildPrimitive> all(mesh.corners.size() / 3, {inf, inf, inf, 0, -inf, -inf, -inf, 0});
  RTCBounds whole{inf, inf, inf, 0, -inf, -inf, -inf, 0};
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    all[i / 3].primID = unsigned(i / 3);
    for (std::size_t k = 0; k < 3; ++k)
      for (float* x : {&all[i / 3].lower_x + k, &whole.lower_x + k}) {  // x[4]: the greatest number
        const auto corner = float(mesh.vertices[3 * mesh.corners[i] + k]);
        x[0] = std::fmin(x[0], corner), x[4] = std::fmax(x[4], corner);
      }
  }
  RTCBuildArguments how = rtcDefaultBuildArguments();
  how.bvh = rtcNewBVH(rtcNewDevice(nullptr)), how.maxLeafSize = 4;
  how.primitives = all.data(), how.primitiveCount = how.primitiveArrayCapacity = all.size();
  how.createNode = [](RTCThreadLocalAllocator, unsigned, void*) -> void* { return new Built; };
  how.setNodeBounds = [](void* node, const RTCBounds** b, unsigned n, void*) {
    for (unsigned i = 0; i < n; ++i) static_cast<Built*>(node)->boxes.push_back(*b[i]);
  };
  how.setNodeChildren = [](void* node, void** c, unsigned n, void*) {
    for (unsigned i = 0; i < n; ++i) static_cast<Built*>(node)->children.push_back(static_cast<Built*>(c[i]));
  };
  how.createLeaf = [](RTCThreadLocalAllocator, const RTCBuildPrimitive* p, std::size_t n, void*) -> void* {
    auto* leaf = new Built;
    for (std::size_t i = 0; i < n; ++i) leaf->triangles.push_back(p[i].primID);
    return leaf;
  };
  append(*static_cast<Built*>(rtcBuildBVH(&how)), whole);
}

int main(int, char** argv) {
  mesh = read_obj(argv[1]);
  for (double& x : mesh.vertices) x = float(x);
  build();
  return MeshTracer(mesh, tree).run("rays by trees of Embree", argv[1], argv[2]);
}
