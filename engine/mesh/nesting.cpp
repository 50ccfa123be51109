// Orientation of closed components by nesting depth:
// 1. Candidates: component A is in B if a vertex of A is inside B (ray parity, all components in one
//    traversal).
// 2. Candidates whose surfaces cross are discarded, because neither is entirely inside the other.
// 3. A component inside an even number of others must have positive volume, at odd depth negative volume.
//
// Point location by ray parity. The exact ray predicate resolves degenerate hits by Simulation of Simplicity
// (Edelsbrunner and Muecke 1990), so each face is either crossed or not.

#include "engine/mesh/nesting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>

#include "engine/core/geometry.hpp"
#include "engine/exact/locate.hpp"
#include "engine/mesh/face_pairs.hpp"
#include "engine/mesh/self_intersections.hpp"

namespace lrb {

namespace {

/// Calls visit(hit) for each triangle of the face (2D: for the segment) until it returns false. Returns false
/// if it did. `ears`: the triangles, or none: those of the fan.
template <class Visit>
bool cast_at_face(const Mesh& mesh, FaceId f, std::span<const std::array<VertexId, 3>> ears,
                  const Eigen::Vector3d& p, Visit visit) {
  const auto corners = mesh.face(f);
  const auto point = [&](std::size_t i) { return mesh.vertices[corners[i]].data(); };
  if (mesh.dim == 2) {
    const double* const segment[2] = {point(0), point(1)};
    return visit(exact::ray_crosses_2d(p.data(), segment));
  }
  for (const auto& [a, b, c] : ears) {
    const double* const triangle[3] = {mesh.vertices[a].data(), mesh.vertices[b].data(),
                                       mesh.vertices[c].data()};
    if (!visit(exact::ray_crosses(p.data(), triangle))) return false;
  }
  for (std::size_t i = 1; ears.empty() && i + 1 < corners.size(); ++i) {
    const double* const triangle[3] = {point(0), point(i), point(i + 1)};
    if (!visit(exact::ray_crosses(p.data(), triangle))) return false;
  }
  return true;
}

}  // namespace

PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p) {
  // Every crossing toggles the side. A point on the surface itself ends the count.
  bool inside = false;
  const auto count = [&](exact::RayHit hit) {
    inside ^= hit == exact::RayHit::crosses;
    return hit != exact::RayHit::on_face;
  };
  std::vector<std::array<VertexId, 3>> triangles;
  for (const FaceId f : faces) {
    if (mesh.dim == 3) cut_polygon(mesh, f, triangles);
    if (!cast_at_face(mesh, f, triangles, p, count)) return PointSide::on_surface;
  }
  return inside ? PointSide::inside : PointSide::outside;
}

SideFinder::SideFinder(const Mesh& mesh, std::vector<std::uint32_t> surface_of_face)
    : mesh_(mesh), surface_of_face_(std::move(surface_of_face)) {
  std::vector<Box> boxes(mesh.face_count());
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    if (surface_of_face_[f] == kNull) continue;
    for (const VertexId v : mesh.face(f)) boxes[f].extend(mesh.vertices[v]);
    std::vector<std::array<VertexId, 3>> triangles;
    if (mesh.dim == 3 && mesh.face(f).size() > 3 && cut_polygon(mesh, f, triangles) == PolygonCut::ears)
      ears_.emplace(f, std::move(triangles));
  }
  tree_ = BoxTree(boxes);
}

