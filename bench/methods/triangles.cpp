#include "bench/methods/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/error.hpp>

namespace lrb::methods {

Triangles triangles_of(const LrbRep& rep) {
  if (rep.dim() != 3) throw InputError("skipped: a 2D body, but the method supports only 3D");
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
      throw InputError("skipped: a coordinate exceeds the range of float");
}

void check_rigid(const Pose& pose) {
  // Rotations are rounded, perhaps as products of several. This limit is far above their errors, and far
  // below any intended stretch.
  static constexpr double kRotationDefect = 1e-9;
  const Eigen::Matrix3d defect = pose.r * pose.r.transpose() - Eigen::Matrix3d::Identity();
  if (defect.cwiseAbs().maxCoeff() > kRotationDefect || pose.r.determinant() < 0)
    throw InputError("skipped: a pose that is not a rigid motion");
}

Mesh part_of(const Mesh& mesh, const std::function<bool(FaceId)>& keep) {
  Mesh out;
  out.dim = mesh.dim;
  out.name = mesh.name;
  std::vector<VertexId> renamed(mesh.vertices.size(), kNull);
  std::vector<VertexId> corners;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    if (!keep(f)) continue;
    corners.clear();
    for (const VertexId v : mesh.face(f)) {
      if (renamed[v] == kNull) {
        renamed[v] = static_cast<VertexId>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      corners.push_back(renamed[v]);
    }
    out.add_face(corners);
  }
  return out;
}

Mesh real_mesh(const LrbRep& rep) {
  return part_of(rep.real_mesh(), [](FaceId) { return true; });
}

Mesh simplices_of(const LrbRep& rep) {
  Mesh out;
  out.dim = rep.dim();
  out.vertices.assign(rep.vertices().begin(), rep.vertices().end());
  VertexId v[3] = {};
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    rep.simplex(s, v);
    out.add_face({v, static_cast<std::size_t>(out.dim)});
  }
  return out;
}

Mesh at_pose(Mesh mesh, const Pose& pose) {
  for (Eigen::Vector3d& v : mesh.vertices) v = pose.apply(v);
  return mesh;
}

LrbRep at_pose(const LrbRep& rep, const Pose& pose) {
  return LrbRep::without_regions(at_pose(real_mesh(rep), pose), rep.closed(), rep.self_intersecting());
}

Mesh joined(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  return shapes::several({at_pose(simplices_of(a), pose_a), at_pose(simplices_of(b), pose_b)});
}

LrbRep union_of(const Question& question) {
  const LrbRep &a = question.a, &b = question.b;
  return LrbRep::without_regions(joined(a, Pose{}, b, Pose{}), a.closed() && b.closed(), true);
}

std::array<Eigen::Vector3d, 3> corners_of(const LrbRep& rep, const Pose& pose, SimplexId s) {
  VertexId v[3] = {};
  rep.simplex(s, v);
  return {pose.apply(rep.vertices()[v[0]]), pose.apply(rep.vertices()[v[1]]),
          pose.apply(rep.vertices()[v[2]])};
}

void add_near(Answer& answer, SimplexPair pair, double distance) {
  answer.pairs.push_back(pair);
  answer.distances.push_back(distance);
}

