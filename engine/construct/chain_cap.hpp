#pragma once
/// Caps over chains of segments: their placement, and the proof that they can be accepted.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/half_spaces.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

// The front of the 2D builder: the counterpart of front_mesh.hpp in one dimension less.

/// Closed loops of segments with the solid on their left. Segments are stored in numbered slots; an empty
/// slot is reused when a chain is replaced by its cap. Vertices are numbered as in the complex.
class FrontLoops {
 public:
  using Slot = std::uint32_t;

  struct Segment {
    VertexId a, b;
    Slot next = kNull, prev = kNull;
    FaceId face = kNull;  ///< the face of the complex; kNull: the slot is empty
    std::uint32_t component = kNull;
    double excess_deviation = 0;  ///< excess of its deviation from the body over that at its ends; mesh units
  };

  /// Builds the loops of a 2D mesh, which must be closed, with one incoming and one outgoing segment at every
  /// vertex.
  explicit FrontLoops(const Mesh& mesh);

  Slot slot_count() const { return static_cast<Slot>(segments_.size()); }
  std::uint32_t segment_count() const { return alive_; }
  std::uint32_t component_count() const { return components_; }
  bool alive(Slot s) const { return segments_[s].face != kNull; }
  const Segment& operator[](Slot s) const { return segments_[s]; }
  const Eigen::Vector3d& x(VertexId v) const { return points_[v]; }
  const Eigen::Vector3d& start(Slot s) const { return points_[segments_[s].a]; }
  const Eigen::Vector3d& end(Slot s) const { return points_[segments_[s].b]; }
  std::vector<Slot> alive_slots() const;
  /// Returns the deviation of a vertex from the body: 0 for the mesh's own vertices, else an estimate; mesh
  /// units.
  double deviation(VertexId v) const { return deviation_[v]; }

  VertexId add_point(const Eigen::Vector3d& x, double deviation = 0);
  void set_excess_deviation(Slot s, double excess_deviation) {
    segments_[s].excess_deviation = excess_deviation;
  }
  void set_component(Slot s, std::uint32_t component) { segments_[s].component = component; }
  /// Empties slots without closing the gap: place() must follow.
  void remove(std::span<const Slot> slots);
  /// Fills an empty slot, or the one after the last; join() must follow.
  void place(Slot s, VertexId a, VertexId b, FaceId face, std::uint32_t component);
  void join(Slot first, Slot second) {
    segments_[first].next = second;
    segments_[second].prev = first;
  }

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> deviation_;  ///< (|points|)
  std::vector<Segment> segments_;
  std::uint32_t alive_ = 0, components_ = 0;
};

inline Eigen::AlignedBox3d box_of(const FrontLoops& front, FrontLoops::Slot s) {
  Eigen::AlignedBox3d box(front.start(s));
  box.extend(front.end(s));
  return box;
}

/// A cap over a chain of `length` segments that begins with `first`.
struct ChainCap {
  FrontLoops::Slot first = kNull;
  std::uint32_t length = 0;
  std::optional<Eigen::Vector3d> apex;  ///< nullopt if the cap is the chord
  double area = 0;                      ///< area between chain and cap; unit squared
  /// Set by measure_cap(): deviation of the apex, and excess deviation of each segment over its ends.
  double apex_off = 0, excess_deviation[2] = {0, 0};

  std::uint32_t segments() const { return apex ? 2 : 1; }
};

/// Returns the slots of the chain, in order.
std::vector<FrontLoops::Slot> chain_of(const FrontLoops& front, FrontLoops::Slot first, std::uint32_t length);

/// Returns the chord as a cap if the chain's inner vertices are strictly behind it, otherwise two segments
/// whose apex is in front of the chain's lines (and of its neighbours' lines if the outline is concave at its
/// ends) and within `bounds`. Returns nullopt, and sets `why`, if there is no such apex, or if the cap would
/// add more than `area_limit` times the square of the chain's length.
std::optional<ChainCap> find_cap(const FrontLoops& front, FrontLoops::Slot first, std::uint32_t length,
                                 std::span<const HalfSpace> bounds, double area_limit, CapVerdict& why);

/// Estimates the deviation of the cap from the body at a few points of each segment, from the known deviation
/// of the chain. Returns false if it exceeds `most`.
bool measure_cap(const FrontLoops& front, ChainCap& cap, double most);

/// Returns the maximum deviation of the cap, at its ends or in between, as measured by measure_cap().
double off_of(const FrontLoops& front, const ChainCap& cap);

/// Returns CapVerdict::accepted if, exactly, the cap intersects the front and the chain only in the chain's
/// ends, leaves these ends between the chain and its neighbours on the outer side, and does not enclose
/// another component; otherwise returns the obstacle. `boxes` (components).
CapVerdict judge_chain_cap(const FrontLoops& front, const AabbTree& tree, const ChainCap& cap,
                           std::span<const Eigen::AlignedBox3d> boxes);

}  // namespace lrb::construct
