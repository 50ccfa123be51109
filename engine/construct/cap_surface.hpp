#pragma once
/// A copy of a patch's triangles, to be simplified into a cap by edge collapses.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/front_mesh.hpp"
#include "engine/construct/patch_grow.hpp"

namespace lrb::construct {

/// A disk with a fixed ring, or a closed surface. Vertices have local numbers: first the ring in order, then
/// the patch's interior, then new vertices.
class CapSurface {
 public:
  struct Plane {
    Eigen::Vector3d n;  ///< unit length, or 0 for a degenerate triangle
    double d;           ///< n.x = d on the plane
    double area;
  };
  struct Face {
    std::array<int, 3> v;
    /// The face across the edge v[i], v[i + 1]; at the ring: -1 - (index of the ring edge).
    std::array<int, 3> across;
    Plane plane;
    int kept;  ///< index into Patch::slots if this is still that triangle, else -1
    bool alive;
    std::uint32_t since;  ///< version of the surface at which it was created
    /// The version at which the collapse of the edge v[i], v[i + 1] was rejected; 0: never.
    std::array<std::uint32_t, 3> rejected;
  };
  /// The triangles around an interior vertex u, or around an edge u, v, and the boundary loop of these.
  struct Star {
    struct Rim {
      int a, b;    ///< an edge that would be the base of a new triangle a, b, w
      int across;  ///< the triangle or ring edge across it
      int face;    ///< the star's triangle at it
    };
    int u = -1, v = -1;
    std::vector<int> faces;
    std::vector<Rim> rim;  ///< in order; an open chain from v back to v if v is on the ring
    /// Open chain: the triangles or ring edges across the edges v, rim.front().a and rim.back().b, v.
    int across_first = -1, across_last = -1;
    /// The creation version of the newest of its triangles, and of those across the rim.
    std::uint32_t since = 0;
  };

  /// Loads a patch. `first_id`: number of the first new vertex in the complex.
  void load(const FrontMesh& front, const Patch& patch, VertexId first_id);

  int ring_size() const { return ring_size_; }
  int first_new() const { return first_new_; }
  int vertex_count() const { return static_cast<int>(points_.size()); }
  bool is_ring(int v) const { return v < ring_size_; }
  bool is_used(int v) const { return face_of_[v] >= 0; }
  const Eigen::Vector3d& x(int v) const { return points_[v].x; }
  /// Returns a vertex's number in the complex; for a new vertex, its number if all new vertices remain.
  VertexId id(int v) const { return points_[v].id; }
  /// Returns the deviation of a vertex from the body; see FrontMesh::Point.
  /// Returns the front's vertex of an old vertex.
  FrontMesh::Corner corner(int v) const { return corners_[v]; }

  const std::vector<Face>& faces() const { return faces_; }
  int alive_faces() const { return alive_; }
  int new_faces() const { return alive_ - kept_; }
  int face_at_ring(int k) const { return ring_face_[k]; }
  const Plane& plane_beyond(int k) const { return beyond_[k].plane; }
  const Eigen::Vector3d& tip_beyond(int k) const { return beyond_[k].tip; }
  double patch_area() const { return patch_area_; }
  /// Returns the index of a triangle of the front in the patch, or -1.
  int local_face(const Patch& patch, FrontMesh::Slot s) const {
    const int f = local_face_[s];
    return f >= 0 && static_cast<std::size_t>(f) < patch.slots.size() && patch.slots[f] == s ? f : -1;
  }

