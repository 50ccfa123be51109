/// lrbscope-xray-fcl: reads two meshes of triangles and poses from its file descriptor 3, lets FCL's own collision of two
/// BVHModel<OBBRSS> run on them, and prints each test of bounding volumes and each test of leaves that FCL does. The
/// recorder overrides the two virtual functions in which FCL's traversal does these, and hands on to them. A program of
/// its own, because FCL's packaged code may be compiled in one way only.
///
/// Input, numbers between white space: for each body the numbers of vertices and triangles, the vertices, the corners of
/// the triangles; then the number of poses, and for each the 12 numbers (3x4 matrix, row by row) of A and of B.
/// Output, a line each: `title`; for each body `tree N`, then for each node `node N CHILD...` or `leaf N TRIANGLE...`,
/// followed by its box in the body's frame: centre, then three half axes; for each pose `pose`, then in FCL's order
/// `b I J M` (bounding volumes of nodes I and J, M = 1: they meet) and `t I J M` (triangles I and J),
/// and `end B T`, FCL's own counts of both.
#include <cstdio>
#include <fstream>
#include <vector>

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;
using Traversal = fcl::detail::MeshCollisionTraversalNodeOBBRSSd;

/// FCL's traversal, told as it goes.
class Recorder : public Traversal {
 public:
  bool BVTesting(int b1, int b2) const override {
    const bool disjoint = Traversal::BVTesting(b1, b2);
    std::printf("b %d %d %d\n", b1, b2, static_cast<int>(!disjoint));
    return disjoint;
  }
  void leafTesting(int b1, int b2) const override {
    const std::size_t before = result->numContacts();
    Traversal::leafTesting(b1, b2);
    std::printf("t %d %d %d\n", model1->getBV(b1).primitiveId(), model2->getBV(b2).primitiveId(),
                static_cast<int>(result->numContacts() != before));
  }
};

struct BadInput {};

template <class T>
T next(std::istream& in) {
  T value;
  if (!(in >> value)) throw BadInput();
  return value;
}

void read_model(std::istream& in, Model& model) {
  const auto vertex_count = next<int>(in), triangle_count = next<int>(in);
  std::vector<fcl::Vector3d> vertices(static_cast<std::size_t>(vertex_count));
  for (fcl::Vector3d& v : vertices)
    for (int i = 0; i < 3; ++i) v[i] = next<double>(in);
  std::vector<fcl::Triangle> triangles;
  for (int i = 0; i < triangle_count; ++i) {
    const auto a = next<std::size_t>(in), b = next<std::size_t>(in), c = next<std::size_t>(in);
    triangles.emplace_back(a, b, c);
  }
  model.beginModel(triangle_count, vertex_count);
  model.addSubModel(vertices, triangles);
  if (model.endModel() != fcl::BVH_OK) throw BadInput();
}

void print_tree(const Model& model) {
  std::printf("tree %d\n", model.getNumBVs());
  for (int i = 0; i < model.getNumBVs(); ++i) {
    const auto& node = model.getBV(i);
    if (node.isLeaf())
      std::printf("leaf 1 %d", node.primitiveId());
    else
      std::printf("node 2 %d %d", node.leftChild(), node.rightChild());
    const fcl::OBBd& box = node.bv.obb;
    for (int k = 0; k < 3; ++k) std::printf(" %.17g", box.To[k]);
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < 3; ++k) std::printf(" %.17g", box.axis(k, axis) * box.extent[axis]);
    std::printf("\n");
  }
}

fcl::Transform3d read_pose(std::istream& in) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) pose.matrix()(row, column) = next<double>(in);
  return pose;
}

int run() {
  std::ifstream in("/proc/self/fd/3");
  Model a, b;
  read_model(in, a);
  read_model(in, b);
  std::printf("title FCL %s, BVHModel<OBBRSS>\n", FCL_VERSION);
  print_tree(a);
  print_tree(b);
  const auto poses = next<int>(in);
  for (int i = 0; i < poses; ++i) {
    const fcl::Transform3d pose_a = read_pose(in), pose_b = read_pose(in);
    constexpr std::size_t kAll = std::size_t{1} << 40;
    const fcl::CollisionRequestd request(kAll, false);
    fcl::CollisionResultd result;
    Recorder traversal;
    if (!fcl::detail::initialize(traversal, a, pose_a, b, pose_b, request, result)) return 1;
    traversal.enableStatistics(true);
    std::printf("pose\n");
    fcl::detail::collide(&traversal);
    std::printf("end %d %d\n", traversal.num_bv_tests, traversal.num_leaf_tests);
  }
  return 0;
}

}  // namespace

int main() {
  constexpr int kBadInput = 2;
  try {
    return run();
  } catch (const BadInput&) {
    return kBadInput;
  }
}
