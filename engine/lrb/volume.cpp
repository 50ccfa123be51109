// Volumes by the divergence theorem: a closed surface encloses the sum of the signed cones from any one point
// over its faces. A face is taken as its fan. All in floating point; see kVolumeRounding for its tolerance.
#include <Eigen/Geometry>

#include "engine/lrb/validate.hpp"

namespace lrb {
namespace {

/// Returns the volume of the cone from `origin` over a face (2D: the area of the triangle), positive if the
/// face looks away from it. The origin is near the faces, so that bodies far from zero keep their digits.
double cone(const LrbRep& rep, FaceId f, const Eigen::Vector3d& origin) {
  const auto corners = rep.face(f);
  const auto at = [&](std::size_t i) -> Eigen::Vector3d { return rep.vertices()[corners[i]] - origin; };
  if (rep.dim() == 2) return 0.5 * (at(0).x() * at(1).y() - at(0).y() * at(1).x());
  // Six times the volume of a tetrahedron is the determinant of its three edges from the apex.
  double sum = 0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum += at(0).dot(at(i).cross(at(i + 1)));
  return sum / 6;
}

/// Returns a face's area (2D: its length).
double size_of(const LrbRep& rep, FaceId f) {
  const auto corners = rep.face(f);
  const auto side = [&](std::size_t i) -> Eigen::Vector3d {
    return rep.vertices()[corners[i]] - rep.vertices()[corners[0]];
  };
  if (rep.dim() == 2) return side(1).norm();
  // The vector area of the fan, times 2.
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum += side(i).cross(side(i + 1));
  return sum.norm() / 2;
}

}  // namespace

double enclosed_volume(const LrbRep& rep, std::span<const FaceId> outward, std::span<const FaceId> inward) {
  if (outward.empty() && inward.empty()) return 0;
  // Any origin gives the same result on a closed surface. One on the surface keeps the terms small.
  const Eigen::Vector3d origin = rep.vertices()[rep.face(outward.empty() ? inward[0] : outward[0])[0]];
  double sum = 0;
  for (const FaceId f : outward) sum += cone(rep, f, origin);
  for (const FaceId f : inward) sum -= cone(rep, f, origin);
  return sum;
}

double region_volume(const LrbRep& rep, RegionId r) {
  return enclosed_volume(rep, rep.lids(r), rep.floor(r));
}

double lid_height(const LrbRep& rep) {
  double volume = 0, area = 0;
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    volume += region_volume(rep, r);
    for (const FaceId lid : rep.lids(r)) area += size_of(rep, lid);
  }
  return area > 0 ? volume / area : 0;
}

}  // namespace lrb
