#include "scenarios/figure/paint_key.hpp"

#include "render/palette.hpp"

namespace lrb::figure {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Mark = render::LegendItem::Mark;
namespace palette = render::palette;

void paint_mark(render::Canvas& canvas, const AlignedBox2d& box, const render::LegendItem& item,
                const render::Style& style) {
  const double thick = 0.2 * box.sizes().y();
  const Vector2d left(box.min().x(), box.center().y()), right(box.max().x(), box.center().y());
  switch (item.mark) {
    case Mark::solid:
      canvas.fill({render::corners(box)}, item.colour);
      canvas.stroke(render::corners(box), true, {style.edge_of(item.colour), 0.5 * thick, 0});
      break;
    case Mark::translucent:
      canvas.fill({render::corners(box)}, render::with_alpha(item.colour, 80));
      canvas.stroke(render::corners(box), true, {render::mix(item.colour, style.ink, 0.3), thick, 0});
      break;
    case Mark::line:
      canvas.stroke({left, right}, false, {item.colour, 1.5 * thick, 0});
      break;
    case Mark::dashed:
      canvas.stroke({left, right}, false, {item.colour, 1.2 * thick, box.sizes().x() / 5});
      break;
    case Mark::point:
      canvas.disc(box.center(), 0.42 * box.sizes().y(), item.colour);
      break;
  }
}

void paint_bar(render::Canvas& canvas, const FigureLayout& layout, const render::ScaleBar& scale,
               render::Rgba ink) {
  constexpr int kSteps = 128;
  const AlignedBox2d& bar = *layout.bar;
  // Each step reaches to the right end, under those that follow: between two that only touch, paper would
  // show.
  for (int i = 0; i < kSteps; ++i) {
    const Vector2d from(bar.min().x() + bar.sizes().x() * i / kSteps, bar.min().y());
    canvas.fill({render::corners({from, bar.max()})}, palette::viridis(i / (kSteps - 1.0)));
  }
  const double y = bar.center().y(), gap = 0.4 * layout.text_height, height = layout.text_height;
  canvas.text({layout.bar_text, scale.text, height, false, ink, render::Align::centre});
  canvas.text(
      {{bar.min().x() - gap, y}, render::short_number(scale.low), height, false, ink, render::Align::right});
  canvas.text({{bar.max().x() + gap, y}, render::short_number(scale.high), height, false, ink});
}

}  // namespace

void paint_key(render::Canvas& canvas, const FigureLayout& layout,
               const std::vector<render::LegendItem>& legend, const std::optional<render::ScaleBar>& scale,
               const render::Style& style) {
  for (std::size_t i = 0; i < legend.size(); ++i) {
    paint_mark(canvas, layout.legend[i].mark, legend[i], style);
    canvas.text({layout.legend[i].text, legend[i].text, layout.text_height, false, style.ink});
  }
  if (scale) paint_bar(canvas, layout, *scale, style.ink);
}

}  // namespace lrb::figure
