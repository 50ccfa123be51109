// Estimates the deviation of a cap during its simplification. There are three tests for each collapse: at the
// new vertex, above the covered vertices of the patch, and at sample points of each new triangle.

#include "engine/construct/cap_gauge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/mesh/nearest_on_simplex.hpp"

namespace lrb::construct {

using Eigen::Vector3d;

void CapGauge::load(const FrontMesh& front, const Patch& patch, const CapSurface& cap, double most) {
  floor_.load(front, patch, most);
  most_ = most;
  // Initially each face of the cap is a triangle of the floor.
  under_.resize(cap.faces().size());
  for (std::size_t f = 0; f < under_.size(); ++f) under_[f] = static_cast<int>(f);
  cover_.assign(cap.first_new(), -1);
  face_mark_.assign(cap.faces().size(), 0);
  marker_ = 0;
}

void CapGauge::find_covered(const CapSurface& cap, const CapSurface::Star& star) {
  ++marker_;
  for (const int f : star.faces) face_mark_[f] = marker_;
  covered_.clear();
  // Old interior vertices: under a face of the star, or in the cap and removed by this collapse.
  for (int p = cap.ring_size(); p < cap.first_new(); ++p)
    if (cover_[p] >= 0 ? face_mark_[cover_[p]] == marker_ : p == star.u || (p == star.v && !cap.is_ring(p)))
      covered_.push_back(p);
}

/// Projects the rim and the covered vertices onto the star's mean plane. Returns false if the star has no
/// mean normal.
bool CapGauge::flatten(const CapSurface& cap, const CapSurface::Star& star) {
  Vector3d outward = Vector3d::Zero();
  // The area-weighted normal of the star.
  for (const int f : star.faces) outward += cap.faces()[f].plane.n * cap.faces()[f].plane.area;
  const double length = norm3(outward);
  if (!(length > 0)) return false;
  outward /= length;
  // An orthonormal frame; the axis with the smallest component makes the cross product accurate.
  int least = 0;
  outward.cwiseAbs().minCoeff(&least);
  along_x_ = normalized3(outward.cross(Vector3d::Unit(least)));
  along_y_ = outward.cross(along_x_);
  flat_rim_.clear();
  for (const auto& r : star.rim) flat_rim_.push_back(flat(cap.x(r.a)));
  flat_rim_.push_back(flat(cap.x(star.rim.back().b)));
  flat_covered_.clear();
  for (const int p : covered_) flat_covered_.push_back(flat(cap.x(p)));
  return true;
}

/// Returns the rim edge whose triangle with `centre` contains q, or if no triangle does, the edge with the
/// smallest violation.
std::size_t CapGauge::sector(const Flat& q, const Flat& centre) const {
  std::size_t best = 0;
  // Traverse the rim, reusing the cross product of each spoke with q.
  double most = -std::numeric_limits<double>::infinity();
  const double qx = q.x - centre.x, qy = q.y - centre.y;
  double ax = flat_rim_[0].x - centre.x, ay = flat_rim_[0].y - centre.y;
  double left_of_a = ax * qy - ay * qx;
  for (std::size_t k = 0; k + 1 < flat_rim_.size(); ++k) {
    const double bx = flat_rim_[k + 1].x - centre.x, by = flat_rim_[k + 1].y - centre.y;
    const double left_of_b = bx * qy - by * qx;
    // Non-negative if q is to the left of spoke a and to the right of spoke b.
    const double inside = std::min(left_of_a, -left_of_b);
    // Only sectors on the same side of the centre as q: an opposite one could have the smallest violation.
    if (ax * qx + ay * qy + bx * qx + by * qy > 0 || (qx == 0 && qy == 0)) {
      if (inside >= 0 && ax * by - ay * bx > 0) return k;
      if (inside > most) most = inside, best = k;
    }
    ax = bx, ay = by, left_of_a = left_of_b;
  }
  return best;
}

bool CapGauge::prepare(const CapSurface& cap, const CapSurface::Star& star) {
  find_covered(cap, star);
  return flatten(cap, star);
}

bool CapGauge::may_stand(const CapSurface& cap, const CapSurface::Star& star, const Vector3d& w) {
  // Test 1: the new vertex. Vertices on the ring do not move.
  int under = under_[star.faces[0]];
  if (!cap.is_ring(star.v) && !floor_.is_within(w, under)) return false;
  if (!prepare(cap, star)) return false;
  // Test 2: the height of the new surface above each covered vertex.
  const Flat centre = flat(w);
  for (std::size_t i = 0; i < covered_.size(); ++i) {
    // Height of the plane a, b, w above p. Comparing squares usually avoids the square root.
    const auto& r = star.rim[sector(flat_covered_[i], centre)];
    const Vector3d &a = cap.x(r.a), &p = cap.x(covered_[i]);
    const Vector3d normal = (cap.x(r.b) - a).cross(w - a);
    const double square = squared_norm3(normal), height = dot3(normal, w - p);  // times the normal's length
    const double left = most_ - cap.off(covered_[i]);
    if (!(square > 0) || height <= 0 || (left > 0 && height * height <= left * left * square)) continue;
    // The vertex's own bound does not suffice: search for a closer floor triangle.
    if (!floor_.is_within(p + normal * (height / square), under)) return false;
  }
  return true;
}

bool CapGauge::is_near(const CapSurface& cap, const CapSurface::Star& star, const Vector3d& w) {
  const bool open = cap.is_ring(star.v);
  // Test 3: five points of each new triangle, including its spoke.
  for (std::size_t k = 0; k < star.rim.size(); ++k) {
    const Vector3d &a = cap.x(star.rim[k].a), &b = cap.x(star.rim[k].b);
    int& under = under_[star.rim[k].face];
    if (!floor_.is_within((a + b + w) / 3, under) || !floor_.is_within(0.25 * (a + b) + 0.5 * w, under))
      return false;
    if (open && k == 0) continue;  // this spoke exists already
    for (const double share : {0.5, 0.25, 0.75})
      if (!floor_.is_within(a + share * (w - a), under)) return false;
  }
  return true;
}

void CapGauge::settle(CapSurface& cap, const CapSurface::Star& star, int w) {
  if (!cap.is_ring(w)) cap.set_off(w, floor_.off(cap.x(w)));
  const Flat centre = flat(cap.x(w));
  for (std::size_t i = 0; i < covered_.size(); ++i) {
    const int face = star.rim[sector(flat_covered_[i], centre)].face;
    cover_[covered_[i]] = face;
    raise_excess(cap, face, covered_[i]);
  }
}

/// Raises a face's excess deviation to the value shown by a vertex under it.
void CapGauge::raise_excess(CapSurface& cap, int face, int covered) const {
  // The deviation shown by p: its height below the face, plus its own deviation.
  const auto& f = cap.faces()[face];
  const Vector3d& p = cap.x(covered);
  const double height = f.plane.d - dot3(f.plane.n, p);
  const SimplexPoint foot = nearest_on_triangle(p, cap.x(f.v[0]), cap.x(f.v[1]), cap.x(f.v[2]));
  double by_corners = 0;
  for (int i = 0; i < 3; ++i) by_corners += foot.weight[i] * cap.off(f.v[i]);
  const double over = height + cap.off(covered);
  // Already covered by the interpolated corners and the excess.
  if (over <= by_corners + f.excess_deviation) return;
  const double off = std::min(over, floor_.off(p + f.plane.n * height));
  if (off - by_corners > f.excess_deviation) cap.set_excess_deviation(face, off - by_corners);
}

bool CapGauge::measure_again(CapSurface& cap) const {
  // Barycentric sample points: the centroid, and the midpoints of the edges and of the medians.
  constexpr double kAt[7][3] = {{1 / 3., 1 / 3., 1 / 3.}, {.5, .5, 0},    {0, .5, .5},   {.5, 0, .5},
                                {.5, .25, .25},           {.25, .5, .25}, {.25, .25, .5}};
  for (int f = 0; f < static_cast<int>(cap.faces().size()); ++f) {
    const auto& face = cap.faces()[f];
    if (!face.alive || face.kept >= 0) continue;
    double excess_deviation = 0;
    for (const auto& at : kAt) {
      Vector3d q = Vector3d::Zero();
      double by_corners = 0;
      for (int i = 0; i < 3; ++i) {
        q += at[i] * cap.x(face.v[i]);
        by_corners += at[i] * cap.off(face.v[i]);
      }
      const double off = floor_.off(q);
      // Written so that NaN is rejected.
      if (!(off <= most_)) return false;
      excess_deviation = std::max(excess_deviation, off - by_corners);
    }
    cap.set_excess_deviation(f, excess_deviation);
  }
  return true;
}

// Distance of points from the floor of a patch, plus the floor's own deviation: an upper estimate of the
// deviation of a cap. Bounding balls and planes cull triangles before the exact closest point is computed.

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

void PatchFloor::load(const FrontMesh& front, const Patch& patch, double most) {
  triangles_.clear();
  balls_.clear();
  most_ = most;
  for (const FrontMesh::Slot s : patch.slots) {
    Triangle t;
    std::array<double, 3> off;
    double radius_sq = 0;
    // Deviation at the corners, including the excess of the triangle.
    for (int i = 0; i < 3; ++i) {
      const FrontMesh::Point& p = front.point(front[s].v[i]);
      t.x[i] = p.x;
      off[i] = p.off + front[s].excess_deviation;
    }
    t.off = off[0];
    t.off_b = off[1] - off[0];
    t.off_c = off[2] - off[0];
    t.least = *std::min_element(off.begin(), off.end());
    t.centroid = (t.x[0] + t.x[1] + t.x[2]) / 3;
    for (const Vector3d& x : t.x) radius_sq = std::max(radius_sq, squared_norm3(x - t.centroid));
    t.radius = std::sqrt(radius_sq);
    set_weights(t);
    triangles_.push_back(t);
    // Points outside this ball cannot be within the limit by this triangle.
    const double left = most - t.least, reach = left + t.radius;
    balls_.push_back({t.centroid, left < 0 ? -1 : reach * reach});
  }
}

void PatchFloor::set_weights(Triangle& t) {
  const Vector3d ab = t.x[1] - t.x[0], ac = t.x[2] - t.x[0], normal = ab.cross(ac);
  const double square = squared_norm3(normal);
  // Degenerate: no weights, so that off_by() always computes the closest point.
  if (!(square > 0)) {
    t.normal = t.to_b = t.to_c = Vector3d::Zero();
    t.height = {0, 0, 0};
    t.weight = -1;
    return;
  }
  t.normal = normal / std::sqrt(square);
  // Gradients of the barycentric coordinates; the height of a corner is the inverse of its gradient's length.
  t.to_b = ac.cross(normal) / square;
  t.to_c = normal.cross(ab) / square;
  t.height = {1 / norm3(t.to_b + t.to_c), 1 / norm3(t.to_b), 1 / norm3(t.to_c)};
  t.weight = 1 / 3.;
}

/// Returns the deviation of q according to the triangle, or possibly infinity if it exceeds `most`.
double PatchFloor::off_by(const Triangle& t, const Vector3d& q, double most) {
  const Vector3d from_centroid = q - t.centroid;
  const double left = most - t.least, up = std::abs(dot3(t.normal, from_centroid));
  // The distance is at least the distance from the plane.
  if (up > left) return kFar;
  const double b = dot3(t.to_b, from_centroid) + t.weight, c = dot3(t.to_c, from_centroid) + t.weight;
  // The foot is in the triangle: the distance is the height.
  if (b >= 0 && c >= 0 && b + c <= 1) return up + t.off + b * t.off_b + c * t.off_c;
  // The distance within the plane is at least the distance from each edge's line that the foot is beyond.
  const double beside = std::max(std::max(-b * t.height[1], -c * t.height[2]), (b + c - 1) * t.height[0]);
  if (beside * beside + up * up > left * left) return kFar;
  // Near an edge or a corner: the closest point (Ericson 2005).
  const SimplexPoint near = nearest_on_triangle(q, t.x[0], t.x[1], t.x[2]);
  return std::sqrt(near.distance_sq) + t.off + near.weight[1] * t.off_b + near.weight[2] * t.off_c;
}

double PatchFloor::off(const Vector3d& q) const {
  double best = kFar;
  for (const Triangle& t : triangles_) {
    const double left = best - t.least, reach = left + t.radius;
    // Branch and bound over the triangles with the best value so far.
    if (left <= 0 || squared_norm3(q - t.centroid) >= reach * reach) continue;
    best = std::min(best, off_by(t, q, best));
  }
  return best;
}

bool PatchFloor::is_within(const Vector3d& q, int& first) const {
  // Coherence: the triangle that proved the last query for this face usually proves the next.
  if (shows(first, q)) return true;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!shows(t, q)) continue;
    first = static_cast<int>(t);
    return true;
  }
  return false;
}

}  // namespace lrb::construct
