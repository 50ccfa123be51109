// Outward simplification of a convex polytope, in steps of decreasing size:
// 1. Collapse edges outward, as for caps (progressive hulls, Sander et al. 2000).
// 2. Take the convex hull of the result.
// 3. Tighten: coordinate descent on the volume. One vertex at a time moves to its best position with the
// points still behind its faces.
// 4. Take the convex hull again, and repeat from 1 until there are few enough faces.

#include "engine/construct/polytope_simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/body_bounds.hpp"
#include "engine/construct/cap_surface.hpp"
#include "engine/construct/convex_hull.hpp"
#include "engine/construct/patch_cap.hpp"
#include "engine/construct/placement.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

/// The first step goes down to this many faces at once; from there each step takes away one face in
/// kStepShare.
constexpr std::size_t kTightenFrom = 100, kStepShare = 4;
/// Rounds of tightening after each step, and after the last one.
constexpr int kRounds = 3, kLastRounds = 20;

/// One step of simplification. Starts from a convex surface; `points` are to stay inside.
class PolytopeStep {
 public:
  PolytopeStep(const Mesh& convex, const std::vector<Vector3>& points) : points_(points), hull_(convex) {
    // The whole closed surface is one patch: it has no ring, and every vertex is interior.
    all_.slots = hull_.alive_slots();
    for (HullMesh::Corner v = 0; v < hull_.point_count(); ++v) all_.interior.push_back(v);
    surface_.load(hull_, all_, 0);
    Eigen::AlignedBox3d box;
    for (const Vector3& p : points) box.extend(p);
    size_sq_ = box.sizes().squaredNorm();
  }

  void collapse(std::size_t wanted_faces, double depth) {
    const BodyBounds bounds(points_, kSwell);
    // Cost only orders the collapses: the number of faces is limited, the volume is not.
    PatchCap::Limits limits;
    limits.volume = std::numeric_limits<double>::infinity();
    limits.faces = static_cast<int>(wanted_faces);
    limits.depth = depth;
    PatchCap(surface_, bounds).simplify(all_, limits);
  }

  void tighten(int rounds) {
    // Gauss-Seidel rounds over the vertices: every move reduces the volume.
    for (int round = 0; round < rounds; ++round) {
      double gain = 0;
      for (int v = 0; v < surface_.vertex_count(); ++v) {
        if (!surface_.is_used(v)) continue;
        // Only the fan of v changes. The volume changes by that of the cone over its boundary loop.
        rim_.clear();
        surface_.for_each_rim_edge(v, [&](int a, int b) { rim_.push_back({surface_.x(a), surface_.x(b)}); });
        const auto w = place();
        const double change = w ? cone_volume(*w) - cone_volume(surface_.x(v)) : 0;
        // Written so that NaN counts as no gain.
        if (!(change < 0)) continue;
        surface_.move(v, *w);
        gain -= change;
      }
      // Diminishing returns: stop before the last round.
      if (gain < kLeastGain * volume()) return;
    }
  }

  Mesh result() const {
    Mesh mesh;
    std::vector<VertexId> number(surface_.vertex_count(), kNull);
    for (const auto& f : surface_.faces()) {
      if (!f.alive) continue;
      VertexId corners[3];
      for (int i = 0; i < 3; ++i) {
        // Collapses leave unused vertices behind: copy only those with faces.
        VertexId& v = number[f.v[i]];
        if (v == kNull) {
          v = static_cast<VertexId>(mesh.vertices.size());
          mesh.vertices.push_back(surface_.x(f.v[i]));
        }
        corners[i] = v;
      }
      mesh.add_face(corners);
    }
    return mesh;
  }

 private:
  struct Edge {
    Vector3 a, b;
  };

  double volume() const {
    // Divergence theorem: signed tetrahedra from a point close to the surface, to limit cancellation.
    double sixfold = 0;
    const Vector3& origin = points_[0];
    for (const auto& f : surface_.faces())
      if (f.alive)
        sixfold += (surface_.x(f.v[0]) - origin)
                       .dot((surface_.x(f.v[1]) - origin).cross(surface_.x(f.v[2]) - origin));
    return sixfold / 6;
  }

  double cone_volume(const Vector3& w) const {
    double sixfold = 0;
    // The base of the cone is arbitrary, because only differences of these volumes are compared.
    for (const Edge& e : rim_) sixfold += (w - rim_[0].a).dot((e.a - rim_[0].a).cross(e.b - rim_[0].a));
    return sixfold / 6;
  }

