// fcl A.obj B.obj POSES [distance]: FCL's collision, or distance, of two trees of OBBRSS, recorded by
// lrbscope_capture.h. FCL itself is not changed: subclasses of its traversals report the tests. Prints for
// each pose how many pairs of triangles intersect, or the distance.
#include <iomanip>
#include <utility>

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>
#define LRBCAP_IMPLEMENTATION  // in one source file of a program
#include "bodies.hpp"

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

/// FCL's traversal of two trees, which reports its tests.
struct Traversal final : fcl::detail::MeshCollisionTraversalNodeOBBRSSd {
  using Base = fcl::detail::MeshCollisionTraversalNodeOBBRSSd;

  bool BVTesting(int a, int b) const override {
    const bool apart = Base::BVTesting(a, b);
    LRBCAP_NODE(a, b, !apart, LRBCAP_NO_AXIS);
    return apart;
  }
  void leafTesting(int a, int b) const override {
    const std::size_t before = result->numContacts();
    Base::leafTesting(a, b);
    LRBCAP_PRIM(model1->getBV(a).primitiveId(), model2->getBV(b).primitiveId(),
                result->numContacts() != before);
  }
};

/// The same for distances. FCL descends into a pair that is closer than the closest triangles so far.
struct DistanceTraversal final : fcl::detail::MeshDistanceTraversalNodeOBBRSSd {
  using Base = fcl::detail::MeshDistanceTraversalNodeOBBRSSd;

  double BVTesting(int a, int b) const override {
    const double gap = Base::BVTesting(a, b);
    LRBCAP_NODE(a, b, gap < result->min_distance, LRBCAP_NO_AXIS);
    return gap;
  }
  void leafTesting(int a, int b) const override {
    Base::leafTesting(a, b);
    LRBCAP_PRIM(model1->getBV(a).primitiveId(), model2->getBV(b).primitiveId(), result->min_distance <= 0);
  }
};

bool distance = false;  ///< else collision

struct Body {
  Triangles mesh;
  Model model;
  std::uint32_t tree = 0;  ///< its number in the capture
  explicit Body(const char* path);
};

/// Reads a body, and reports its mesh and tree with the volumes that FCL tests: OBB, or RSS for distances.
Body::Body(const char* path) : mesh(read_obj(path)) {
  const auto& [xyz, corners] = mesh;
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) vertices.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
  model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model.addSubModel(vertices, triangles);
  model.endModel();
  std::vector<Node> nodes(static_cast<std::size_t>(model.getNumBVs()));
  std::vector<double> volumes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& node = model.getBV(static_cast<int>(i));
    if (node.isLeaf())
      nodes[i].triangles = {static_cast<std::uint32_t>(node.primitiveId())};
    else
      nodes[i].children = {static_cast<std::uint32_t>(node.leftChild()),
                           static_cast<std::uint32_t>(node.rightChild())};
    const auto& box = node.bv.obb;
    const auto& rss = node.bv.rss;
    for (int k = 0; k < 3; ++k) volumes.push_back(distance ? rss.To[k] : box.To[k]);
    for (int axis = 0; axis < (distance ? 2 : 3); ++axis)
      for (int k = 0; k < 3; ++k)
        volumes.push_back(distance ? rss.axis(k, axis) * rss.l[axis] : box.axis(k, axis) * box.extent[axis]);
    if (distance) volumes.push_back(rss.r);
  }
  tree = describe(mesh, path, distance ? LRBCAP_RSS : LRBCAP_OBB, nodes, volumes);
}

fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d out = fcl::Transform3d::Identity();
  for (int k = 0; k < 12; ++k) out.matrix()(k / 4, k % 4) = pose[static_cast<std::size_t>(k)];
  return out;
}

/// Queries the bodies, with B at a pose.
template <class Traversed, class Request, class Result>
void traverse(Traversed traversal, const Body& a, const Body& b, const Pose& pose, const Request& request,
              Result& result) {
  fcl::detail::initialize(traversal, std::as_const(a.model), fcl::Transform3d::Identity(),
                          std::as_const(b.model), transform(pose), request, result);
  LRBCAP_BEGIN(distance ? LRBCAP_DISTANCE : LRBCAP_ALL_PAIRS, a.tree, nullptr, b.tree, pose.data());
  if constexpr (std::is_same_v<Traversed, Traversal>) {
    fcl::detail::collide(&traversal);
  } else {
    LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);  // FCL begins below the roots
    fcl::detail::distance(&traversal);
  }
}

/// Returns the number of pairs that intersect, or the distance.
std::string query(const Body& a, const Body& b, const Pose& pose) {
  std::ostringstream out;
  if (distance) {
    fcl::DistanceResultd result;
    traverse(DistanceTraversal(), a, b, pose, fcl::DistanceRequestd(), result);
    LRBCAP_END(result.min_distance <= 0 ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, 0);
    out << std::setprecision(15) << result.min_distance;
  } else {
    fcl::CollisionResultd result;
    traverse(Traversal(), a, b, pose,
             fcl::CollisionRequestd(a.mesh.corners.size() * b.mesh.corners.size(), false), result);
    LRBCAP_END(result.numContacts() ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, result.numContacts());
    out << result.numContacts() << " pairs";
  }
  return out.str();
}

}  // namespace

int main(int argc, char** argv) {
  distance = argc == 5 && std::string(argv[4]) == "distance";
  return run<Body>("FCL " FCL_VERSION ", BVHModel<OBBRSS>", argc - distance, argv, query);
}
