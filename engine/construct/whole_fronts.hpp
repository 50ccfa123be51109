#pragma once
/// The steps of both builders on entire fronts, FrontMesh or FrontLoops: they find out which components bound
/// voids, and when caps no longer simplify the front, they fill these and close with one wrapper.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/chain_cap.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/mesh/nesting.hpp"

namespace lrb::construct {

// Nesting of a body's components: voids have negative volume (exact); an exact ray decides which components
// contain each other; a solid component belongs to the innermost void that contains it.

struct Component {
  std::vector<FaceId> faces;
  Eigen::AlignedBox3d box;
};

template <class Front>
std::vector<Component> components_of(const Front& front) {
  std::vector<Component> out(front.component_count());
  for (typename Front::Slot s = 0; s < front.slot_count(); ++s) {
    // The triangles of a polygon are consecutive, so comparing with the last face removes duplicates.
    Component& c = out[front[s].component];
    if (c.faces.empty() || c.faces.back() != front[s].face) c.faces.push_back(front[s].face);
    c.box.extend(box_of(front, s));
  }
  return out;
}

/// Returns the components around each one, ascending. The first corner of a face decides, unless it is on the
/// other component's surface; if the corners of many faces are, the two have their surface in common.
std::vector<std::vector<std::uint32_t>> find_holders(const Mesh& mesh,
                                                     const std::vector<Component>& components);

/// Returns the void in front of each component of the mesh's surface: (components) itself for a void, kNull
/// for the outside. `front`: still the mesh's own surface. Exact, except that a component that crosses a
/// void's wall is located by one of its vertices.
template <class Front>
std::vector<std::uint32_t> find_nesting(const Mesh& mesh, const Front& front) {
  const std::uint32_t count = front.component_count();
  std::vector<std::uint32_t> home(count, kNull);
  // The usual case: nothing can be nested.
  if (count == 1) return home;
  const std::vector<Component> components = components_of(front);
  // Exact sign of the volume: a component that faces inward bounds a void.
  std::vector<bool> is_void(count);
  for (std::uint32_t c = 0; c < count; ++c) is_void[c] = volume_sign(mesh, components[c].faces) < 0;
  const auto holders = find_holders(mesh, components);
  const auto is_inside = [&](std::uint32_t inner, std::uint32_t outer) {
    return std::binary_search(holders[inner].begin(), holders[inner].end(), outer);
  };
  for (std::uint32_t c = 0; c < count; ++c) {
    // A void is its own home: its front faces the space inside it.
    if (is_void[c]) {
      home[c] = c;
      continue;
    }
    // The innermost void around it is inside all others.
    for (const std::uint32_t v : holders[c])
      if (is_void[v] && (home[c] == kNull || is_inside(v, home[c]))) home[c] = v;
  }
  return home;
}

inline std::uint32_t face_count(const FrontMesh& front) {
  return front.triangle_count();
}
inline std::uint32_t face_count(const FrontLoops& front) {
  return front.segment_count();
}
inline VertexId first_corner(const FrontMesh& front, FrontMesh::Slot s) {
  return front.point(front[s].v[0]).id;
}
inline VertexId first_corner(const FrontLoops& front, FrontLoops::Slot s) {
  return front[s].a;
}

/// The part of a builder that covers entire fronts.
template <class Front>
class WholeFronts {
 protected:
  using Slot = typename Front::Slot;

  WholeFronts(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options)
      : options_(options),
        front_(mesh),
        complex_(mesh),
        home_(find_nesting(mesh, front_)),
        frozen_(mesh.face_count(), false),
        component_boxes_(front_.component_count()),
        passes_(options) {
    // Faces that intersect others are never covered: embedding can be proven only for the others.
    for (const FaceId f : meeting) frozen_[f] = true;
    for (Slot s = 0; s < front_.slot_count(); ++s)
      component_boxes_[front_[s].component].extend(box_of(front_, s));
  }
  virtual ~WholeFronts() = default;

