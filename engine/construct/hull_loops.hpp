#pragma once
/// The outline that the chain builder works on: hull_mesh.hpp, one dimension down.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

/// Closed loops of segments with the solid on their left. Segments live in numbered slots; an empty slot is
/// used again when a chain is replaced by its cap. Vertices are numbered as in the complex.
class HullLoops {
 public:
  using Slot = std::uint32_t;

  struct Segment {
    VertexId a, b;
    Slot next = kNull, prev = kNull;
    FaceId face = kNull;  ///< the face of the complex; kNull: the slot is empty
    std::uint32_t component = kNull;
    double extra = 0;  ///< how much further off the body than its ends it is somewhere; mesh's unit
  };

  /// Makes the loops of a mesh, which must be 2D and closed, every vertex with one segment in and one out.
  explicit HullLoops(const Mesh& mesh);

  Slot slot_count() const { return static_cast<Slot>(segments_.size()); }
  std::uint32_t segment_count() const { return alive_; }
  std::uint32_t component_count() const { return components_; }
  bool alive(Slot s) const { return segments_[s].face != kNull; }
  const Segment& operator[](Slot s) const { return segments_[s]; }
  const Eigen::Vector3d& x(VertexId v) const { return points_[v]; }
  const Eigen::Vector3d& start(Slot s) const { return points_[segments_[s].a]; }
  const Eigen::Vector3d& end(Slot s) const { return points_[segments_[s].b]; }
  std::vector<Slot> alive_slots() const;
  /// Returns how far a vertex is off the body: 0 for the mesh's own, else an estimate; mesh's unit.
  double off(VertexId v) const { return off_[v]; }

  VertexId add_point(const Eigen::Vector3d& x, double off = 0);
  void set_extra(Slot s, double extra) { segments_[s].extra = extra; }
  void set_component(Slot s, std::uint32_t component) { segments_[s].component = component; }
  /// Empties slots without closing the gap: place() must follow.
  void remove(std::span<const Slot> slots);
  /// Fills an empty slot, or the next one after the last; join() must follow.
  void place(Slot s, VertexId a, VertexId b, FaceId face, std::uint32_t component);
  void join(Slot first, Slot second) {
    segments_[first].next = second;
    segments_[second].prev = first;
  }

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> off_;  ///< (|points|)
  std::vector<Segment> segments_;
  std::uint32_t alive_ = 0, components_ = 0;
};

inline Eigen::AlignedBox3d box_of(const HullLoops& hull, HullLoops::Slot s) {
  Eigen::AlignedBox3d box(hull.start(s));
  box.extend(hull.end(s));
  return box;
}

}  // namespace lrb::construct