std::vector<SideFinder::Side> SideFinder::sides(const Eigen::Vector3d& p) const {
  // One parity for each surface with a box on the ray. on_surface is final.
  std::map<std::uint32_t, PointSide> found;
  const auto cast = [&](std::uint32_t item) {
    const FaceId f(item);
    PointSide& side = found.try_emplace(surface_of_face_[f], PointSide::outside).first->second;
    const auto ears = ears_.empty() ? ears_.end() : ears_.find(f);
    const std::span<const std::array<VertexId, 3>> none;
    cast_at_face(mesh_, f, ears == ears_.end() ? none : ears->second, p, [&](exact::RayHit hit) {
      if (hit == exact::RayHit::on_face) side = PointSide::on_surface;
      if (side == PointSide::on_surface) return false;
      if (hit == exact::RayHit::crosses)
        side = side == PointSide::inside ? PointSide::outside : PointSide::inside;
      return true;
    });
  };
  // The ray runs to +x. Its origin is perturbed infinitesimally from p, which closed boxes account for.
  const double far = mesh_.dim == 2 ? kInfinity : 0;
  tree_.for_each_in(
      {Eigen::Vector3d(p.x(), p.y(), p.z() - far), Eigen::Vector3d(kInfinity, p.y(), p.z() + far)}, cast);
  // Return only surfaces that the point is in or on. The map lists them in ascending order.
  std::vector<Side> out;
  for (const auto& [surface, side] : found)
    if (side != PointSide::outside) out.push_back({surface, side});
  return out;
}

// Exact sign of an enclosed volume: a sum of determinants (divergence theorem), first in doubles with an
// error bound, then in integers if the bound cannot decide. Doubles are scaled to integers by a common power
// of two.

