#include "scenarios/figure/panel_painter.hpp"

#include "render/paint_list.hpp"
#include "render/pictures/marks.hpp"
#include "scenarios/figure/figure_panels.hpp"

namespace lrb::figure {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

AlignedBox2d PanelPainter::shown_part(const PanelPlace& place, double scale) const {
  const Vector2d low = place.seen_from - Vector2d::Constant(margin_ / scale);
  return {low, low + place.box.sizes() / scale};
}

DeepView PanelPainter::deep_view(const render::Camera& whole, const PanelPlace& place, double scale,
                                 double dpi) const {
  DeepView out;
  out.pixel = render::kPointsPerInch / dpi;
  out.drawn = (place.box.sizes() / out.pixel).array().round().max(1).cast<int>();
  out.paper = out.drawn.cast<double>() * out.pixel;
  AlignedBox2d part = shown_part(place, scale);
  part.max() = part.min() + out.paper / scale;
  out.camera = part_of(whole, part);
  return out;
}

void PanelPainter::paint_flat(render::Canvas& canvas, const render::DrawList& list,
                              const render::Camera& camera, const PanelPlace& place, double scale) const {
  const double side = kViewSide * scale;
  const render::Projection projection(camera, side, side, render::bounds(list));
  canvas.begin_clip(place.box);
  const Vector2d low = place.seen_from * scale - Vector2d(margin_, margin_);
  render::paint_flat(canvas, pictures::with_leaders(list, projection, {low, low + place.box.sizes()}),
                     projection, place.box.min() - low);
  canvas.end_clip();
}

void PanelPainter::paint(render::Canvas& canvas, const render::DrawList& list, const render::Camera& whole,
                         const PanelPlace& place, double scale, double dpi,
                         const std::vector<render::ScreenFace>* faces) {
  if (is_flat_) return paint_flat(canvas, list, whole, place, scale);
  const DeepView deep = deep_view(whole, place, scale, dpi);
  const render::DepthImage depths = rasterizer.depths(list, deep.camera, deep.drawn.x(), deep.drawn.y());
  const render::Projection on_paper = deep.projection(list);
  const Vector2d& origin = place.box.min();
  if (faces == nullptr) canvas.picture(pixels(list, deep), place.box);
  canvas.begin_clip(place.box);
  if (faces != nullptr) {
    render::paint_faces(canvas, list, *faces, looks(list, on_paper), origin);
    render::paint_visible_lines(canvas, list, on_paper, depths, origin);
  }
  const AlignedBox2d frame(Vector2d(0, 0), deep.paper);
  render::paint_over(canvas, pictures::with_leaders(list, on_paper, frame), on_paper, depths, origin);
  canvas.end_clip();
}

render::Image PanelPainter::pixels(const render::DrawList& list, const DeepView& deep) {
  render::RasterOptions raster;
  raster.width = deep.drawn.x(), raster.height = deep.drawn.y();
  raster.supersample = frames_.supersampling;
  raster.unit = 1 / deep.pixel;
  raster.labels = false;
  raster.even_edges = true;
  raster.background = frames_.paper();
  return rasterizer.draw(render::under_lines(list), deep.camera, raster);
}

}  // namespace lrb::figure
