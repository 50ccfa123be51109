#pragma once
/// Assembles the arrays of an LRB-rep face by face: for builders, and for generators that know their regions.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/construct/builders.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// Numbers vertices, regions and faces from 0 in the order in which they are added. finish() moves the real
/// faces to the front, as LrbData requires; within each kind, faces keep their order.
class ComplexBuilder {
 public:
  explicit ComplexBuilder(int dim, std::string name = {});
  /// Starts with the vertices and faces of a mesh, all real and with the outside in front.
  explicit ComplexBuilder(const Mesh& mesh);

  VertexId add_vertex(const Eigen::Vector3d& p);
  RegionId add_region(std::uint16_t layer);
  /// Adds a face. Its corners are counter-clockwise seen from the outer cell (2D: the inner cell is on the
  /// left).
  FaceId add_real_face(std::span<const VertexId> corners, CellId outer);
  FaceId add_pseudo_face(std::span<const VertexId> corners, RegionId inner, CellId outer);
  void set_outer_cell(FaceId f, CellId outer) { d_.outer_cell[f] = outer; }
  CellId outer_cell(FaceId f) const { return d_.outer_cell[f]; }

  std::span<const Eigen::Vector3d> vertices() const { return d_.vertices; }
  std::uint32_t region_count() const { return static_cast<std::uint32_t>(d_.region_layer.size()); }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(d_.face_count()); }

  /// Returns the arrays and empties the builder. `closed`, `self_intersecting`: see LrbData.
  LrbData finish(bool closed, bool self_intersecting);

 private:
  FaceId add_face(std::span<const VertexId> corners, CellId inner, CellId outer);

  LrbData d_;
};

// The regions that a builder makes of entire fronts when caps no longer simplify them, for FrontMesh and
// FrontLoops alike. `home`: (components) the void in front of a component, which is the component itself if
// it bounds a void; kNull for the outside.

/// Makes the remainder of each void one region, which has only a floor.
template <class Front>
void fill_voids(const Front& front, std::span<const std::uint32_t> home, std::uint16_t layer,
                ComplexBuilder& complex) {
  std::vector<RegionId> core(home.size(), kNull);
  for (std::uint32_t c = 0; c < core.size(); ++c)
    if (home[c] == c) core[c] = complex.add_region(layer);
  for (const typename Front::Slot s : front.alive_slots()) {
    const std::uint32_t in = home[front[s].component];
    if (in != kNull) complex.set_outer_cell(front[s].face, core[in]);
  }
}

/// Makes `wrapper` the outermost wrapper: the space between it and the outer fronts is one region.
template <class Front>
void enclose(const Front& front, std::span<const std::uint32_t> home, const Mesh& wrapper,
             std::uint16_t layer, ComplexBuilder& complex) {
  const RegionId region = complex.add_region(layer);
  for (const typename Front::Slot s : front.alive_slots())
    if (home[front[s].component] == kNull) complex.set_outer_cell(front[s].face, region);
  std::vector<VertexId> ids;
  for (const Eigen::Vector3d& v : wrapper.vertices) ids.push_back(complex.add_vertex(v));
  std::vector<VertexId> corners;
  for (FaceId f = 0; f < wrapper.face_count(); ++f) {
    corners.clear();
    for (const VertexId v : wrapper.face(f)) corners.push_back(ids[v]);
    complex.add_pseudo_face(corners, region, kOutside);
  }
}

/// Counts the passes of a builder, and reports them to its probe. A region's layer is the number of the pass
/// that made it; a pass that makes no region does not count, so that no layer is empty.
class PassCounter {
 public:
  explicit PassCounter(const BuildOptions& options) : options_(options) {}

  std::uint16_t layer() const { return static_cast<std::uint16_t>(pass_); }

  /// Reports the start of a pass.
  void report_begin(BuildStage stage, std::uint32_t front_faces, double max_deviation = 0) const {
    if (options_.probe) options_.probe->pass({stage, pass_, front_faces, max_deviation});
  }
  /// Reports its end.
  void report_end(const PassEnd& end) const {
    if (options_.probe) options_.probe->end_pass(end);
  }
  /// Reports the regions from number `first` on.
  void report_regions(const ComplexBuilder& complex, std::uint32_t first) const {
    if (!options_.probe) return;
    for (RegionId r(first); r < complex.region_count(); ++r) options_.probe->region(r);
  }

  /// Counts the pass, and reports it with the number of faces in the front.
  void end_pass(const ComplexBuilder& complex, std::uint32_t front_faces) {
    if (complex.region_count() == regions_) return;
    regions_ = complex.region_count();
    ++pass_;
    if (options_.progress) options_.progress(pass_, front_faces);
  }

 private:
  const BuildOptions& options_;
  std::uint32_t pass_ = 0;     ///< number of the next pass
  std::uint32_t regions_ = 0;  ///< number of regions before it
};

}  // namespace lrb::construct
