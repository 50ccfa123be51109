#include <limits>
#include <random>

#include <doctest/doctest.h>

#include <lrbscope/error.hpp>
#include <lrbscope/render/camera.hpp>

using namespace lrb;
using Eigen::Vector3d;

namespace {

std::vector<Vector3d> cloud(std::mt19937& random, const Vector3d& centre, const Vector3d& size) {
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  std::vector<Vector3d> out;
  for (int i = 0; i < 60; ++i)
    out.push_back(centre + Vector3d(u(random), u(random), u(random)).cwiseProduct(size));
  return out;
}

Eigen::AlignedBox3d box_of(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box;
}

}  // namespace

TEST_CASE("a fitted camera shows every point within the margin, and fills the frame") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-3.1, 3.1);
  for (int i = 0; i < 400; ++i) {
    const double scale = std::pow(10.0, i % 7 - 3);
    const auto points = cloud(random, scale * Vector3d(angle(random), angle(random), angle(random)) * 10,
                              scale * Vector3d(1, 0.2 + i % 3, i % 5));
    render::FitOptions options;
    options.view = render::view_from_angles(angle(random), 0.45 * angle(random));
    options.orthographic = i % 2 == 0;
    const double width = 1280, height = i % 3 == 0 ? 720 : 1500,
                 free = options.margin * std::min(width, height);
    const render::Camera camera = render::fit_camera(points, width, height, options);
    const render::Projection projection(camera, width, height, box_of(points));
    double tightest = std::numeric_limits<double>::infinity();
    for (const Vector3d& p : points) {
      const auto at = projection.to_pixel(p);
      REQUIRE(at.has_value());
      const double room = std::min({at->x(), width - at->x(), at->y(), height - at->y()});
      tightest = std::min(tightest, room);
      const double depth = projection.to_screen(projection.to_eye(p)).z();
      CHECK(depth >= -1);
      CHECK(depth <= 1);
    }
    CHECK(tightest >= free - 1e-6 * width);
    CHECK(tightest <= free + 1e-6 * width);
  }
}

TEST_CASE("a shifted camera shows a part of the picture, at any scale") {
  std::mt19937 random(7);
  const std::vector<Vector3d> points = cloud(random, {1, 2, 3}, {2, 1, 3});
  for (const bool orthographic : {false, true}) {
    render::FitOptions fit;
    fit.orthographic = orthographic;
    const render::Camera whole = render::fit_camera(points, 400, 400, fit);
    // The quarter at the top right, twice as large.
    render::Camera part = whole;
    const double tangent = std::tan(0.5 * whole.fov_y);
    part.half_height = 0.5 * whole.half_height;
    part.fov_y = 2 * std::atan(0.5 * tangent);
    part.shift = Eigen::Vector2d(0.5, 0.5) * (orthographic ? whole.half_height : tangent);
    const Eigen::AlignedBox3d box = box_of(points);
    const render::Projection small(whole, 400, 400, box), large(part, 400, 400, box);
    for (const Vector3d& p : points) {
      const Eigen::Vector2d expected = 2 * (*small.to_pixel(p) - Eigen::Vector2d(200, 0));
      CHECK((*large.to_pixel(p) - expected).norm() < 1e-9);
      CHECK((small.towards_viewer(p) - large.towards_viewer(p)).norm() < 1e-12);
    }
  }
}