  /// Finds the star for collapsing the edge u, v (u interior) to a new vertex or, if v is on the ring, onto
  /// v. Returns false if the result would not be a surface (link condition), or if the collapse would create
  /// an edge between ring vertices that the front has already.
  bool find_star(int u, int v, Star& star);
  /// Returns a number that increases with each change.
  std::uint32_t version() const { return version_; }
  /// Records that the star's edge cannot be collapsed.
  void reject(const Star& star) {
    faces_[star.faces[0]].rejected[index_of(star.faces[0], star.u)] = version_;
  }
  /// Returns true if that was recorded, and neither the star nor the triangles around it have changed since.
  bool was_rejected(const Star& star) const {
    return faces_[star.faces[0]].rejected[index_of(star.faces[0], star.u)] >= star.since;
  }
  void forget_rejected() {
    for (Face& f : faces_) f.rejected = {};
  }
  /// Returns true if v, a neighbour of u, is behind the plane of a triangle at u that does not have v as a
  /// corner.
  bool is_behind_a_face_at(int u, int v) const;
  /// Collapses u and v into a new vertex at x. Returns its number.
  int collapse_to_new(const Star& star, const Eigen::Vector3d& x);
  void collapse_onto_ring(const Star& star);

  /// Ensures that the triangles of each polygon of the mesh are all retained or all covered, because a
  /// polygon is one face of the complex. Covers those retained without the others, by flipping edges outward.
  /// Returns false if that is impossible.
  bool keep_polygons_whole(const FrontMesh& front, const Patch& patch);

  /// Moves an interior vertex.
  void move(int v, const Eigen::Vector3d& x);

  /// Calls visit(neighbour) for the vertices around an interior vertex.
  template <class Visit>
  void for_each_neighbour(int u, Visit&& visit) const {
    int f = face_of_[u];
    do {
      const int i = index_of(f, u);
      visit(faces_[f].v[(i + 1) % 3]);
      f = faces_[f].across[(i + 2) % 3];
    } while (f != face_of_[u]);
  }
  /// Calls visit(a, b) for the edges of the boundary loop around an interior vertex.
  template <class Visit>
  void for_each_rim_edge(int u, Visit&& visit) const {
    int f = face_of_[u];
    do {
      const int i = index_of(f, u);
      visit(faces_[f].v[(i + 1) % 3], faces_[f].v[(i + 2) % 3]);
      f = faces_[f].across[(i + 2) % 3];
    } while (f != face_of_[u]);
  }

 private:
  struct Beyond {
    Plane plane;
    Eigen::Vector3d tip;  ///< the corner that is not on the ring edge
  };

  int index_of(int f, int v) const {
    const auto& t = faces_[f].v;
    return t[0] == v ? 0 : t[1] == v ? 1 : 2;
  }
  Plane plane_of(int a, int b, int c) const;
  void load_points(const FrontMesh& front, const Patch& patch);
  void load_faces(const FrontMesh& front, const Patch& patch);
  void load_surroundings(const FrontMesh& front, const Patch& patch);
  bool chord_outside(int a, int b) const { return chords_[a * ring_size_ + b]; }
  int count_marked_neighbours_of_ring(int r) const;
  void add_to_rim(Star& star, const Star::Rim& rim) const;
  void replace(const Star& star, int w);
  void set_across(int code, int a, int b, int f);
  bool are_neighbours(int a, int b) const;
  bool flip_outward(int f, int i);

  std::vector<FrontMesh::Point> points_;
  std::vector<FrontMesh::Corner> corners_;  ///< (old vertices)
  /// (|points|) any face at the vertex; for a ring vertex the face at its ring edge; -1: unused.
  std::vector<int> face_of_;
  std::vector<Face> faces_;
  std::vector<int> ring_face_;       ///< (|ring|) the face at the ring edge
  std::vector<Beyond> beyond_;       ///< (|ring|)
  std::vector<bool> chords_;         ///< (|ring| x |ring|) true if the front has this edge outside the patch
  std::vector<std::uint32_t> mark_;  ///< (|points|)
  std::uint32_t marker_ = 0;
  VertexId next_id_ = 0;
  int ring_size_ = 0, first_new_ = 0, alive_ = 0, kept_ = 0;
  std::uint32_t version_ = 0;  ///< 1: as loaded
  double patch_area_ = 0;

  // Maps from the front's numbers to local ones; an entry is valid if the local element refers back to it.
  std::vector<int> local_point_, local_face_;
};

}  // namespace lrb::construct
