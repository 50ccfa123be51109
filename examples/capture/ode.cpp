// ode A.obj B.obj POSES: ODE's collision of two meshes, recorded by lrbscope_capture.h. Nothing inside of the
// library is visible: a body is described as a tree of one node, and the triangles of each contact, if known,
// are reported as a test that found an intersection.
#include <ode/ode.h>
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

struct Body {
  Triangles mesh;
  dTriMeshDataID data = dGeomTriMeshDataCreate();
  dGeomID geometry;
  std::uint32_t tree;

  explicit Body(const char* path) : mesh(read_obj(path)) {
    const int vertices = int(mesh.vertices.size() / 3), indices = int(mesh.corners.size());
    dGeomTriMeshDataBuildDouble(data, mesh.vertices.data(), 24, vertices, mesh.corners.data(), indices, 12);
    geometry = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
    dReal box[6];  // least and greatest x, least and greatest y, ...
    dGeomGetAABB(geometry, box);
    Node root;
    for (std::uint32_t i = 0; i < mesh.corners.size() / 3; ++i) root.triangles.push_back(i);
    tree = describe(mesh, path, LRBCAP_AABB, {root}, {box[0], box[2], box[4], box[1], box[3], box[5]});
  }
  ~Body() {
    dGeomDestroy(geometry);
    dGeomTriMeshDataDestroy(data);
  }
};

std::size_t query(const Body& a, const Body& b, const Pose& pose) {
  dMatrix3 rotation = {};
  for (std::size_t k = 0; k < 12; ++k)
    if (k % 4 != 3) rotation[k] = pose[k];
  dGeomSetRotation(b.geometry, rotation);
  dGeomSetPosition(b.geometry, pose[3], pose[7], pose[11]);
  static dContactGeom contacts[65535];
  LRBCAP_BEGIN(LRBCAP_ANY, a.tree, nullptr, b.tree, pose.data());
  const int count = dCollide(a.geometry, b.geometry, 65535, contacts, sizeof *contacts);
  for (int i = 0; i < count; ++i)
    if (contacts[i].side1 >= 0 && contacts[i].side2 >= 0)
      LRBCAP_PRIM(contacts[i].side1, contacts[i].side2, 1);
  LRBCAP_END(count ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, 0);
  return std::size_t(count);
}

int main(int argc, char** argv) {
  dInitODE();
  const int code = run<Body>("ODE, trimeshes", argc, argv, query);
  dCloseODE();
  return code;
}
