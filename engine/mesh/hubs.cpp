#include "engine/mesh/hubs.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/mesh/face_pairs.hpp"

namespace lrb {
namespace {

/// Returns a box of all directions from corner v to points of a convex face: an arc of at most half a circle
/// between the directions to the adjacent corners. For chord length c the distance between arc and chord is
/// at most 1 - sqrt(1 - c^2 / 4) <= c^2 / 4. A coordinate of a computed direction has an error below 2^-50:
/// differences of doubles and the normalisation have relative errors of a few 2^-53.
Box directions(const Mesh& mesh, FaceId f, VertexId v) {
  constexpr double kRoom = 0x1p-45;
  const auto corners = mesh.face(f);
  const std::size_t n = corners.size();
  const auto at = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
  const Eigen::Vector3d centre = mesh.vertices[v];
  // Directions to both neighbours of v in the face: the ends of the arc.
  const Eigen::Vector3d p = (mesh.vertices[corners[(at + 1) % n]] - centre).stableNormalized(),
                        q = (mesh.vertices[corners[(at + n - 1) % n]] - centre).stableNormalized();
  const auto is_direction = [](const Eigen::Vector3d& d) {  // excludes overflow and neighbours that coincide
                                                            // with v
    return d.allFinite() && std::abs(squared_norm3(d) - 1) < 0x1p-40;
  };
  // No usable direction: a box around the entire sphere, which overlaps all others.
  if (!is_direction(p) || !is_direction(q))
    return {Eigen::Vector3d::Constant(-2), Eigen::Vector3d::Constant(2)};
  // The chord's box, enlarged by the bound on the distance between arc and chord.
  Box box(p);
  box.extend(q);
  const Eigen::Vector3d room = Eigen::Vector3d::Constant(squared_norm3(p - q) / 4 + kRoom);
  return {box.min() - room, box.max() + room};
}

}  // namespace

Hubs::Hubs(const Mesh& mesh, const std::vector<FaceUse>& use) {
  if (mesh.dim == 2) return;
  // Valence of each vertex among convex faces. The argument about arcs does not apply to others.
  std::vector<std::uint32_t> degree(mesh.vertices.size(), 0);
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    if (use[f] == FaceUse::convex)
      for (const VertexId v : mesh.face(f)) ++degree[v];
  std::map<VertexId, std::uint32_t> number;
  for (VertexId v = 0; v < degree.size(); ++v) {
    if (degree[v] <= kFewNeighbours) continue;
    number.emplace(v, static_cast<std::uint32_t>(hubs.size()));
    hubs.push_back({v, {}});
  }
  if (hubs.empty()) return;
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    if (use[f] != FaceUse::convex) continue;
    // Each face is assigned to its corner of highest valence, where most of its pairs are.
    VertexId best = kNull;
    for (const VertexId v : mesh.face(f))
      if (degree[v] > kFewNeighbours &&
          (best == kNull || degree[v] > degree[best] || (degree[v] == degree[best] && v < best)))
        best = v;
    if (best != kNull) hubs[number[best]].faces.push_back(f);
  }
}

void for_each_pair_at(const Mesh& mesh, const Hubs::Hub& hub,
                      const std::function<void(FaceId, FaceId)>& visit, Workers& workers) {
  // Pairs of arcs by an AABB tree of boxes on the unit sphere.
  std::vector<Box> arcs;
  arcs.reserve(hub.faces.size());
  for (const FaceId f : hub.faces) arcs.push_back(directions(mesh, f, hub.vertex));
  BoxTree(arcs).for_each_pair([&](std::uint32_t i, std::uint32_t j) { visit(hub.faces[i], hub.faces[j]); },
                              workers);
}

// Oriented boxes along the principal axes of points, and their separating axis test (Gottschalk, Lin and
// Manocha 1996, "OBBTree"), with a margin for rounding, so that a separation is proven.

