#include "scenarios/methods/body_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "engine/core/error.hpp"

namespace lrb::methods {

Triangles triangles_of(const LrbRep& rep) {
  if (rep.dim() != 3) throw InputError("a 2D body: not asked, because it answers for 3D bodies only");
  Triangles t;
  t.vertices.assign(rep.vertices().begin(), rep.vertices().end());
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    std::array<VertexId, 3> corners{};
    rep.simplex(s, corners.data());
    t.triangles.push_back(corners);
  }
  return t;
}

void check_fits_float(const Triangles& t) {
  for (const Eigen::Vector3d& v : t.vertices)
    if (!(v.cwiseAbs().maxCoeff() <= static_cast<double>(std::numeric_limits<float>::max())))
      throw InputError("a coordinate beyond the range of float: not asked");
}

void check_rigid(const Pose& pose) {
  // Rotations come rounded, perhaps as products of several. This limit lies far above their errors, and far
  // below any stretch that is meant.
  static constexpr double kRotationDefect = 1e-9;
  const Eigen::Matrix3d defect = pose.r * pose.r.transpose() - Eigen::Matrix3d::Identity();
  if (defect.cwiseAbs().maxCoeff() > kRotationDefect || pose.r.determinant() < 0)
    throw InputError("a pose that is not a rotation and a translation: not asked");
}

Mesh real_mesh(const LrbRep& rep) {
  Mesh m;
  m.dim = rep.dim();
  m.name = rep.name();
  std::vector<VertexId> renamed(rep.vertices().size(), kNull);
  std::vector<VertexId> corners;
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    corners.clear();
    for (const VertexId v : rep.face(f)) {
      if (renamed[v] == kNull) {
        renamed[v] = static_cast<VertexId>(m.vertices.size());
        m.vertices.push_back(rep.vertices()[v]);
      }
      corners.push_back(renamed[v]);
    }
    m.add_face(corners);
  }
  return m;
}

LrbRep at_pose(const LrbRep& rep, const Pose& pose) {
  Mesh m = real_mesh(rep);
  for (Eigen::Vector3d& v : m.vertices) v = pose.apply(v);
  return LrbRep::without_regions(m, rep.closed(), rep.self_intersecting());
}

void sort_pairs(std::vector<SimplexPair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace lrb::methods
