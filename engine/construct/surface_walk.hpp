#pragma once
/// Distances of points from the mesh, found by walking over its triangles.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/front_mesh.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::construct {

/// The triangles of the mesh with their neighbours, one cache line each, in single precision relative to the
/// centre of the body: estimates to choose by. What lids are off the body is proven afterwards.
class SurfaceWalk {
 public:
  using Slot = FrontMesh::Slot;
  using Point = Eigen::Vector3f;

  /// `front`: still the mesh itself. `tree`: over it; both are only read here. `unit`: of points and
  /// distances.
  SurfaceWalk(const FrontMesh& front, const AabbTree& tree, double unit);

  Point local(const Eigen::Vector3d& p) const { return ((p - centre_) * scale_).cast<float>(); }
  /// Walks downhill from triangle `hint` to a triangle near p, which becomes the hint. Returns the squared
  /// distance from it; stops as soon as that is at most `enough`. May end at a local minimum.
  float walk(const Point& p, Slot& hint, float enough) const;
  /// Searches all triangles, where the walk ended too far off. Returns true if one is within the distance
  /// sqrt(enough) of p, and makes it the hint.
  bool find_within(const Point& p, Slot& hint, float enough) const;

 private:
  struct alignas(64) Triangle {
    Point a, ab, ac;
    std::array<std::uint32_t, 3> v, across;
  };
  static ClosestPart<float> nearest(const Triangle& t, const Point& p) {
    return closest_part<float>(t.ab, t.ac, p - t.a);
  }

  /// A node of the tree, which is copied without the boxes of triangles: a third of its memory.
  struct Node {
    Point low, high;
    std::uint32_t first, last, right;  ///< as AabbTree::Node
  };

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  std::vector<Slot> slots_;  ///< leaf by leaf
  Eigen::Vector3d centre_;
  double scale_;  ///< 1 / unit
};

}  // namespace lrb::construct
