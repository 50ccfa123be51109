#pragma once
/// The triangles of one face with very many corners, in a tree of boxes that are turned to fit.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/mesh/mesh.hpp"
#include "engine/mesh/oriented_box.hpp"

namespace lrb {

class TriangleTree {
 public:
  using Triangle = std::array<VertexId, 3>;

  /// Builds a tree over at least one triangle; `cube` scales the mesh's vertices. Leaves hold up to
  /// `leaf_size`.
  TriangleTree(const Mesh& mesh, const UnitCube& cube, std::vector<Triangle> triangles,
               std::uint32_t leaf_size);

  /// Returns true if test(s, t) holds for a triangle s of one tree and t of the other. Does not call it for
  /// triangles that are surely apart.
  template <class Test>
  static bool any_pair(const TriangleTree& a, const TriangleTree& b, Test& test) {
    return any(a, 0, b, 0, test);
  }

 private:
  struct Node {
    OrientedBox box;
    std::uint32_t first = 0, last = 0;  ///< into triangles_
    std::uint32_t right = 0;            ///< child; the left one follows its parent. 0: leaf
  };

  std::uint32_t build(const Mesh& mesh, const UnitCube& cube, std::uint32_t first, std::uint32_t last,
                      std::uint32_t leaf_size);

  template <class Test>
  static bool any(const TriangleTree& a, std::uint32_t m, const TriangleTree& b, std::uint32_t n,
                  Test& test) {
    const Node &x = a.nodes_[m], &y = b.nodes_[n];
    if (surely_apart(x.box, y.box)) return false;
    if (x.right == 0 && y.right == 0) {
      for (std::uint32_t i = x.first; i < x.last; ++i)
        for (std::uint32_t j = y.first; j < y.last; ++j)
          if (test(a.triangles_[i], b.triangles_[j])) return true;
      return false;
    }
    if (y.right == 0 || (x.right != 0 && x.last - x.first >= y.last - y.first))
      return any(a, m + 1, b, n, test) || any(a, x.right, b, n, test);
    return any(a, m, b, n + 1, test) || any(a, m, b, y.right, test);
  }

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace lrb
