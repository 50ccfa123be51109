#include "scenarios/bodies/generators/bodies.hpp"
#include "scenarios/bodies/generators/fractal.hpp"

namespace lrb::generators {

LrbRep fractal_rep(const GeneratorValues& v, std::uint64_t seed) {
  FractalSpec spec;
  spec.real_faces = static_cast<std::uint32_t>(v.at("real_faces"));
  spec.total_faces = static_cast<std::uint32_t>(v.at("total_faces"));
  spec.seed = seed;
  return fractal_body(spec);
}

/// Returns the body's real faces, without the vertices that only lids use.
Mesh fractal(const GeneratorValues& v, std::uint64_t seed) {
  const LrbRep rep = fractal_rep(v, seed);
  Mesh mesh;
  std::vector<VertexId> renumbered(rep.vertices().size(), kNull);
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    std::vector<VertexId> corners;
    for (const VertexId x : rep.face(f)) {
      if (renumbered[x] == kNull) {
        renumbered[x] = static_cast<VertexId>(mesh.vertices.size());
        mesh.vertices.push_back(rep.vertices()[x]);
      }
      corners.push_back(renumbered[x]);
    }
    mesh.add_face(corners);
  }
  return mesh;
}

}  // namespace lrb::generators
