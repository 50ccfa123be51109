#pragma once
/// The front of a builder: at first the mesh itself, then surfaces that enclose more and more.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// A closed triangle surface with adjacency. Triangles are stored in numbered slots; an empty slot is reused
/// when a patch is replaced by its cap. Every vertex has exactly one fan of triangles: a vertex of the mesh
/// with several fans occurs once for each fan.
class FrontMesh {
 public:
  using Slot = std::uint32_t;    ///< index of a triangle
  using Corner = std::uint32_t;  ///< index of a vertex of the front

  struct Triangle {
    std::array<Corner, 3> v;      ///< counter-clockwise seen from outside
    std::array<Slot, 3> across;   ///< neighbour across the edge v[i], v[i + 1]
    FaceId face = kNull;          ///< the face of the complex; kNull: the slot is empty
    std::uint32_t component = 0;  ///< component of the mesh's surface
  };

  /// A vertex's position and its number in the complex.
  struct Point {
    Eigen::Vector3d x;
    VertexId id;
  };

  /// Builds the surface of a mesh, which must be closed, oriented, and manifold except for vertices with
  /// several fans. Polygons are triangulated; the triangles of one polygon are in consecutive slots and have
  /// the same face. `faces`: the numbers of the mesh's faces in the complex, if they are not the mesh's.
  explicit FrontMesh(const Mesh& mesh, std::span<const FaceId> faces = {});

  Slot slot_count() const { return static_cast<Slot>(triangles_.size()); }
  std::uint32_t triangle_count() const { return alive_; }
  std::uint32_t component_count() const { return components_; }
  Corner point_count() const { return static_cast<Corner>(points_.size()); }
  bool alive(Slot s) const { return triangles_[s].face != kNull; }
  const Triangle& operator[](Slot s) const { return triangles_[s]; }
  const Point& point(Corner v) const { return points_[v]; }
  const Eigen::Vector3d& x(Corner v) const { return points_[v].x; }
  /// Returns the number of triangles around a vertex; 0: not in use.
  std::uint32_t degree(Corner v) const { return degree_[v]; }
  Slot any_slot(Corner v) const { return slot_of_[v]; }

  /// Returns the index of vertex v in triangle s, which must have it.
  int index_of(Slot s, Corner v) const {
    const auto& t = triangles_[s].v;
    return t[0] == v ? 0 : t[1] == v ? 1 : 2;
  }

  /// Calls visit(slot, index of v in it) for the triangles around v, counter-clockwise.
  template <class Visit>
  void for_each_around(Corner v, Visit&& visit) const {
    const Slot first = slot_of_[v];
    Slot s = first;
    do {
      const int i = index_of(s, v);
      visit(s, i);
      s = triangles_[s].across[(i + 2) % 3];
    } while (s != first);
  }

  /// The slots of one polygon.
  struct SlotRange {
    Slot first, last;
  };
  SlotRange unit(Slot s) const {
    return s < unit_first_.size() && triangles_[s].face < first_faces_
               ? SlotRange{unit_first_[s], unit_first_[s] + unit_size_[s]}
               : SlotRange{s, s + 1};
  }
  /// Returns true for a triangle that no patch may contain, because it belongs to a polygon with very many
  /// corners, or has a vertex with very many triangles. A patch would have to contain all of these, and its
  /// cost is quadratic in its triangles.
  bool is_crowded(Slot s) const {
    constexpr std::uint32_t kMax = 512;
    const SlotRange polygon = unit(s);
    const auto& v = triangles_[s].v;
    return polygon.last - polygon.first > kMax || degree_[v[0]] > kMax || degree_[v[1]] > kMax ||
           degree_[v[2]] > kMax;
  }
  bool has_polygons() const { return !unit_first_.empty(); }

  Corner add_point(const Eigen::Vector3d& x, VertexId id);

  /// Removes triangles without closing the gap: add() must follow.
  void remove(std::span<const Slot> slots);
  /// Fills an empty slot, or the one after the last. Sets the triangle's neighbours as given; their side must
  /// be set with link().
  void add(Slot s, const Triangle& t);
  /// Makes t the neighbour of s across the edge of s that starts at `from`.
  void link(Slot s, Corner from, Slot t) { triangles_[s].across[index_of(s, from)] = t; }
  void set_component(Slot s, std::uint32_t component) { triangles_[s].component = component; }

  std::vector<Slot> alive_slots() const;

 private:
  void add_faces(const Mesh& mesh, std::span<const FaceId> faces);
  void find_neighbours();
  void split_fans();
  void find_components();

  std::vector<Triangle> triangles_;
  std::vector<Point> points_;
  std::vector<Slot> slot_of_;          ///< (|points|) any triangle at the vertex; kNull: not in use
  std::vector<std::uint32_t> degree_;  ///< (|points|)
  std::vector<Slot> unit_first_;       ///< empty if all faces are triangles
  std::vector<std::uint32_t> unit_size_;
  std::uint32_t first_faces_ = 0;  ///< faces from this number on are not of the mesh
  std::uint32_t alive_ = 0;
  std::uint32_t components_ = 0;
};

}  // namespace lrb::construct
