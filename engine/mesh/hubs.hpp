#pragma once
/// High-valence vertices, and bounding volumes for meshes that contain them.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/mesh/box_tree.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

/// Maximum number of faces at a vertex, or of corners of a face, for comparing all pairs of them.
inline constexpr std::uint32_t kFewNeighbours = 64;

/// The hubs of a 3D mesh: vertices with more than kFewNeighbours planar convex faces. Each such face belongs
/// to at most one hub, the one with the most faces (ties: smallest number).
struct Hubs {
  struct Hub {
    VertexId vertex;
    std::vector<FaceId> faces;  ///< ascending
  };
  std::vector<Hub> hubs;

  Hubs(const Mesh& mesh, const std::vector<FaceUse>& use);
};

/// Calls visit(f, g), f < g, for all pairs of a hub's faces that may share more than the hub, and for a few
/// others; concurrently if `workers` has several threads.
///
/// If two convex faces share a corner v and another point x, they share the segment from v to x. They do so
/// if and only if the arcs in which they intersect a small sphere around v intersect. Boxes of these arcs
/// separate nearly all other pairs.
void for_each_pair_at(const Mesh& mesh, const Hubs::Hub& hub,
                      const std::function<void(FaceId, FaceId)>& visit, Workers& workers);

// Oriented boxes, for needles and flat pieces, whose AABBs are mostly empty.

/// Maps positions to the cube [-1, 1]^3 by translation and scaling.
///
/// The scales are powers of two. The first one is exact except for coordinates smaller than the largest one
/// by a factor of 2^1000, which lose less than 2^-1074. The difference from the centre is rounded once,
/// relative to itself, so a scaled position has an error below 2^-52 on each axis.
class UnitCube {
 public:
  explicit UnitCube(const Eigen::AlignedBox3d& box);
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const;

 private:
  /// A power of two as two factors, so that neither overflows nor underflows.
  struct Scale {
    double half = 1, rest = 1;
    static Scale by(int exponent);
    Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return (x * half) * rest; }
  };

  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  Scale first_, last_;  ///< before and after the subtraction of the centre
};

/// An oriented box in the unit cube.
struct OrientedBox {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows, of unit length and perpendicular up to
                                                       ///< rounding
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< in coordinates of the cube
  Eigen::Vector3d half = Eigen::Vector3d::Zero();      ///< half extents, with a margin for rounding

  /// Fits a box along the principal axes of at least one point of the unit cube.
  static OrientedBox about(std::span<const Eigen::Vector3d> points);
};

/// Returns true if the point sets of two boxes are proven disjoint: some direction separates the boxes by
/// more than rounding. False proves nothing.
bool proven_disjoint(const OrientedBox& a, const OrientedBox& b);

// The triangles of one face with very many corners, in a tree of oriented boxes.

class TriangleTree {
 public:
  using Triangle = std::array<VertexId, 3>;

  /// Builds a tree over at least one triangle; `cube` scales the mesh's vertices. Leaves have up to
  /// `leaf_size` triangles.
  TriangleTree(const Mesh& mesh, const UnitCube& cube, std::span<const Triangle> triangles,
               std::uint32_t leaf_size);

  /// Returns true if test(s, t) is true for a triangle s of one tree and t of the other. Does not call it for
  /// triangles that are surely apart.
  template <class Test>
  static bool any_pair(const TriangleTree& a, const TriangleTree& b, Test& test) {
    const auto apart = [&](std::uint32_t m, std::uint32_t n) {
      return proven_disjoint(a.boxes_[m], b.boxes_[n]);
    };
    return descend(a.tree_.nodes(), 0, b.tree_.nodes(), 0, apart, [&](std::uint32_t m, std::uint32_t n) {
      for (const Triangle& s : a.triangles_of(m))
        for (const Triangle& t : b.triangles_of(n))
          if (test(s, t)) return true;
      return false;
    });
  }

 private:
  std::span<const Triangle> triangles_of(std::uint32_t node) const {
    const BoxTree::Node& n = tree_.nodes()[node];
    return std::span(triangles_).subspan(n.first, n.last - n.first);
  }

  BoxTree tree_;
  std::vector<OrientedBox> boxes_;   ///< of the tree's nodes
  std::vector<Triangle> triangles_;  ///< leaf by leaf
};

}  // namespace lrb