void sort_near(Answer& answer) {
  std::vector<std::pair<SimplexPair, double>> both;
  for (std::size_t i = 0; i < answer.pairs.size(); ++i)
    both.emplace_back(answer.pairs[i], answer.distances[i]);
  std::sort(both.begin(), both.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  for (std::size_t i = 0; i < both.size(); ++i) std::tie(answer.pairs[i], answer.distances[i]) = both[i];
}

void sort_pairs(std::vector<SimplexPair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double snapped(double x) {
  return std::abs(x) < kUsualEpsilon ? 0 : x;
}

double side(const Vector2d& p, const Vector2d& q, const Vector2d& r) {
  return snapped((q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x()));
}

bool intervals_meet(double p, double q, double r, double s) {
  return std::max(std::min(p, q), std::min(r, s)) <= std::min(std::max(p, q), std::max(r, s));
}

bool segments_meet(const Vector2d& p, const Vector2d& q, const Vector2d& r, const Vector2d& s) {
  const double r_side = side(p, q, r), s_side = side(p, q, s);
  const double p_side = side(r, s, p), q_side = side(r, s, q);
  if (r_side == 0 && s_side == 0)
    return intervals_meet(p.x(), q.x(), r.x(), s.x()) && intervals_meet(p.y(), q.y(), r.y(), s.y());
  return r_side * s_side <= 0 && p_side * q_side <= 0;
}

bool holds(const std::array<Vector2d, 3>& t, const Vector2d& p) {
  const double u = side(t[0], t[1], p), v = side(t[1], t[2], p), w = side(t[2], t[0], p);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// Tests coplanar triangles, projected along the axis of the normal's largest component.
bool coplanar_meet(const Vector3d& normal, const Vector3d a[3], const Vector3d b[3]) {
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  const Eigen::Index x = (drop + 1) % 3, y = (drop + 2) % 3;
  std::array<Vector2d, 3> p, q;
  for (int i = 0; i < 3; ++i) {
    p[i] = {a[i][x], a[i][y]};
    q[i] = {b[i][x], b[i][y]};
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (segments_meet(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3])) return true;
  return holds(p, q[0]) || holds(q, p[0]);
}

struct Plane {
  explicit Plane(const Vector3d t[3]) : normal((t[1] - t[0]).cross(t[2] - t[0])), offset(-normal.dot(t[0])) {}
  std::array<double, 3> distances(const Vector3d t[3]) const {
    std::array<double, 3> d{};
    for (int i = 0; i < 3; ++i) d[i] = snapped(normal.dot(t[i]) + offset);
    return d;
  }
  Vector3d normal;
  double offset;
};

bool one_side(const std::array<double, 3>& d) {
  return d[0] * d[1] > 0 && d[0] * d[2] > 0;
}

/// Returns the corner that is alone on its side of the other triangle's plane, or on the plane if the others
/// share a side.
int lone_corner(const std::array<double, 3>& d) {
  if (d[0] * d[1] > 0) return 2;
  if (d[0] * d[2] > 0) return 1;
  if (d[1] * d[2] > 0 || d[0] != 0) return 0;
  return d[1] != 0 ? 1 : 2;
}

/// Returns the interval in which a triangle cuts the common line, along one of its coordinates.
std::array<double, 2> interval(const Vector3d t[3], const std::array<double, 3>& d, Eigen::Index axis) {
  const int lone = lone_corner(d);
  std::array<double, 2> ends{};
  for (int k = 0; k < 2; ++k) {
    const int other = (lone + 1 + k) % 3;
    ends[k] = t[lone][axis] + (t[other][axis] - t[lone][axis]) * d[lone] / (d[lone] - d[other]);
  }
  return ends;
}

}  // namespace

bool plain_triangles_meet(const Vector3d a[3], const Vector3d b[3]) {
  const Plane plane_a(a), plane_b(b);
  const std::array<double, 3> of_b = plane_a.distances(b);
  if (one_side(of_b)) return false;
  const std::array<double, 3> of_a = plane_b.distances(a);
  if (one_side(of_a)) return false;
  const auto flat = [](const std::array<double, 3>& d) { return d[0] == 0 && d[1] == 0 && d[2] == 0; };
  if (flat(of_a) || flat(of_b)) return coplanar_meet(plane_a.normal, a, b);
  Eigen::Index axis = 0;
  plane_a.normal.cross(plane_b.normal).cwiseAbs().maxCoeff(&axis);
  const std::array<double, 2> p = interval(a, of_a, axis), q = interval(b, of_b, axis);
  return intervals_meet(p[0], p[1], q[0], q[1]);
}

bool plain_segments_meet(const Vector3d a[2], const Vector3d b[2]) {
  return segments_meet(a[0].head<2>(), a[1].head<2>(), b[0].head<2>(), b[1].head<2>());
}

}  // namespace lrb::methods