namespace {

using boost::multiprecision::cpp_int;

/// Calls visit(a, b, c) for each triangle of the faces; in 2D visit(a, b, b) for each segment.
template <class Visit>
void for_each_simplex(const Mesh& mesh, std::span<const FaceId> faces, Visit visit) {
  std::vector<std::array<VertexId, 3>> triangles;
  for (const FaceId f : faces) {
    const auto c = mesh.face(f);
    if (c.size() <= 3) {
      visit(c[0], c[1], c[mesh.dim - 1]);
      continue;
    }
    cut_polygon(mesh, f, triangles);
    for (const auto& t : triangles) visit(t[0], t[1], t[2]);
  }
}

/// Returns the sign computed in doubles if the sum exceeds its error bound, otherwise 0. Volumes do not
/// depend on the origin, and an origin on the body keeps the terms small.
///
/// Error, with u = 2^-53 and n terms (products of three differences): a difference has relative error u, a
/// term has three of those and two of its own, and summation of n terms up to n - 1. The total is below (n +
/// 8) u times the sum of the terms' absolute values. The bound is twice that, which covers the rounding of
/// that sum itself and underflow: with differences below kLarge, underflow changes a term by at most 2^-1075
/// kLarge, and all 2^35 terms by less than 2^-800, while the bound is above 2^-750 if the sum is above kTiny.
int sign_by_doubles(const Mesh& mesh, std::span<const FaceId> faces) {
  const Eigen::Vector3d& origin = mesh.vertices[mesh.face(faces[0])[0]];
  double sum = 0, size = 0, n = 0, largest = 0;
  const auto term = [&](double x, double y, double z) {
    sum += x * y * z;
    size += std::abs(x * y * z);
  };
  // Determinant of three edges from the origin, expanded to six products. In 2D the third is the unit vector
  // along z.
  for_each_simplex(mesh, faces, [&](VertexId ia, VertexId ib, VertexId ic) {
    const Eigen::Vector3d a = mesh.vertices[ia] - origin, b = mesh.vertices[ib] - origin;
    const Eigen::Vector3d c = mesh.dim == 2 ? Eigen::Vector3d(0, 0, 1) : mesh.vertices[ic] - origin;
    term(a.x(), b.y(), c.z());
    term(-a.y(), b.x(), c.z());
    term(a.y(), b.z(), c.x());
    term(-a.z(), b.y(), c.x());
    term(a.z(), b.x(), c.y());
    term(-a.x(), b.z(), c.y());
    largest = std::max({largest, a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
    n += 6;
  });
  static constexpr double kU = 0x1p-53, kTiny = 0x1p-700, kLarge = 0x1p200;
  const double bound = 2 * (n + 8) * kU * size;
  // Outside this range underflow or overflow could invalidate the bound. Also catches NaN.
  if (!(size > kTiny) || !(largest < kLarge)) return 0;
  if (sum > bound) return 1;
  return sum < -bound ? -1 : 0;
}

/// Doubles as integers: all coordinates multiplied by one power of two.
class IntegerPoints {
 public:
  IntegerPoints(const Mesh& mesh, std::span<const FaceId> faces) : mesh_(mesh) {
    for (const FaceId f : faces)
      for (const VertexId v : mesh.face(f))
        // The smallest exponent of a last bit among all coordinates: every coordinate is a multiple of it.
        for (const double x : mesh.vertices[v])
          if (x != 0) shift_ = std::min(shift_, std::ilogb(x) - 52);
  }

  cpp_int operator()(VertexId v, int axis) const {
    const double x = mesh_.vertices[v][axis];
    if (x == 0) return 0;
    const int exponent = std::ilogb(x) - 52;  // exponent of the last of its 53 bits
    // The 53-bit significand as an integer, then shifted to the common exponent.
    cpp_int value = static_cast<std::int64_t>(std::ldexp(x, -exponent));
    value <<= exponent - shift_;
    return value;
  }

 private:
  const Mesh& mesh_;
  int shift_ = std::numeric_limits<int>::max();
};

int sign_by_integers(const Mesh& mesh, std::span<const FaceId> faces) {
  const IntegerPoints at(mesh, faces);
  cpp_int sum = 0;
  for_each_simplex(mesh, faces, [&](VertexId a, VertexId b, VertexId c) {
    // Scaling does not change the sign, so the shift need not be undone. The origin is zero, so no
    // differences are needed.
    const cpp_int xy = at(a, 0) * at(b, 1) - at(a, 1) * at(b, 0);
    if (mesh.dim == 2) {
      sum += xy;
      return;
    }
    sum += xy * at(c, 2) + (at(a, 1) * at(b, 2) - at(a, 2) * at(b, 1)) * at(c, 0) +
           (at(a, 2) * at(b, 0) - at(a, 0) * at(b, 2)) * at(c, 1);
  });
  return sum.sign();
}

}  // namespace

int volume_sign(const Mesh& mesh, std::span<const FaceId> faces) {
  if (faces.empty()) return 0;
  const int quick = sign_by_doubles(mesh, faces);
  return quick != 0 ? quick : sign_by_integers(mesh, faces);
}

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< (inner component, outer component)

class Nesting {
 public:
  Nesting(const Mesh& mesh, const std::vector<FaceUse>& use, const SurfaceTopology& topology)
      : mesh_(mesh),
        use_(use),
        topology_(topology),
        faces_(topology.components),
        boxes_(topology.components),
        usable_(topology.component_closed),
        depth_(topology.components, 0) {
    for (FaceId f = 0; f < mesh.face_count(); ++f) {
      const std::uint32_t c = topology.component_of_face[f];
      if (c == kNull) continue;
      // A coordinate that is not finite: exact tests cannot use the component.
      if (use[f] < FaceUse::points) usable_[c] = false;
      faces_[c].push_back(f);
      for (const VertexId v : mesh.face(f)) boxes_[c].extend(mesh.vertices[v]);
    }
  }

  std::vector<std::vector<FaceId>> wrongly_facing() {
    // Depth: number of enclosing components. The sign of the volume is exact.
    std::vector<Pair> nested = find_nested();
    drop_crossing(nested);
    for (const Pair& p : nested) ++depth_[p.first];
    std::vector<std::vector<FaceId>> wrong;
    for (std::uint32_t c = 0; c < faces_.size(); ++c)
      if (usable_[c] && volume_sign(mesh_, faces_[c]) == (depth_[c] % 2 == 0 ? -1 : 1))
        wrong.push_back(faces_[c]);
    return wrong;
  }

 private:
  /// Finds the nested pairs of components. A component is inside another if one of its vertices is. A vertex
  /// on the other's surface does not decide, so the next one is tried. If all tried vertices are on it, the
  /// two count as sharing their surface, and neither is a void of the other.
  std::vector<Pair> find_nested() const {
    std::vector<Pair> nested;
    // Nesting requires two components.
    if (std::count(usable_.begin(), usable_.end(), true) < 2) return nested;
    // Only usable components take part in the search.
    std::vector<std::uint32_t> surface = topology_.component_of_face;
    for (std::uint32_t& c : surface)
      if (c != kNull && !usable_[c]) c = kNull;
    const SideFinder finder(mesh_, std::move(surface));
    for (std::uint32_t inner = 0; inner < faces_.size(); ++inner) {
      if (!usable_[inner]) continue;
      // A bounded number of vertices is tried, which bounds the cost per component.
      const std::vector<VertexId> tried = first_corners(inner);
      const auto point = [&](std::size_t i) {
        return i < tried.size() ? &mesh_.vertices[tried[i]] : nullptr;
      };
      for (const std::uint32_t outer : finder.around(inner, point))
        // Necessary for nesting, and cheap: discards components that only partially overlap.
        if (boxes_[outer].contains(boxes_[inner])) nested.emplace_back(inner, outer);
    }
    return nested;
  }

  /// Returns corners of a component's first faces, a few of each.
  std::vector<VertexId> first_corners(std::uint32_t component) const {
    static constexpr std::size_t kFaces = 16, kOfEach = 8;
    std::vector<VertexId> corners;
    for (std::size_t i = 0; i < std::min(kFaces, faces_[component].size()); ++i) {
      const auto face = mesh_.face(faces_[component][i]);
      const auto few = face.first(std::min(kOfEach, face.size()));
      corners.insert(corners.end(), few.begin(), few.end());
    }
    return corners;
  }

  /// Removes pairs of components whose surfaces cross.
  void drop_crossing(std::vector<Pair>& nested) const {
    if (nested.empty()) return;
    // Sorted for binary search: the filter below runs for every pair of faces with overlapping boxes.
    std::sort(nested.begin(), nested.end());
    const auto is_candidate = [&](std::uint32_t a, std::uint32_t b) {
      return std::binary_search(nested.begin(), nested.end(), Pair(a, b));
    };
    std::set<Pair> crossing;
    const auto components = [&](FaceId f, FaceId g) {
      return Pair(topology_.component_of_face[f], topology_.component_of_face[g]);
    };
    const auto wanted = [&](FaceId f, FaceId g) {
      const auto [a, b] = components(f, g);
      // Exact tests only for candidates that are not refuted yet.
      return a != b && (is_candidate(a, b) || is_candidate(b, a)) && !crossing.contains({a, b});
    };
    const auto add = [&](FaceId f, FaceId g) {
      const auto [a, b] = components(f, g);
      crossing.insert({a, b});
      crossing.insert({b, a});
    };
    find_self_intersections(mesh_, use_, add, FaceMeeting::crossing, wanted);
    std::erase_if(nested, [&](const Pair& p) { return crossing.contains(p); });
  }

  const Mesh& mesh_;
  const std::vector<FaceUse>& use_;
  const SurfaceTopology& topology_;
  std::vector<std::vector<FaceId>> faces_;  ///< (components)
  std::vector<Box> boxes_;                  ///< (components)
  std::vector<bool> usable_;                ///< closed, all coordinates finite
  std::vector<std::uint32_t> depth_;        ///< number of enclosing components of each
};

}  // namespace

std::vector<std::vector<FaceId>> wrongly_facing_components(const Mesh& mesh, const std::vector<FaceUse>& use,
                                                           const SurfaceTopology& topology) {
  return Nesting(mesh, use, topology).wrongly_facing();
}

}  // namespace lrb