  /// Return the vertices of the outer fronts; a convex wrapper around points, without faces if there is none;
  /// whether the wrapper strictly contains a point (exact).
  virtual std::vector<Eigen::Vector3d> outer_points() const = 0;
  virtual Mesh wrapper_around(std::span<const Eigen::Vector3d> points) = 0;
  virtual bool wrapper_holds(const Eigen::Vector3d& point) const = 0;

  bool is_outer(Slot s) const { return front_.alive(s) && home_[front_[s].component] == kNull; }

  std::uint32_t outer_size() const {
    std::uint32_t count = 0;
    FaceId last = kNull;
    for (Slot s = 0; s < front_.slot_count(); last = front_[s++].face)
      count += is_outer(s) && (!options_.merge_planes || front_[s].face != last);
    return count;
  }

  std::uint32_t wrapper_size() const { return static_cast<std::uint32_t>(wrapper_.face_count()); }

  /// Reports a cap of `faces` faces over the entire outer front to the probe, and the number of faces that it
  /// covers.
  void report_whole_cap(std::uint32_t faces, std::uint32_t covered, CapVerdict verdict) const {
    if (!options_.probe) return;
    Slot first = 0;
    while (!is_outer(first)) ++first;
    options_.probe->patch({first_corner(front_, first), outer_size(), 0});
    options_.probe->cap({faces, covered, verdict, false, -1});
  }

  /// Makes the remainder of each void one region with a floor but no lid.
  void fill() {
    const std::uint32_t before = complex_.region_count(), faces = face_count(front_);
    fill_voids(front_, home_, passes_.layer(), complex_);
    if (complex_.region_count() == before) return;
    passes_.report_begin(BuildStage::fill, faces);
    passes_.report_regions(complex_, before);
    passes_.report_end({.front_faces = outer_size()});
  }

  /// Fills the voids, and closes with the outermost wrapper unless the front has few enough faces.
  LrbData finish(std::uint32_t max_outer) {
    fill();
    const std::uint32_t outer = outer_size();
    const bool is_closed = outer > max_outer && close();
    if (options_.probe) options_.probe->closed(is_closed ? wrapper_size() : outer);
    return complex_.finish(true, false);
  }

  void end_pass() { passes_.end_pass(complex_, face_count(front_)); }

  const BuildOptions& options_;
  Front front_;
  ComplexBuilder complex_;
  const std::vector<std::uint32_t> home_;  ///< (components) see find_nesting()
  std::vector<bool> frozen_;               ///< (|real faces|) true for faces that are never covered
  std::vector<Eigen::AlignedBox3d> component_boxes_;
  Mesh wrapper_;  ///< the outermost one; empty until planned
  PassCounter passes_;

 private:
  /// Puts the outermost wrapper around the front, as the outer boundary of one last region. Returns false if
  /// no wrapper is found.
  bool close() {
    const std::uint32_t outer = outer_size(), before = complex_.region_count();
    passes_.report_begin(BuildStage::close, outer);
    const CapVerdict verdict = find_closing();
    report_whole_cap(wrapper_size(), outer, verdict);
    const bool accepted = verdict == CapVerdict::accepted;
    if (accepted) enclose(front_, home_, wrapper_, passes_.layer(), complex_);
    passes_.report_regions(complex_, before);
    passes_.report_end({.front_faces = accepted ? wrapper_size() : outer});
    if (accepted) end_pass();
    return accepted;
  }

  CapVerdict find_closing() {
    const std::vector<Eigen::Vector3d> points = outer_points();
    const auto holds_all = [&] {
      return std::all_of(points.begin(), points.end(), [&](const auto& p) { return wrapper_holds(p); });
    };
    // The planned wrapper usually still contains the front. Rounding or bridging may have moved the front
    // outside: plan again.
    if (wrapper_size() == 0 || !holds_all()) wrapper_ = wrapper_around(points);
    if (wrapper_size() == 0) return CapVerdict::too_far_out;
    // The final confirmation is exact.
    return holds_all() ? CapVerdict::accepted : CapVerdict::leaves_out;
  }
};

}  // namespace lrb::construct
