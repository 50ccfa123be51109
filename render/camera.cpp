#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <lrbscope/error.hpp>
#include <lrbscope/render/camera.hpp>

namespace lrb::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Minimum rendered depth if the camera is inside the scene, as a share of the distance to the far end.
constexpr double kNearShare = 1e-4;
/// The same, as a share of the distance to the target: a close-up needs depth resolution there.
constexpr double kNearFocus = 0.02;
/// Extension of the depth range beyond the scene, as a share of it: space for lines nudged towards the
/// viewer.
constexpr double kDepthSlack = 0.01;
/// A scene that is a single point is shown with an extent of this share of its coordinates, or of this
/// length.
constexpr double kMinExtent = 1e-9;
constexpr double kMinLength = 1e-30;
/// Minimum ratio of height to width of the visible extent: for a flat scene seen edge-on.
constexpr double kFlattest = 1e-3;
/// The eye keeps a distance of this share of the scene's size from it.
constexpr double kClearance = 0.05;
constexpr double kNearlyVertical = 1e-3;  ///< view_beside(): sine of the angle between axis and vertical
constexpr double kSteepest = 0.49 * std::numbers::pi;  ///< orbit() raises a camera up to this angle

/// Returns the camera's axes as rows: right, up, forward.
Matrix3d axes_of(const Vector3d& forward, const Vector3d& up) {
  Matrix3d axes;
  const Vector3d f = forward.normalized();
  // `up` may be parallel to the view direction: fall back to other axes.
  Vector3d right = f.cross(up);
  if (!(right.squaredNorm() > 0)) right = f.cross(Vector3d::UnitY());
  if (!(right.squaredNorm() > 0)) right = f.cross(Vector3d::UnitX());
  right.normalize();
  axes << right.transpose(), right.cross(f).transpose(), f.transpose();
  return axes;
}

void check_points(std::span<const Vector3d> points) {
  if (points.empty()) throw InputError("cannot fit a camera: the scene has no points");
  for (const Vector3d& p : points) {
    if (!p.allFinite()) throw InputError("cannot fit a camera: a point of the scene is not finite");
  }
}

/// Upper bounds of a.x + b.z and -a.x + b.z over points: the two tangent planes of a frustum.
struct Support {
  double plus = -std::numeric_limits<double>::infinity(), minus = plus;
  void add(double across, double slope_depth) {
    plus = std::max(plus, across + slope_depth);
    minus = std::max(minus, -across + slope_depth);
  }
  double midpoint() const { return 0.5 * (plus - minus); }
  double half() const { return 0.5 * (plus + minus); }
};

std::array<Vector3d, 8> corners_of(const Eigen::AlignedBox3d& box) {
  std::array<Vector3d, 8> out;
  for (int i = 0; i < 8; ++i) out[i] = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  return out;
}

}  // namespace

ViewDirection view_from_angles(double azimuth, double elevation) {
  const double c = std::cos(elevation);
  return {{c * std::cos(azimuth), c * std::sin(azimuth), std::sin(elevation)}, {0, 0, 1}};
}

ViewDirection view_beside(const Vector3d& axis, const Vector3d& up, double elevation) {
  const Vector3d vertical = up.normalized();
  Vector3d side = axis.cross(vertical);
  // For a nearly vertical axis the side direction is ill-conditioned: a tiny rotation would rotate the
  // picture by a large angle.
  if (!(side.norm() > kNearlyVertical * axis.norm())) {
    side = Vector3d::UnitX() - vertical * vertical.x();
    if (!(side.norm() > kNearlyVertical)) side = Vector3d::UnitY();
  }
  return {std::cos(elevation) * side.normalized() + std::sin(elevation) * vertical, up};
}

Eigen::AlignedBox3d bounds(std::span<const Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box;
}

