#pragma once
/// Assembles the arrays of an LRB-rep face by face: for builders, and for generators that know their regions.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"

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
  /// Adds a face. Its corners run counter-clockwise seen from the outer cell (2D: the inner cell is on the
  /// left).
  FaceId add_real_face(std::span<const VertexId> corners, CellId outer);
  FaceId add_pseudo_face(std::span<const VertexId> corners, RegionId inner, CellId outer);
  void set_outer_cell(FaceId f, CellId outer) { d_.outer_cell[f] = outer; }
  CellId outer_cell(FaceId f) const { return d_.outer_cell[f]; }

  std::span<const Eigen::Vector3d> vertices() const { return d_.vertices; }
  std::uint32_t region_count() const { return static_cast<std::uint32_t>(d_.region_layer.size()); }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(d_.face_count()); }

  /// Returns the arrays and leaves the builder empty. `closed`, `self_intersecting`: see LrbData.
  LrbData finish(bool closed, bool self_intersecting);

 private:
  FaceId add_face(std::span<const VertexId> corners, CellId inner, CellId outer);

  LrbData d_;
};

}  // namespace lrb::construct