namespace {

/// Margin for rounding, in the unit cube. Scaled positions have errors of 2^-52, the axes of the eigenvalue
/// solver are perpendicular to a few units in the last place, and a sum of three products of numbers below 2
/// has an error below 2^-49. In total that is below 2^-46: a position is within kRoom of its box, and each
/// value computed by proven_disjoint() is within kRoom of the exact one. For nearly parallel axes the cross
/// product is close to 0, and then nothing exceeds the margin.
constexpr double kRoom = 0x1p-40;

int exponent_of(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return x > 0 ? exponent : 0;
}

Eigen::Matrix3d principal_axes(std::span<const Eigen::Vector3d> points) {
  // Covariance about the mean; weights before summation keep all terms within the unit cube.
  const double weight = 1.0 / static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += weight * p;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) covariance += weight * (p - mean) * (p - mean).transpose();
  const Eigen::Matrix3d axes = eigenvectors_of_symmetric(covariance).transpose();
  // The axes must be orthonormal to rounding. If the solver failed, use the coordinate axes.
  const double defect = (axes * axes.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return defect < 0x1p-48 ? axes : Eigen::Matrix3d::Identity();  // NaN: false
}

}  // namespace

UnitCube::Scale UnitCube::Scale::by(int exponent) {
  return {std::ldexp(1.0, exponent / 2), std::ldexp(1.0, exponent - exponent / 2)};
}

UnitCube::UnitCube(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return;
  // Scale all coordinates below 1, so that the differences below cannot overflow.
  const double largest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  first_ = Scale::by(-exponent_of(largest));
  const Eigen::Vector3d low = first_(box.min()), high = first_(box.max());
  // Then centre them and scale again, so that the box fills the cube.
  centre_ = 0.5 * (low + high);
  last_ = Scale::by(-exponent_of((high - centre_).cwiseMax(centre_ - low).maxCoeff()));
}

Eigen::Vector3d UnitCube::operator()(const Eigen::Vector3d& x) const {
  return last_(first_(x) - centre_);
}

OrientedBox OrientedBox::about(std::span<const Eigen::Vector3d> points) {
  OrientedBox box;
  box.axes = principal_axes(points);
  // Interval of the projections on each axis.
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = -low;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d along = box.axes * p;
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  box.centre = box.axes.transpose() * (0.5 * (low + high));
  box.half = (0.5 * (high - low)).array() + kRoom;
  return box;
}

bool proven_disjoint(const OrientedBox& a, const OrientedBox& b) {
  // Rotation from b to a, its absolute values, and the offset of the centres in both frames.
  const Eigen::Vector3d between = b.centre - a.centre;
  const Eigen::Matrix3d turn = a.axes * b.axes.transpose(), size = turn.cwiseAbs();
  const Eigen::Vector3d seen_by_a = a.axes * between, seen_by_b = b.axes * between;
  // Face normals of a and of b: 6 axes.
  for (int i = 0; i < 3; ++i) {
    if (std::abs(seen_by_a[i]) > a.half[i] + dot3(size.row(i), b.half) + kRoom) return true;
    if (std::abs(seen_by_b[i]) > b.half[i] + dot3(size.col(i), a.half) + kRoom) return true;
  }
  // Cross products of an axis of a and one of b: 9 axes. Without normalisation, which only makes the test
  // more conservative.
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int m = 0; m < 3; ++m) {  // the direction a.axes[i] x b.axes[m], in coordinates of a
      const int n = (m + 1) % 3, o = (m + 2) % 3;
      const double distance = std::abs(seen_by_a[k] * turn(j, m) - seen_by_a[j] * turn(k, m));
      const double reach =
          a.half[j] * size(k, m) + a.half[k] * size(j, m) + b.half[n] * size(i, o) + b.half[o] * size(i, n);
      if (distance > reach + kRoom) return true;
    }
  }
  return false;
}

TriangleTree::TriangleTree(const Mesh& mesh, const UnitCube& cube, std::span<const Triangle> triangles,
                           std::uint32_t leaf_size) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const VertexId v : triangles[i]) boxes[i].extend(cube(mesh.vertices[v]));
  tree_ = BoxTree(boxes, leaf_size);
  for (const std::uint32_t i : tree_.items()) triangles_.push_back(triangles[i]);
  // An oriented box around the corners of all triangles beneath each node.
  for (std::uint32_t n = 0; n < tree_.nodes().size(); ++n) {
    std::vector<Eigen::Vector3d> points;
    for (const Triangle& t : triangles_of(n))
      for (const VertexId v : t) points.push_back(cube(mesh.vertices[v]));
    boxes_.push_back(OrientedBox::about(points));
  }
}

}  // namespace lrb
