#pragma once
/// Cameras and projections. All numbers are doubles; the image plane has x to the right and y up.

#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lrb::render {

struct Camera {
  Eigen::Vector3d eye{0, 0, 1};     ///< world frame
  Eigen::Vector3d target{0, 0, 0};  ///< centre of the picture
  Eigen::Vector3d up{0, 1, 0};      ///< not parallel to the view direction
  bool orthographic = false;
  double fov_y = 0.6;      ///< perspective: full vertical angle, radians
  double half_height = 1;  ///< orthographic: from the centre to the top edge, world units
  /// Offset of the picture's centre from the target, to the right and up, in the plane of the picture: in
  /// units of the distance to it (perspective) or of the world (orthographic). Other than zero for a part of
  /// a picture.
  Eigen::Vector2d shift{0, 0};
};

/// Returns the box around points, or an empty box without points.
Eigen::AlignedBox3d bounds(std::span<const Eigen::Vector3d> points);

/// A view direction and an up vector.
struct ViewDirection {
  Eigen::Vector3d from{0.62, -0.68, 0.42};  ///< from the target to the viewer, world frame; need not be unit
  Eigen::Vector3d up{0, 0, 1};
};

/// Returns the direction of the given angles in radians: azimuth from +x towards +y, elevation from the plane
/// z = 0 towards +z.
ViewDirection view_from_angles(double azimuth, double elevation);

/// Returns a direction that looks across an axis from slightly above. If the axis leads from one body to the
/// other, or along a contact normal, the bodies are side by side and the gap between them is visible. For an
/// axis along `up` the viewer is at +x.
ViewDirection view_beside(const Eigen::Vector3d& axis, const Eigen::Vector3d& up = {0, 0, 1},
                          double elevation = 0.45);

struct FitOptions {
  ViewDirection view;
  bool orthographic = false;
  double fov_y = 0.6;    ///< radians
  double margin = 0.06;  ///< free margin on every side, as a share of the picture's smaller side
};

/// Returns the camera of the given direction that shows all points as large as possible in a picture of the
/// given size. Throws InputError if there are no points or one is not finite.
Camera fit_camera(std::span<const Eigen::Vector3d> points, double width, double height,
                  const FitOptions& options = {});
Camera fit_camera(const Eigen::AlignedBox3d& box, double width, double height,
                  const FitOptions& options = {});

/// Returns an orthographic camera that looks straight down on the plane z = 0, with x to the right: for 2D
/// bodies.
Camera fit_top(std::span<const Eigen::Vector3d> points, double width, double height, double margin = 0.06);

/// Returns a camera centred on the contact's points. It shows `context` times their extent, but at least
/// `least` times the scene's diagonal, so that part of the bodies is visible even around a single point.
Camera fit_contact(std::span<const Eigen::Vector3d> contact, const Eigen::AlignedBox3d& scene, double width,
                   double height, const FitOptions& options = {}, double context = 2.5, double least = 0.1);

/// Returns the camera rotated by `azimuth` around the vertical axis through its target and raised by
/// `elevation` (radians; clamped just below the vertical).
Camera orbit(const Camera& camera, double azimuth, double elevation = 0);

/// Maps world to pixels: a camera and a picture size.
class Projection {
 public:
  /// `scene` is the box of everything that will be drawn; it determines the depth range. Throws InputError
  /// for a camera without a direction.
  Projection(const Camera& camera, double width, double height, const Eigen::AlignedBox3d& scene);

  double width() const { return width_; }
  double height() const { return height_; }
  bool orthographic() const { return orthographic_; }
  /// Maps the world to the eye's frame: x right, y up, z = distance in front of the eye.
  /// Perspective with Camera::shift: sheared, so that the picture's centre is at x = y = 0.
  Eigen::Vector3d to_eye(const Eigen::Vector3d& world) const { return to_eye_ * (world - eye_); }
  /// Maps the eye's frame to pixels from the bottom left, y up, and depth in [-1, 1]. z must be at least
  /// near_depth().
  Eigen::Vector3d to_screen(const Eigen::Vector3d& eye) const;
  /// Maps the world to pixels from the top left, y down. Returns nullopt for a point behind the eye.
  std::optional<Eigen::Vector2d> to_pixel(const Eigen::Vector3d& world) const;
  /// Returns the depth in [-1, 1] of a point closer to the viewer than one at depth `depth`, by `heights`
  /// times the picture's height at that depth.
  double nearer(double depth, double heights) const;
  double near_depth() const { return near_; }
  double focal() const { return focal_; }  ///< pixels per unit of x / z (orthographic: of x)
  /// Returns the size of a pixel in world units at a point.
  double unit_per_pixel(const Eigen::Vector3d& world) const;
  const Eigen::Matrix3d& axes() const { return axes_; }  ///< rows: right, up, forward
  /// Returns the unit direction from a point to the viewer, world frame.
  Eigen::Vector3d towards_viewer(const Eigen::Vector3d& world) const;

 private:
  Eigen::Matrix3d axes_, to_eye_;
  Eigen::Vector3d eye_;
  double width_, height_, focal_, near_, far_;
  bool orthographic_;
};

}  // namespace lrb::render
