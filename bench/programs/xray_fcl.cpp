/// lrbscope-xray-fcl: captures FCL's collision of two BVHModel<OBBRSS>: each test of bounding volumes and of
/// leaves, and at the end FCL's own counts of both (xray_form.hpp). The recorder overrides the two virtual
/// functions of FCL's traversal that perform these tests, and forwards to them. A separate program, because
/// all code that uses FCL's package must be compiled with the same flags.
#include <stdexcept>
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
    LRBCAP_NODE(b1, b2, !disjoint, LRBCAP_NO_AXIS);
    return disjoint;
  }
  void leafTesting(int b1, int b2) const override {
    const std::size_t before = result->numContacts();
    Traversal::leafTesting(b1, b2);
    LRBCAP_PRIM(model1->getBV(b1).primitiveId(), model2->getBV(b2).primitiveId(),
                result->numContacts() != before);
  }
};

void read_model(const xray_form::Triangles& t, Model& model) {
  std::vector<fcl::Vector3d> vertices;
  for (const auto& v : t.vertices) vertices.emplace_back(v[0], v[1], v[2]);
  std::vector<fcl::Triangle> triangles;
  for (const auto& c : t.corners) triangles.emplace_back(c[0], c[1], c[2]);
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model.addSubModel(vertices, triangles);
  if (model.endModel() != fcl::BVH_OK) throw xray_form::BadInput();
}

std::uint32_t capture_tree(const Model& model, std::uint32_t mesh) {
  using Indices = std::vector<std::uint32_t>;
  xray_form::TreeNodes nodes(LRBCAP_OBB);
  for (int i = 0; i < model.getNumBVs(); ++i) {
    const auto& node = model.getBV(i);
    const auto index = [](int n) { return static_cast<std::uint32_t>(n); };
    const fcl::OBBd& box = node.bv.obb;
    std::vector<double> numbers;
    for (int k = 0; k < 3; ++k) numbers.push_back(box.To[k]);
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < 3; ++k) numbers.push_back(box.axis(k, axis) * box.extent[axis]);
    if (node.isLeaf())
      nodes.add(Indices{}, Indices{index(node.primitiveId())}, numbers);
    else
      nodes.add(Indices{index(node.leftChild()), index(node.rightChild())}, Indices{}, numbers);
  }
  return nodes.capture(mesh);
}

fcl::Transform3d transform_of(const std::array<double, 12>& m) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  for (int i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = m[static_cast<std::size_t>(i)];
  return pose;
}

void run(std::istream& in, const char* file) {
  const xray_form::Triangles triangles[] = {xray_form::read_triangles(in), xray_form::read_triangles(in)};
  Model a, b;
  read_model(triangles[0], a);
  read_model(triangles[1], b);
  LRBCAP_OPEN("FCL " FCL_VERSION ", BVHModel<OBBRSS>", file);
  const std::uint32_t tree_a = capture_tree(a, xray_form::capture_mesh(triangles[0], "A"));
  const std::uint32_t tree_b = capture_tree(b, xray_form::capture_mesh(triangles[1], "B"));
  const std::uint32_t volume_tests = LRBCAP_NAME("num_bv_tests"), leaf_tests = LRBCAP_NAME("num_leaf_tests");
  const auto poses = xray_form::next<int>(in);
  for (int i = 0; i < poses; ++i) {
    const auto pose_a = xray_form::next_numbers<12, double>(in);
    const auto pose_b = xray_form::next_numbers<12, double>(in);
    constexpr std::size_t kAll = std::size_t{1} << 40;
    const fcl::CollisionRequestd request(kAll, false);
    fcl::CollisionResultd result;
    Recorder traversal;
    if (!fcl::detail::initialize(traversal, a, transform_of(pose_a), b, transform_of(pose_b), request,
                                 result))
      throw std::runtime_error("FCL does not accept the bodies");
    traversal.enableStatistics(true);
    LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, tree_a, pose_a.data(), tree_b, pose_b.data());
    fcl::detail::collide(&traversal);
    LRBCAP_COUNT(volume_tests, traversal.num_bv_tests);
    LRBCAP_COUNT(leaf_tests, traversal.num_leaf_tests);
    LRBCAP_END(result.isCollision() ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, result.numContacts());
  }
}

}  // namespace

int main(int argc, char** argv) {
  return xray_form::exit_code_of(argc, argv, run);
}