  /// Returns the place where the cone over the rim has least volume. The volume falls against the sum of the
  /// rim's area vectors, so a point far along that way is projected onto what is allowed.
  std::optional<Vector3> place() {
    Vector3 centre = Vector3::Zero(), area = Vector3::Zero();
    // Work relative to the centre of the boundary loop, so that slack and depth scale with its radius.
    for (const Edge& e : rim_) centre += e.a;
    centre /= static_cast<double>(rim_.size());
    double radius_sq = 0;
    half_spaces_.clear();
    for (const Edge& e : rim_) {
      area += (e.a - centre).cross(e.b - centre);
      radius_sq = std::max(radius_sq, (e.a - centre).squaredNorm());
      // The faces over this edge must leave all points behind them.
      for (const Vector3& n : touching_normals(e)) half_spaces_.push_back({n, n.dot(e.a - centre)});
    }
    // The volume is linear in w. Its gradient is the loop's area vector, so the best w is the extreme point
    // of the allowed polyhedron against that vector. Projecting a far target approximates this linear
    // programme, and it stays bounded where the linear programme is not.
    const double radius = std::sqrt(radius_sq), length = area.norm();
    if (!(length > 0)) return std::nullopt;
    const auto w = nearest_point(area * (-kDepth * radius / length), half_spaces_, kPlacementSlack * radius);
    if (!w) return std::nullopt;
    return Vector3(*w + centre);
  }

  /// Returns the normals of the two planes that contain the edge a, b and touch the points. All points are
  /// behind a face a, b, w if for each of them w is in front of the plane a, b, p; of these planes the two
  /// outermost count.
  std::array<Vector3, 2> touching_normals(const Edge& e) const {
    const Vector3 along = e.b - e.a;
    std::array<Vector3, 2> normals = {Vector3::Zero(), Vector3::Zero()};
    // The planes through the edge form a pencil. Rotate two of them about the edge until no point is in front
    // of the first, and none behind the second. O(points) for each edge.
    for (const Vector3& p : points_) {
      const Vector3 to = p - e.a, normal = along.cross(to);
      if (normal.squaredNorm() <= kParallelSineSq * along.squaredNorm() * size_sq_) continue;  // on the edge
      if (normals[0].dot(to) > 0 || normals[0].isZero(0)) normals[0] = normal;
      if (normals[1].dot(to) < 0 || normals[1].isZero(0)) normals[1] = normal;
    }
    return {normals[0].normalized(), normals[1].normalized()};
  }

  static constexpr double kSwell = 0.4;  ///< see BodyBounds; here only to keep vertices from going far off
  /// Depth of the point that is projected in tightening, in radii of the rim.
  static constexpr double kDepth = 8;
  static constexpr double kLeastGain = 1e-3;  ///< share of the volume for which another round is worthwhile

  const std::vector<Vector3>& points_;
  HullMesh hull_;
  Patch all_;
  CapSurface surface_;
  double size_sq_;  ///< squared size of the points' box
  std::vector<Edge> rim_;
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace

Mesh simplify_polytope(const Mesh& convex, std::uint32_t max_faces, double depth) {
  Mesh mesh = convex;
  // Stop without success if a step removes no face.
  for (std::size_t before = 0; mesh.face_count() > max_faces && mesh.face_count() != before;) {
    before = mesh.face_count();
    // Large steps while there are many faces, where tightening costs much and matters little.
    const std::size_t step =
        before > kTightenFrom ? before - kTightenFrom : std::max<std::size_t>(2, before / kStepShare);
    const std::size_t wanted = std::max<std::size_t>(max_faces, before - step);
    // The points that must stay inside are always the input's, so errors do not accumulate over the steps.
    PolytopeStep fewer(mesh, convex.vertices);
    fewer.collapse(wanted, depth);
    // Moving single vertices needs a convex start, and leaves a surface that may have dents.
    PolytopeStep tighter(convex_hull_mesh(fewer.result().vertices), convex.vertices);
    tighter.tighten(wanted == max_faces ? kLastRounds : kRounds);
    mesh = convex_hull_mesh(tighter.result().vertices);
  }
  return mesh.face_count() <= max_faces ? mesh : Mesh();
}

}  // namespace lrb::construct
