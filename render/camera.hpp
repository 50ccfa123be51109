#pragma once
/// Where the picture is taken from. All in double; the picture's plane has x to the right and y up.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lrb::render {

struct Camera {
  Eigen::Vector3d eye{0, 0, 1};     ///< world frame
  Eigen::Vector3d target{0, 0, 0};  ///< the middle of the picture
  Eigen::Vector3d up{0, 1, 0};      ///< any direction but that of the view
  bool orthographic = false;
  double fov_y = 0.6;      ///< perspective: full angle from bottom to top, radians
  double half_height = 1;  ///< orthographic: from the middle to the top edge, world units
};

/// From where to look: a direction to stand in, seen from the target, and what is up.
struct ViewDirection {
  Eigen::Vector3d from{0.62, -0.68, 0.42};  ///< need not be unit
  Eigen::Vector3d up{0, 0, 1};
};

/// A direction by angles: azimuth from +x towards +y, elevation from the plane z = 0 towards +z, radians.
ViewDirection view_from_angles(double azimuth, double elevation);

/// Looks across an axis, from slightly above: with the axis from one body to the other, or a contact's
/// normal, both bodies stand side by side and what is between them is seen. An axis along `up` is looked at
/// from +x.
ViewDirection view_beside(const Eigen::Vector3d& axis, const Eigen::Vector3d& up = {0, 0, 1},
                          double elevation = 0.45);

struct FitOptions {
  ViewDirection view;
  bool orthographic = false;
  double fov_y = 0.6;    ///< radians
  double margin = 0.06;  ///< left free on every side, as a share of the smaller side of the picture
};

/// The camera of the given direction that shows all points as large as possible, in a picture of the given
/// shape. Throws InputError without points or with ones that are not finite.
Camera fit_camera(std::span<const Eigen::Vector3d> points, double width, double height,
                  const FitOptions& options = {});
Camera fit_camera(const Eigen::AlignedBox3d& box, double width, double height,
                  const FitOptions& options = {});

/// Looks straight down on the plane z = 0, orthographic, x to the right: for 2D bodies.
Camera fit_top(std::span<const Eigen::Vector3d> points, double width, double height, double margin = 0.06);

/// The points in the middle of the picture and, around them, `context` times their size and `least` times the
/// scene's diagonal: something of the bodies is always seen, even where the contact is one point.
Camera fit_contact(std::span<const Eigen::Vector3d> contact, const Eigen::AlignedBox3d& scene, double width,
                   double height, const FitOptions& options = {}, double context = 2.5, double least = 0.1);

/// The same camera carried round the vertical through its target by `azimuth`, and lifted by `elevation`
/// (radians; stopped short of the vertical).
Camera orbit(const Camera& camera, double azimuth, double elevation = 0);

/// A camera with the picture's size: world to pixels.
class Projection {
 public:
  /// `scene` holds everything to draw; it sets the range of depths. Throws InputError for a camera without
  /// direction.
  Projection(const Camera& camera, double width, double height, const Eigen::AlignedBox3d& scene);

  double width() const { return width_; }
  double height() const { return height_; }
  bool orthographic() const { return orthographic_; }
  /// Eye frame: x right, y up, z = distance in front of the eye.
  Eigen::Vector3d to_eye(const Eigen::Vector3d& world) const { return axes_ * (world - eye_); }
  /// Eye frame to pixels from the bottom left, y up, and depth in [-1, 1]. z must be at least near().
  Eigen::Vector3d to_screen(const Eigen::Vector3d& eye) const;
  /// World to pixels from the top left, y down; nothing if it lies behind the eye.
  std::optional<Eigen::Vector2d> to_pixel(const Eigen::Vector3d& world) const;
  /// The depth in [-1, 1] of what lies closer to the viewer than something of that depth, by a share of the
  /// height that the picture shows there.
  double nearer(double depth, double heights) const;
  double near_depth() const { return near_; }
  double far_depth() const { return far_; }
  double focal() const { return focal_; }  ///< pixels per unit of x / z (orthographic: of x)
  /// World units per pixel at a point.
  double unit_per_pixel(const Eigen::Vector3d& world) const;
  const Eigen::Matrix3d& axes() const { return axes_; }  ///< rows: right, up, forward
  /// From a point to the viewer, unit, world frame.
  Eigen::Vector3d towards_viewer(const Eigen::Vector3d& world) const;

 private:
  Eigen::Matrix3d axes_;
  Eigen::Vector3d eye_;
  double width_, height_, focal_, near_, far_;
  bool orthographic_;
};

}  // namespace lrb::render