Camera fit_camera(std::span<const Vector3d> points, double width, double height, const FitOptions& options) {
  check_points(points);
  if (!(options.view.from.squaredNorm() > 0)) throw InputError("expected a camera direction other than zero");
  // Step 1: the direction is given, so only a translation is unknown. Work in the camera's axes.
  const Matrix3d axes = axes_of(-options.view.from, options.view.up);
  // Points are relative to the centre of their box, for precision far from the origin.
  const Eigen::AlignedBox3d box = bounds(points);
  const Vector3d origin = box.center();

  // Step 2: the opening angles inside the margins.
  const double free = options.margin * std::min(width, height);
  const double inner_x = std::max(0.05, 1 - 2 * free / width),
               inner_y = std::max(0.05, 1 - 2 * free / height);
  const double tan_y = options.orthographic ? 0 : std::tan(0.5 * options.fov_y);
  const double slope_x = tan_y * width / height * inner_x, slope_y = tan_y * inner_y;
  // Step 3: in these axes, each side plane of the frustum has a fixed normal. Its support over the points
  // gives the position at which it touches them: exact and linear in their number.
  Support x, y, z;
  for (const Vector3d& p : points) {
    const Vector3d e = axes * (p - origin);
    x.add(e.x(), -slope_x * e.z());
    y.add(e.y(), -slope_y * e.z());
    z.add(e.z(), 0);
  }
  const double size =
      std::max({box.diagonal().norm(), kMinExtent * origin.cwiseAbs().maxCoeff(), kMinLength});

  // Step 4: centre the eye between opposite planes, and move it back until both pairs enclose the points.
  Camera camera;
  camera.up = options.view.up;
  camera.orthographic = options.orthographic;
  camera.fov_y = options.fov_y;
  Vector3d eye{x.midpoint(), y.midpoint(), 0};
  if (options.orthographic) {
    camera.half_height =
        std::max({y.half() / inner_y, x.half() / inner_x * height / width, kFlattest * size});
    eye.z() = -z.minus - size;
  } else {
    // The eye moves back from z = 0 until each pair of planes encloses the points, and stays in front of
    // them.
    eye.z() = -std::max({x.half() / slope_x, y.half() / slope_y, z.minus + kClearance * size});
    camera.half_height = 0.5 * size;
  }
  camera.eye = origin + axes.transpose() * eye;
  camera.target = origin + axes.transpose() * Vector3d(eye.x(), eye.y(), z.midpoint());
  return camera;
}

Camera fit_camera(const Eigen::AlignedBox3d& box, double width, double height, const FitOptions& options) {
  if (box.isEmpty()) throw InputError("cannot fit a camera: the scene is empty");
  return fit_camera(corners_of(box), width, height, options);
}

Camera fit_top(std::span<const Vector3d> points, double width, double height, double margin) {
  FitOptions options;
  options.view = {{0, 0, 1}, {0, 1, 0}};
  options.orthographic = true;
  options.margin = margin;
  return fit_camera(points, width, height, options);
}

Camera fit_contact(std::span<const Vector3d> contact, const Eigen::AlignedBox3d& scene, double width,
                   double height, const FitOptions& options, double context, double least) {
  check_points(contact);
  const Eigen::AlignedBox3d box = bounds(contact);
  // A cube inscribed in a ball around the contact; the ball grows with the contact and with the scene.
  const double radius = 0.5 * (context * box.diagonal().norm() + least * scene.diagonal().norm());
  const Vector3d r = Vector3d::Constant(radius / std::sqrt(3.0));
  FitOptions fit = options;
  fit.margin = 0;
  Camera camera = fit_camera(Eigen::AlignedBox3d(box.center() - r, box.center() + r), width, height, fit);
  // The centre of the box need not be the centre of the contact's image.
  const Projection projection(camera, width, height, box);
  Eigen::AlignedBox2d seen;
  for (const Vector3d& p : contact) {
    if (const auto at = projection.to_pixel(p)) seen.extend(*at);
  }
  if (seen.isEmpty()) return camera;
  const Eigen::Vector2d deviation =
      (seen.center() - Eigen::Vector2d(0.5 * width, 0.5 * height)) * projection.unit_per_pixel(box.center());
  const Vector3d move = projection.axes().row(0) * deviation.x() - projection.axes().row(1) * deviation.y();
  camera.eye += move;
  camera.target += move;
  return camera;
}

