#include "engine/construct/complex_builder.hpp"

namespace lrb::construct {

ComplexBuilder::ComplexBuilder(int dim, std::string name) {
  d_.dim = dim;
  d_.name = std::move(name);
}

ComplexBuilder::ComplexBuilder(const Mesh& mesh) : ComplexBuilder(mesh.dim, mesh.name) {
  // A mesh is a complex without regions: every face separates the solid from the outside.
  d_.vertices = mesh.vertices;
  d_.face_offsets = mesh.face_offsets;
  d_.face_vertices = mesh.face_vertices;
  d_.inner_cell.assign(mesh.face_count(), kSolid);
  d_.outer_cell.assign(mesh.face_count(), kOutside);
}

VertexId ComplexBuilder::add_vertex(const Eigen::Vector3d& p) {
  d_.vertices.push_back(p);
  return static_cast<VertexId>(d_.vertices.size() - 1);
}

RegionId ComplexBuilder::add_region(std::uint16_t layer) {
  d_.region_layer.push_back(layer);
  return RegionId(region_count() - 1);
}

FaceId ComplexBuilder::add_real_face(std::span<const VertexId> corners, CellId outer) {
  return add_face(corners, kSolid, outer);
}

FaceId ComplexBuilder::add_pseudo_face(std::span<const VertexId> corners, RegionId inner, CellId outer) {
  return add_face(corners, inner, outer);
}

FaceId ComplexBuilder::add_face(std::span<const VertexId> corners, CellId inner, CellId outer) {
  // Compressed rows: the corners of all faces in one array, delimited by offsets.
  d_.face_vertices.insert(d_.face_vertices.end(), corners.begin(), corners.end());
  d_.face_offsets.push_back(static_cast<std::uint32_t>(d_.face_vertices.size()));
  d_.inner_cell.push_back(inner);
  d_.outer_cell.push_back(outer);
  return FaceId(face_count() - 1);
}

LrbData ComplexBuilder::finish(bool closed, bool self_intersecting) {
  d_.closed = closed;
  d_.self_intersecting = self_intersecting;
  // Stable partition in two passes: real faces first, both kinds in the order of their creation.
  ComplexBuilder sorted(d_.dim);
  for (const bool real : {true, false}) {
    for (FaceId f = 0; f < face_count(); ++f)
      if ((d_.inner_cell[f] == kSolid) == real)
        sorted.add_face(d_.face(f), d_.inner_cell[f], d_.outer_cell[f]);
    if (real) d_.real_face_count = sorted.face_count();
  }
  // Only the face arrays change; vertices and regions keep their numbers.
  d_.face_offsets = std::move(sorted.d_.face_offsets);
  d_.face_vertices = std::move(sorted.d_.face_vertices);
  d_.inner_cell = std::move(sorted.d_.inner_cell);
  d_.outer_cell = std::move(sorted.d_.outer_cell);
  return std::exchange(d_, LrbData{});
}

}  // namespace lrb::construct
