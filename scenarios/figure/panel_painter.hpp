#pragma once
/// Paints the part of a view that a panel of a figure shows.

#include <vector>

#include <Eigen/Geometry>

#include "render/canvas.hpp"
#include "render/face_look.hpp"
#include "render/vector_faces.hpp"
#include "scenarios/figure/figure_layout.hpp"
#include <lrbscope/render/scene.hpp>

namespace lrb::figure {

/// The part of a 3D view that a panel shows.
struct DeepView {
  render::Camera camera;
  Eigen::Vector2d paper;  ///< size, points
  Eigen::Vector2i drawn;  ///< the same, pixels
  double pixel;           ///< points

  render::Projection projection(const render::DrawList& list) const {
    return {camera, paper.x(), paper.y(), render::bounds(list)};
  }
};

/// Returns the shading of faces on paper.
inline render::FaceLooks looks(const render::DrawList& list, const render::Projection& on_paper) {
  return {list, on_paper, 1, render::Lighting(), true};
}

class PanelPainter {
 public:
  /// `dim`: of the bodies; `margin`: around the content of each panel, points.
  PanelPainter(const pictures::FrameSpec& frames, int dim, double margin)
      : frames_(frames), is_flat_(dim == 2), margin_(margin) {}

  /// Returns the part of the view, in its own units, that a panel shows at a scale in points per unit.
  Eigen::AlignedBox2d shown_part(const PanelPlace& place, double scale) const;
  DeepView deep_view(const render::Camera& whole, const PanelPlace& place, double scale, double dpi) const;

  /// Paints the content of a panel. 3D: `faces` as vector graphics, or without them all faces as pixels of
  /// resolution `dpi`, with whole pixels in the panel's box; lines and texts over them.
  void paint(render::Canvas& canvas, const render::DrawList& list, const render::Camera& whole,
             const PanelPlace& place, double scale, double dpi,
             const std::vector<render::ScreenFace>* faces = nullptr);

  render::Rasterizer rasterizer;

 private:
  void paint_flat(render::Canvas& canvas, const render::DrawList& list, const render::Camera& camera,
                  const PanelPlace& place, double scale) const;
  render::Image pixels(const render::DrawList& list, const DeepView& deep);

  const pictures::FrameSpec& frames_;
  bool is_flat_;
  double margin_;
};

}  // namespace lrb::figure
