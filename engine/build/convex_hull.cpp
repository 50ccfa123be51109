#include "engine/build/convex_hull.hpp"

#include <algorithm>

#include "engine/exact/plane_side.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

class Hull {
 public:
  explicit Hull(std::span<const Eigen::Vector3d> points) : points_(points) {}

  std::vector<Triangle> run() {
    if (!start()) return {};
    for (std::uint32_t p = 0; p < points_.size(); ++p) add(p);
    std::vector<Triangle> triangles;
    for (const Facet& f : facets_) triangles.push_back(f.corners);
    return triangles;
  }

 private:
  const double* at(std::uint32_t p) const { return points_[p].data(); }

  /// A tetrahedron with volume.
  bool start() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    std::uint32_t b = 1, c, d;
    while (b < count && points_[b] == points_[0]) ++b;
    for (c = b + 1; c < count && exact::collinear3d(at(0), at(b), at(c));) ++c;
    int side = 0;
    for (d = c + 1; d < count && (side = exact::orient3d(at(0), at(b), at(c), at(d))) == 0;) ++d;
    if (side == 0) return false;
    if (side > 0) std::swap(b, c);
    for (const Triangle& t : {Triangle{0, b, c}, Triangle{0, d, b}, Triangle{b, d, c}, Triangle{c, d, 0}})
      push(t);
    return true;
  }

  void push(const Triangle& t) { facets_.push_back({t, exact::PlaneSide(at(t[0]), at(t[1]), at(t[2]))}); }

  void add(std::uint32_t p) {
    edges_.clear();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      const Triangle& t = facets_[i].corners;
      if (facets_[i].plane.side(at(p)) > 0) {
        for (int k = 0; k < 3; ++k) edges_.push_back({t[k], t[(k + 1) % 3]});
      } else {
        if (kept != i) facets_[kept] = facets_[i];
        ++kept;
      }
    }
    facets_.erase(facets_.begin() + static_cast<std::ptrdiff_t>(kept), facets_.end());
    // The horizon: edges of removed triangles that have no partner.
    std::sort(edges_.begin(), edges_.end());
    for (const auto& [a, b] : edges_)
      if (!std::binary_search(edges_.begin(), edges_.end(), std::array{b, a})) push({a, b, p});
  }

  struct Facet {
    Triangle corners;
    exact::PlaneSide plane;
  };

  std::span<const Eigen::Vector3d> points_;
  std::vector<Facet> facets_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
};

}  // namespace

std::vector<Triangle> convex_hull(std::span<const Eigen::Vector3d> points) {
  return points.size() < 4 ? std::vector<Triangle>() : Hull(points).run();
}

Mesh convex_hull_mesh(std::span<const Eigen::Vector3d> points) {
  Mesh mesh;
  std::vector<VertexId> number(points.size(), kNull);
  for (const Triangle& t : convex_hull(points)) {
    VertexId corners[3];
    for (int i = 0; i < 3; ++i) {
      VertexId& v = number[t[i]];
      if (v == kNull) {
        v = static_cast<VertexId>(mesh.vertices.size());
        mesh.vertices.push_back(points[t[i]]);
      }
      corners[i] = v;
    }
    mesh.add_face(corners);
  }
  return mesh;
}

}  // namespace lrb
