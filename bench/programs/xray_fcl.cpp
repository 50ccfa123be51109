/// lrbscope-xray-fcl: runs FCL's collision of two BVHModel<OBBRSS>, and prints each test of bounding volumes
/// and of leaves, and at the end FCL's own counts of both (xray_form.hpp). The recorder overrides the two
/// virtual functions of FCL's traversal that perform these tests, and forwards to them. A separate program,
/// because all code that uses FCL's package must be compiled with the same flags.
#include <cstdio>
#include <vector>

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

#include "bench/programs/xray_form.hpp"

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;
using Traversal = fcl::detail::MeshCollisionTraversalNodeOBBRSSd;

/// FCL's traversal, with a report of each test.
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

void read_model(std::istream& in, Model& model) {
  const xray_form::Triangles t = xray_form::read_triangles(in);
  std::vector<fcl::Vector3d> vertices;
  for (const auto& v : t.vertices) vertices.emplace_back(v[0], v[1], v[2]);
  std::vector<fcl::Triangle> triangles;
  for (const auto& c : t.corners) triangles.emplace_back(c[0], c[1], c[2]);
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model.addSubModel(vertices, triangles);
  if (model.endModel() != fcl::BVH_OK) throw xray_form::BadInput();
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
    xray_form::print_box([&](int k) { return box.To[k]; },
                         [&](int axis, int k) { return box.axis(k, axis) * box.extent[axis]; });
  }
}

fcl::Transform3d read_pose(std::istream& in) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  const auto m = xray_form::next_numbers<12, double>(in);
  for (int i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = m[static_cast<std::size_t>(i)];
  return pose;
}

int run(std::istream& in) {
  Model a, b;
  read_model(in, a);
  read_model(in, b);
  std::printf("title FCL %s, BVHModel<OBBRSS>\n", FCL_VERSION);
  print_tree(a);
  print_tree(b);
  const auto poses = xray_form::next<int>(in);
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
  return xray_form::exit_code_of(run);
}
