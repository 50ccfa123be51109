// bullet A.obj B.obj POSES: Bullet's collision of two meshes with quantised trees (GImpact), recorded by
// lrbscope_capture.h. The traversal is inside of the library, so only the tests of triangles are reported:
// answers are checked, visits are not classified.
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

struct Body {
  btTriangleMesh triangles;
  btGImpactMeshShape shape{&triangles};
  btGImpactMeshShapePart* part = shape.getMeshPart(0);
  std::uint32_t tree;

  explicit Body(const char* path) {
    const auto [xyz, corners] = read_obj(path);
    for (std::size_t i = 0; i + 2 < xyz.size(); i += 3)
      triangles.findOrAddVertex({btScalar(xyz[i]), btScalar(xyz[i + 1]), btScalar(xyz[i + 2])}, false);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.addTriangleIndices(int(corners[i]), int(corners[i + 1]), int(corners[i + 2]));
    shape.updateBound();
    part->lockChildShapes();  // its triangles are read
    const btGImpactBoxSet& boxes = *part->getBoxSet();
    std::vector<Node> nodes(std::size_t(boxes.getNodeCount()));
    std::vector<double> volumes;
    for (int i = 0; i < boxes.getNodeCount(); ++i) {
      Node& node = nodes[std::size_t(i)];
      if (boxes.isLeafNode(i))
        node.triangles = {std::uint32_t(boxes.getNodeData(i))};
      else
        node.children = {std::uint32_t(boxes.getLeftNode(i)), std::uint32_t(boxes.getRightNode(i))};
      btAABB box;
      boxes.getNodeBound(i, box);
      for (const btVector3& corner : {box.m_min, box.m_max})
        volumes.insert(volumes.end(), &corner[0], &corner[0] + 3);
    }
    tree = describe({xyz, corners}, path, LRBCAP_AABB, nodes, volumes);
  }
};

btPrimitiveTriangle triangle(const Body& body, int index, const btTransform& pose) {
  btPrimitiveTriangle out;
  body.part->getPrimitiveTriangle(index, out);
  out.applyTransform(pose);
  out.buildTriPlane();
  return out;
}

std::size_t query(const Body& a, const Body& b, const Pose& pose) {
  btScalar columns[16] = {};
  for (std::size_t k = 0; k < 12; ++k) columns[k % 4 * 4 + k / 4] = btScalar(pose[k]);
  btTransform at_a = btTransform::getIdentity(), at_b;
  at_b.setFromOpenGLMatrix(columns);
  btPairSet close;  // triangles with overlapping boxes
  std::size_t pairs = 0;
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a.tree, nullptr, b.tree, pose.data());
  btGImpactBoxSet::find_collision(a.part->getBoxSet(), at_a, b.part->getBoxSet(), at_b, close);
  for (int i = 0; i < close.size(); ++i) {
    btPrimitiveTriangle f = triangle(a, close[i].m_index1, at_a), g = triangle(b, close[i].m_index2, at_b);
    GIM_TRIANGLE_CONTACT contact;
    const bool met = f.overlap_test_conservative(g) && f.find_triangle_collision_clip_method(g, contact);
    LRBCAP_PRIM(close[i].m_index1, close[i].m_index2, met);
    pairs += met;
  }
  LRBCAP_END(pairs ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, pairs);
  return pairs;
}

int main(int argc, char** argv) {
  return run<Body>("Bullet, GImpact", argc, argv, query);
}
