#include "scenarios/golden/kept_body.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/fnv.hpp"
#include "render/overlay.hpp"

namespace lrb::golden {
namespace {

std::string counts_of(const Mesh& m) {
  return render::group_digits(m.vertices.size()) + " vertices and " + render::group_digits(m.face_count()) +
         " faces";
}

double diagonal_of(const Mesh& m) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : m.vertices) box.extend(v);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

std::size_t other_faces(const Mesh& x, const Mesh& y) {
  std::size_t count = 0;
  for (std::uint32_t f = 0; f < x.face_count(); ++f) {
    const auto p = x.face(FaceId(f)), q = y.face(FaceId(f));
    count += !std::equal(p.begin(), p.end(), q.begin(), q.end());
  }
  return count;
}

}  // namespace

Mesh kept_mesh(const LrbRep& rep) {
  Mesh m;
  m.dim = rep.dim();
  m.name = rep.name();
  std::uint32_t used = 0;
  for (std::uint32_t f = 0; f < rep.real_face_count(); ++f) {
    m.add_face(rep.face(FaceId(f)));
    for (const VertexId v : rep.face(FaceId(f))) used = std::max(used, v + 1u);
  }
  m.vertices.assign(rep.vertices().begin(), rep.vertices().begin() + used);
  return m;
}

std::uint64_t mesh_hash(const Mesh& mesh) {
  Fnv64 hash;
  hash.add_value(mesh.dim);
  for (const Eigen::Vector3d& v : mesh.vertices) hash.add_bytes(v.data(), 3 * sizeof(double));
  hash.add_array(mesh.face_offsets);
  hash.add_array(mesh.face_vertices);
  return hash.value();
}

std::string kept_file(std::size_t body, int dim) {
  return std::string(body == 0 ? "a" : "b") + (dim == 2 ? ".obj" : ".ply");
}

std::string mesh_difference(const Mesh& x, const Mesh& y) {
  if (x.vertices.size() != y.vertices.size() || x.face_count() != y.face_count())
    return counts_of(x) + " became " + counts_of(y);
  std::size_t moved = 0, farthest = 0;
  double most = 0;
  for (std::size_t v = 0; v < x.vertices.size(); ++v) {
    if (x.vertices[v] == y.vertices[v]) continue;
    const double by = (y.vertices[v] - x.vertices[v]).norm();
    if (moved++ == 0 || by > most) farthest = v, most = by;
  }
  const std::size_t faces = other_faces(x, y);
  if (moved == 0 && faces == 0) return {};
  std::string out;
  if (moved > 0) {
    const double share = 100 * most / diagonal_of(x);
    out = (moved == 1 ? "vertex " : render::group_digits(moved) + " vertices moved, vertex ") +
          std::to_string(farthest) + (moved == 1 ? " moved by " : " farthest, by ") +
          render::short_number(most) + " (" + render::short_number(share) + " % of the body's diagonal)";
  }
  if (faces > 0)
    out += (out.empty() ? "" : "; ") + render::group_digits(faces) +
           (faces == 1 ? " face has other corners" : " faces have other corners");
  return out;
}

}  // namespace lrb::golden