Camera orbit(const Camera& camera, double azimuth, double elevation) {
  const Vector3d up = camera.up.normalized();
  // Rotate around the vertical first, then raise within limits, so that the camera never turns over.
  Vector3d arm = Eigen::AngleAxisd(azimuth, up) * (camera.eye - camera.target);
  if (elevation != 0) {
    const double now = std::asin(std::clamp(arm.normalized().dot(up), -1.0, 1.0));
    const double then = std::clamp(now + elevation, -kSteepest, kSteepest);
    const Vector3d side = arm.cross(up);
    if (side.squaredNorm() > 0) arm = Eigen::AngleAxisd(then - now, side.normalized()) * arm;
  }
  Camera out = camera;
  out.eye = camera.target + arm;
  return out;
}

Projection::Projection(const Camera& camera, double width, double height, const Eigen::AlignedBox3d& scene)
    : eye_(camera.eye), width_(width), height_(height), orthographic_(camera.orthographic) {
  const Vector3d forward = camera.target - camera.eye;
  if (!forward.allFinite() || !(forward.squaredNorm() > 0)) {
    throw InputError("the camera's eye and target must be finite and differ");
  }
  axes_ = axes_of(forward, camera.up);
  to_eye_ = axes_;
  if (orthographic_) {
    eye_ += axes_.topRows<2>().transpose() * camera.shift;
  } else {
    to_eye_.topRows<2>() -= camera.shift * axes_.row(2);
  }
  // Pixels per unit: at distance 1 in perspective, everywhere in orthographic views.
  focal_ = 0.5 * height / (orthographic_ ? camera.half_height : std::tan(0.5 * camera.fov_y));
  if (!std::isfinite(focal_) || !(focal_ > 0))
    throw InputError("the camera's opening angle must be finite and positive");
  // The depth range is fitted to the scene for the best resolution.
  double lo = 1, hi = 2;
  if (!scene.isEmpty()) {
    lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const Vector3d& c : corners_of(scene)) {
      const double z = to_eye(c).z();
      lo = std::min(lo, z), hi = std::max(hi, z);
    }
  }
  const double slack = kDepthSlack * std::max(hi - lo, kMinExtent * std::abs(hi)) + kMinLength;
  far_ = hi + slack;
  near_ = lo - slack;
  if (!orthographic_) {
    if (!(far_ > 0)) far_ = 1;
    // In perspective, resolution is lost in proportion to far / near: keep the near plane away from the eye.
    near_ = std::max({near_, kNearShare * far_, std::min(kNearFocus * forward.norm(), 0.5 * far_)});
  }
}

Vector3d Projection::to_screen(const Vector3d& e) const {
  if (orthographic_) {
    return {0.5 * width_ + focal_ * e.x(), 0.5 * height_ + focal_ * e.y(),
            (2 * e.z() - far_ - near_) / (far_ - near_)};
  }
  // Depth is linear in 1 / z, and so it is linear over the picture of a plane.
  return {0.5 * width_ + focal_ * e.x() / e.z(), 0.5 * height_ + focal_ * e.y() / e.z(),
          (far_ + near_ - 2 * far_ * near_ / e.z()) / (far_ - near_)};
}

double Projection::nearer(double depth, double heights) const {
  const double shift = heights * height_ / focal_;  // perspective: at distance 1
  if (orthographic_) return depth - 2 * shift / (far_ - near_);
  // With depth = infinite - c / z, moving a point to z (1 - shift) scales its difference from `infinite`.
  const double infinite = (far_ + near_) / (far_ - near_);
  return infinite - (infinite - depth) / (1 - shift);
}

std::optional<Eigen::Vector2d> Projection::to_pixel(const Vector3d& world) const {
  const Vector3d e = to_eye(world);
  // Points behind the near plane have no picture.
  if (!orthographic_ && e.z() < near_) return std::nullopt;
  const Vector3d s = to_screen(e);
  return Eigen::Vector2d(s.x(), height_ - s.y());
}

double Projection::unit_per_pixel(const Vector3d& world) const {
  return (orthographic_ ? 1.0 : std::max(to_eye(world).z(), near_)) / focal_;
}

Vector3d Projection::towards_viewer(const Vector3d& world) const {
  if (orthographic_) return -axes_.row(2).transpose();
  return (eye_ - world).normalized();
}

}  // namespace lrb::render
