#include "render/occlusion.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/render/camera.hpp>

namespace lrb::render {
namespace {

using Eigen::Vector3d;

constexpr int kDirections = 64;  ///< evenly spread over the sphere
constexpr int kSide = 512;       ///< of the pictures in which visibility is looked up, pixels
/// Smaller cosines count as 0: there the depth of a pixel varies by more than the bias.
constexpr double kGrazing = 0.15;
/// Bias towards the viewer at perpendicular incidence, in pixels.
constexpr double kBias = 1.5;
constexpr double kStrength = 0.75;  ///< share of the light that a completely hidden face loses

/// Returns points evenly spread over the unit sphere, along a spiral.
std::vector<Vector3d> directions() {
  std::vector<Vector3d> out;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    out.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return out;
}

struct Receiver {
  std::size_t triangle;
  Vector3d centre, normal;
  double light = 0, all = 0;
};

}  // namespace

void add_ambient_occlusion(DrawList& list, Rasterizer& rasterizer) {
  // Step 1: the opaque triangles, which both receive and hide light.
  DrawList opaque;
  std::vector<Receiver> receivers;
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < list.triangles.size(); ++i) {
    const DrawTriangle& t = list.triangles[i];
    if (t.layer != Layer::opaque) continue;
    DrawTriangle plain = t;
    plain.edges = 0;
    opaque.triangles.push_back(plain);
    points.insert(points.end(), t.x.begin(), t.x.end());
    const Vector3d normal = (t.x[1] - t.x[0]).cross(t.x[2] - t.x[0]);
    if (t.lit && normal.norm() > 0)
      receivers.push_back({i, (t.x[0] + t.x[1] + t.x[2]) / 3, normal.normalized()});
  }
  if (receivers.empty()) return;
  // Step 2: from each direction, a picture of depths shows which centroids see the sky there.
  const Eigen::AlignedBox3d box = bounds(opaque);
  for (const Vector3d& direction : directions()) {
    FitOptions fit;
    fit.view = {direction, direction.unitOrthogonal()};
    fit.orthographic = true;
    const Camera camera = fit_camera(points, kSide, kSide, fit);
    const DepthImage depths = rasterizer.depths(opaque, camera, kSide, kSide);
    const Projection projection(camera, kSide, kSide, box);
    for (Receiver& r : receivers) {
      const double cosine = r.normal.dot(direction);
      if (cosine < kGrazing) continue;
      r.all += cosine;
      if (depths.shows(projection, r.centre, kBias / (cosine * kSide))) r.light += cosine;
    }
  }
  // Step 3: the colours.
  for (const Receiver& r : receivers) {
    Rgba& colour = list.triangles[r.triangle].colour;
    const double hidden = r.all > 0 ? 1 - r.light / r.all : 0;
    colour = mix(colour, {0, 0, 0, colour.a}, kStrength * hidden);
  }
}

}  // namespace lrb::render
