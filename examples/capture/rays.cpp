// rays A.obj RAYS: the first hit of each ray with a mesh, by a tree of boxes, recorded by lrbscope_capture.h:
// see MeshTracer.
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

int main(int, char** argv) {
  const Triangles mesh = read_obj(argv[1]);
  Tree tree;
  tree.add(boxes_of(mesh), 0, mesh.corners.size() / 3);
  return MeshTracer(mesh, tree).run("rays in C++", argv[1], argv[2]);
}
