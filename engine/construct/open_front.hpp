#pragma once
/// The front while it is being simplified: the committed front, with the lids of open components in place.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/front_mesh.hpp"
#include <lrbscope/build.hpp>

namespace lrb::construct {

/// At most N things, without allocation.
template <class T, int N>
class Few {
 public:
  void clear() { count_ = 0; }
  bool full() const { return count_ == N; }
  void push_back(const T& t) { items_[count_++] = t; }
  std::size_t size() const { return count_; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  const T* begin() const { return items_; }
  const T* end() const { return items_ + count_; }
  const T& front() const { return items_[0]; }
  const T& back() const { return items_[count_ - 1]; }

 private:
  T items_[N];
  std::uint32_t count_ = 0;
};

/// A closed triangle surface that edge collapses move outward.
///
/// A *component* is a connected part that collapses have changed since the last commit. Its *floor* is the
/// faces of the committed front that died in it; its *lid* is the faces that took their place. A collapse
/// unites the components of the faces that it removes (union-find). A finished component becomes a region:
/// commit() makes its lid part of the committed front. restore() undoes a component.
class OpenFront {
 public:
  using Index = std::uint32_t;  ///< of a face, a vertex, or a component
  using Slot = FrontMesh::Slot;
  using Vector3 = Eigen::Vector3d;

  /// Areas, deviations and their limits are kept in floats, in this unit of length: a power of two near the
  /// body's size, so that they do not overflow and are the same for scaled bodies.
  double unit() const { return unit_; }
  const Eigen::AlignedBox3d& box() const { return box_; }
  double size() const { return box_.sizes().maxCoeff(); }

  /// What collapses read of a face; one cache line.
  struct alignas(64) Face {
    std::array<Index, 3> v, across;  ///< across[i]: over the edge v[i], v[i + 1]
    Index component;                 ///< kNull: committed, and not in a floor
    float area;                      ///< unit()^2
    Vector3 n;                       ///< unit normal; 0 for a face without area
    double d;                        ///< the plane is n.x = d
  };
  static_assert(sizeof(Face) == 64);

  /// Data of a face that is read less often.
  struct State {
    Slot slot = kNull;         ///< in the committed front; kNull: in a lid
    Slot hint = 0;             ///< a triangle of the mesh near it
    float deviation = 0;       ///< estimate of the largest deviation from the mesh; unit()
    float excluded_below = 0;  ///< not to be covered while the deviation limit is below this
    bool alive = false;
    bool careful = false;                       ///< it was in a component that failed its proof
    std::array<std::uint32_t, 3> refused_at{};  ///< time at which the collapse of an edge was refused
    std::array<float, 3> wake{};                ///< deviation limit below which the edge is not tried again
  };

  struct RimEdge {
    Index a, b, across, face;  ///< counter-clockwise; `face` is of the star, `across` beyond
  };
  static constexpr int kMaxRim = 32;
  /// The faces that the collapse of an edge removes, and the rim around them.
  struct Star {
    Index u, v;
    bool onto_v;                      ///< u moves onto v; otherwise both become one new vertex
    Few<Index, kMaxRim + 2> faces;    ///< the first and, if onto_v, the last have both u and v
    Few<RimEdge, kMaxRim> rim;        ///< onto_v: without the edges at v
    Index first_across, last_across;  ///< onto_v: beyond the edges at v
    int edge;                         ///< index of the edge u, v in faces[0]
  };
  /// The components and polygons that a collapse would unite.
  struct Union {
    std::vector<Index> components;
    std::vector<Slot> polygons;   ///< first slots of those that it is the first to touch
    std::uint32_t floor = 0;      ///< number of faces in the united floor
    std::uint32_t faces = 0;      ///< the same or, if planes were merged, with each polygon as one
    std::uint32_t collapses = 0;  ///< those made in the components; each leaves two faces fewer
    bool excluded = false;        ///< a face must not be covered at this deviation limit

    void clear() {  // keeps the memory
      components.clear(), polygons.clear();
      floor = faces = collapses = 0, excluded = false;
    }
  };

  /// `frozen` (real faces): those that are never covered. `merges_planes`: see BuildOptions.
  OpenFront(const FrontMesh& front, const std::vector<bool>& frozen, bool merges_planes = false);

  Index face_count() const { return static_cast<Index>(faces_.size()); }
  Index vertex_count() const { return static_cast<Index>(x_.size()); }
  const Face& operator[](Index f) const { return faces_[f]; }
  State& state(Index f) { return states_[f]; }
  const State& state(Index f) const { return states_[f]; }
  const Vector3& x(Index v) const { return x_[v]; }
  bool is_used(Index v) const { return face_of_[v] != kNull; }
  Index any_face(Index v) const { return face_of_[v]; }
  /// Returns the number of a vertex in the complex or, for a vertex of a lid, a number that no other has.
  VertexId id(Index v) const { return id_[v]; }
  Eigen::AlignedBox3d box(Index f) const;
  Index corner_opposite(Index f, Index a, Index b) const {
    const auto& v = faces_[f].v;
    return v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2];
  }
  static int index_of(const Face& f, Index v) { return f.v[0] == v ? 0 : f.v[1] == v ? 1 : 2; }

