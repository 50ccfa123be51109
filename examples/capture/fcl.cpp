// fcl A.obj B.obj POSES [ROUNDS [distance]]: FCL's collision, or distance, of two trees of OBBRSS, whose
// queries lrbscope_capture.h records if LRBCAP_OUT names a file. FCL itself is not changed: subclasses of its
// traversals report the tests. POSES: a line of 12 numbers for each pose of B (3x4, row by row). Prints for
// each pose how many pairs of triangles intersect, or the distance, and on stderr the time of a query, the
// least of ROUNDS.
#include <algorithm>
#include <chrono>
#include <cstdlib>
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

struct Body {
  Triangles mesh;
  Model model;
  std::uint32_t tree = 0;  ///< its number in the capture
};

/// Reads a body, and reports its mesh and tree with the volumes that FCL tests: OBB, or RSS for distances.
void load(Body& body, const std::string& path, bool distance) {
  body.mesh = read_obj(path);
  const auto& [xyz, corners] = body.mesh;
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) vertices.emplace_back(xyz[i], xyz[i + 1], xyz[i + 2]);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
  body.model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  body.model.addSubModel(vertices, triangles);
  body.model.endModel();
  std::vector<Node> nodes(static_cast<std::size_t>(body.model.getNumBVs()));
  std::vector<double> volumes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& node = body.model.getBV(static_cast<int>(i));
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
  body.tree = describe(body.mesh, path, distance ? LRBCAP_RSS : LRBCAP_OBB, nodes, volumes);
}

fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d out = fcl::Transform3d::Identity();
  for (int k = 0; k < 12; ++k) out.matrix()(k / 4, k % 4) = pose[static_cast<std::size_t>(k)];
  return out;
}

/// Returns the distance, with B at a pose.
double query_distance(const Body& a, const Body& b, const Pose& pose) {
  fcl::DistanceResultd result;
  DistanceTraversal traversal;
  fcl::detail::initialize(traversal, std::as_const(a.model), fcl::Transform3d::Identity(),
                          std::as_const(b.model), transform(pose), fcl::DistanceRequestd(), result);
  LRBCAP_BEGIN(LRBCAP_DISTANCE, a.tree, nullptr, b.tree, pose.data());
  LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);  // FCL begins below the roots
  fcl::detail::distance(&traversal);
  LRBCAP_END(result.min_distance <= 0 ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, 0);
  return result.min_distance;
}

/// Returns the number of pairs that intersect, with B at a pose.
std::size_t query(const Body& a, const Body& b, const Pose& pose) {
  const fcl::CollisionRequestd request(a.mesh.corners.size() * b.mesh.corners.size(), false);
  fcl::CollisionResultd result;
  Traversal traversal;
  fcl::detail::initialize(traversal, std::as_const(a.model), fcl::Transform3d::Identity(),
                          std::as_const(b.model), transform(pose), request, result);
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a.tree, nullptr, b.tree, pose.data());
  fcl::detail::collide(&traversal);
  LRBCAP_END(result.numContacts() ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, result.numContacts());
  return result.numContacts();
}

}  // namespace

int main(int argc, char** argv) try {
  const bool distance = argc == 6 && std::string(argv[5]) == "distance";
  if (argc < 4 || argc > 6 || (argc == 6 && !distance))
    throw std::runtime_error("usage: fcl A.obj B.obj POSES [ROUNDS [distance]]");
  const int rounds = argc > 4 ? std::atoi(argv[4]) : 1;
  LRBCAP_OPEN("FCL " FCL_VERSION ", BVHModel<OBBRSS>", nullptr);
  Body a, b;
  load(a, argv[1], distance);
  load(b, argv[2], distance);
  const std::vector<Pose> poses = read_poses(argv[3]);
  std::cout.precision(15);
  std::vector<double> least(poses.size(), 1e30);
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      const double answer =
          distance ? query_distance(a, b, poses[i]) : static_cast<double>(query(a, b, poses[i]));
      const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
      least[i] = std::min(least[i], took.count());
      if (round == 0) std::cout << answer << (distance ? "\n" : " pairs\n");
    }
  double sum = 0;
  for (const double us : least) sum += us;
  std::cerr << sum / static_cast<double>(poses.size()) << " us per query\n";
  LRBCAP_CLOSE();
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
