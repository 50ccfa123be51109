#include "render/findings_parts.hpp"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "engine/core/disjoint_sets.hpp"

namespace lrb::render::findings {

using Eigen::Vector3d;

Parts parts_of(const Mesh& mesh, MeshFault kind, const Element& e) {
  switch (kind) {
    case MeshFault::open_edge:
    case MeshFault::non_manifold_edge:
      if (e[1] == kNull) return {{}, {VertexId(e[0])}, false};
      return {{}, {VertexId(e[0]), VertexId(e[1])}, true};
    case MeshFault::non_manifold_vertex:
    case MeshFault::unused_vertex:
      return {{}, {VertexId(e[0])}, false};
    case MeshFault::duplicate_vertex:
      return {{}, {VertexId(e[0]), VertexId(e[1])}, false};
    case MeshFault::duplicate_face:
    case MeshFault::flipped_face:
    case MeshFault::self_intersection:
      return {{FaceId(e[0]), FaceId(e[1])}, {}, false};
    case MeshFault::inside_out:
      return {component(mesh, FaceId(e[0])), {}, false};
    default:
      return {{FaceId(e[0])}, {}, false};
  }
}

std::string number_of(MeshFault kind, const Element& e) {
  std::string a = std::to_string(e[0]);
  const std::string b = std::to_string(e[1]);
  switch (kind) {
    case MeshFault::open_edge:
    case MeshFault::non_manifold_edge:
      return e[1] == kNull ? a : a + "-" + b;
    case MeshFault::duplicate_vertex:
    case MeshFault::duplicate_face:
    case MeshFault::flipped_face:
    case MeshFault::self_intersection:
      return a + " + " + b;
    default:
      return a;
  }
}

std::vector<Vector3d> corners(const Mesh& mesh, FaceId f) {
  std::vector<Vector3d> x;
  for (const VertexId v : mesh.face(f)) x.push_back(mesh.vertices[v]);
  return x;
}

Vector3d normal(const Mesh& mesh, FaceId f) {
  const std::vector<Vector3d> x = corners(mesh, f);
  Vector3d n = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < x.size(); ++i) n += (x[i] - x[0]).cross(x[i + 1] - x[0]);
  return n;
}

std::vector<FaceId> component(const Mesh& mesh, FaceId first) {
  // Components by shared vertices.
  DisjointSets sets(mesh.vertices.size());
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    for (const VertexId v : mesh.face(f)) sets.join(mesh.face(f)[0], v);
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    if (sets.leader(mesh.face(f)[0]) == sets.leader(mesh.face(first)[0])) faces.push_back(f);
  return faces;
}

namespace {

/// A cut shorter than this share of the faces' sizes is ignored: faces in one plane seem to cross in specks
/// once their coordinates are rounded.
constexpr double kLeastCut = 1e-6;

using Triangle = std::array<Vector3d, 3>;

/// Returns the point in which a segment passes through a triangle.
std::optional<Vector3d> passage(const Vector3d& p, const Vector3d& q, const Triangle& b) {
  const Vector3d n = (b[1] - b[0]).cross(b[2] - b[0]);
  // Signed distances of the ends from the plane; on the same side there is no crossing.
  const double dp = n.dot(p - b[0]), dq = n.dot(q - b[0]);
  if ((dp > 0) == (dq > 0) || dp == dq) return std::nullopt;
  const Vector3d x = p + dp / (dp - dq) * (q - p);
  // Inside if to the left of all three edges. Floating point: pictures only.
  for (std::size_t k = 0; k < 3; ++k)
    if (n.dot((b[(k + 1) % 3] - b[k]).cross(x - b[k])) < 0) return std::nullopt;
  return x;
}

void add_cuts(const Triangle& a, const Triangle& b, std::vector<Vector3d>& out) {
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto x = passage(a[i], a[(i + 1) % 3], b)) out.push_back(*x);
}

}  // namespace

bool passes_through(const Mesh& mesh, FaceId f, const Vector3d& from, const Vector3d& to) {
  const std::vector<Vector3d> x = corners(mesh, f);
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    if (passage(from, to, {x[0], x[i], x[i + 1]})) return true;
  return false;
}

std::vector<Vector3d> cut(const Mesh& mesh, FaceId f, FaceId g) {
  const std::vector<Vector3d> x = corners(mesh, f), y = corners(mesh, g);
  std::vector<Vector3d> found;
  // Segments: Cramer's rule, parallel ones have no single point.
  if (mesh.dim == 2) {
    const Vector3d u = x[1] - x[0], v = y[1] - y[0];
    const double turn = u.cross(v).z();
    if (turn != 0) found.push_back(x[0] + (y[0] - x[0]).cross(v).z() / turn * u);
    return found;
  }
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    for (std::size_t k = 1; k + 1 < y.size(); ++k) {
      // Edges of each triangle through the other one. The cut of two triangles is a segment between two of
      // these points.
      add_cuts({x[0], x[i], x[i + 1]}, {y[0], y[k], y[k + 1]}, found);
      add_cuts({y[0], y[k], y[k + 1]}, {x[0], x[i], x[i + 1]}, found);
    }
  if (found.size() < 2) return {};
  const auto far = [](const Vector3d& from, const std::vector<Vector3d>& points) {
    return *std::max_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
      return (p - from).squaredNorm() < (q - from).squaredNorm();
    });
  };
  // The points are collinear up to rounding, so two steps find both ends.
  const Vector3d one = far(found[0], found), other = far(one, found);
  const double size = (x[1] - x[0]).norm() + (y[1] - y[0]).norm();
  if (!((other - one).norm() > kLeastCut * size)) return {};
  return {one, other};
}

}  // namespace lrb::render::findings