  std::uint32_t now() const { return time_; }
  std::uint32_t changed_at(Index v) const { return changed_at_[v]; }

  /// Finds the faces that the collapse of the edge u, v removes. Returns false if there is no such edge, or
  /// if the rim is too long.
  bool find_star(Index u, Index v, bool onto_v, Star& star) const;
  /// Returns true if the collapse leaves a surface (link condition).
  bool leaves_surface(const Star& star);

  /// Adds a face that a collapse would remove.
  void unite(Index f, float limit, Union& with) const;
  Index leader(Index component) const;
  std::uint32_t floor_faces(Index component) const { return components_[component].faces; }
  const std::vector<Index>& floor(Index component) const { return components_[component].floor; }
  bool is_careful(Index component) const { return components_[component].careful; }
  Index component_count() const { return static_cast<Index>(components_.size()); }
  CapVerdict held_by(Index component) const { return components_[component].held_by; }
  void set_held_by(Index component, CapVerdict verdict) { components_[component].held_by = verdict; }

  /// Replaces the star by a fan from its vertex v, or from a new vertex at `w`. `united`: of all its faces.
  /// `hints` (rim, or empty), `deviation`: of the new faces. Returns the fan's vertex.
  Index collapse(const Star& star, const Union& united, const Vector3& w, std::span<const Slot> hints,
                 float deviation);
  /// A committed face is part of a polygon of the mesh, of which the component has covered other parts.
  /// Replaces its edge number i, which it shares with the lid, by the other diagonal of the two faces, if the
  /// surface then is in front of them and remains one. The face becomes part of the floor.
  bool flip_outward(Index component, Index f, int i, Index* flipped);
  /// Covers such a face with the three triangles between its edges and a new vertex at `at`.
  std::array<Index, 3> raise(Index component, Index f, const Vector3& at);
  /// Puts a copy of such a face into the lid, and the face into the floor: no volume is between them.
  Index keep(Index component, Index f);
  /// Returns the triangles of the floor's polygons that are not in the floor: polygons of real faces, or of
  /// `merged` ones.
  std::vector<Index> uncovered_parts(Index component, bool merged) const;

  /// Lids by component: components in the order of their first faces.
  struct Lid {
    Index component;
    std::vector<Index> faces;
  };
  std::vector<Lid> lids() const;
  /// Puts the floor of a component back in place of its lid. Collapses that cover its faces are excluded
  /// below this deviation limit, and `careful` from now on.
  void restore(const Lid& lid, float excluded_below);
  /// The lid has become part of the committed front; `slots` (its faces): their places there.
  void commit(const Lid& lid, std::span<const Slot> slots);
  void set_committed(Index v, FrontMesh::Corner corner, VertexId id) { corner_[v] = corner, id_[v] = id; }
  /// Corner of the committed front; kNull: not part of it.
  FrontMesh::Corner corner(Index v) const { return corner_[v]; }
  Index face_at(Slot s) const { return face_at_[s]; }

  /// Returns the number of faces that collapses with this deviation limit must not cover.
  std::uint32_t excluded(float limit) const;
  bool was_restored() const { return was_restored_; }

 private:
  struct Component {
    std::vector<Index> floor;
    std::uint32_t size = 0;                  ///< faces of the floor, with all triangles of its polygons
    std::uint32_t faces = 0, collapses = 0;  ///< see Union
    CapVerdict held_by = CapVerdict::too_many_faces;
    bool careful = false;
  };

  /// Returns true for a part of a merged plane.
  bool is_merged(Slot s) const { return front_[s].face >= real_faces_; }
  Index edge_face(Index u, Index v, int& edge) const;
  bool add_fan(Star& star, Index centre, Index first, Index last) const;
  void set_plane(Face& f) const;
  Index new_face();
  Index new_vertex(const Vector3& at);
  Index merge(const Star& star, const Union& united);
  void cover(Index f, Index component);
  void set_across(Index f, Index a, Index b, Index to);
  void put(Index n, Index component, const std::array<Index, 3>& v, const std::array<Index, 3>& across,
           Slot hint, float deviation);

  const FrontMesh& front_;
  const std::size_t real_faces_;
  const bool merges_planes_;
  std::vector<Face> faces_;
  std::vector<State> states_;
  std::vector<Vector3> x_;
  std::vector<Index> face_of_;              ///< (vertices) any face at it; kNull: not in use
  std::vector<std::uint32_t> changed_at_;   ///< (vertices) time of the last change of a face at it
  std::vector<FrontMesh::Corner> corner_;   ///< (vertices)
  std::vector<VertexId> id_;                ///< (vertices)
  std::vector<std::uint32_t> name_, mark_;  ///< (vertices) equal for the copies of a vertex; by name
  std::vector<Index> face_at_;              ///< (slots)
  std::vector<Index> polygon_component_;    ///< (first slots of polygons) kNull: not touched
  mutable std::vector<Index> parent_;       ///< (components)
  std::vector<Component> components_;
  std::vector<Index> free_, fresh_;
  Index first_name_ = 0;     ///< name of vertex 0, if it were a new one
  Eigen::AlignedBox3d box_;  ///< of the vertices at the start
  double unit_;
  std::uint32_t marker_ = 0, time_ = 0;
  bool was_restored_ = false, has_excluded_ = false;
};

}  // namespace lrb::construct
