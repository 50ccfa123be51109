#include "scenarios/figure/figure_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>

#include "render/pictures/panel.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
namespace lrb::figure {

double parse_length(const std::string& text, const std::string& option, double least, double most) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [unit_at, error] = std::from_chars(text.data(), end, value);
  const std::string_view unit(unit_at, static_cast<std::size_t>(end - unit_at));
  const double points = unit == "mm"   ? kPointsPerMm
                        : unit == "cm" ? 10 * kPointsPerMm
                        : unit == "in" ? 72
                        : unit == "pt" ? 1
                                       : 0;
  if (error != std::errc() || points == 0)
    throw InputError(option + ": expected a length such as 85mm, 8.5cm, 3.3in or 240pt, found \"" + text +
                     "\"");
  const double length = value * points;
  if (!(length >= least && length <= most))
    throw InputError(option + ": expected a length from " + length_text(least) + " to " + length_text(most) +
                     ", found \"" + text + "\"");
  return length;
}

bool runs_over(const Block& block) {
  constexpr double kRim = 1e-3 * kViewSide;
  return std::any_of(block.seen.begin(), block.seen.end(), [](const Eigen::AlignedBox2d& seen) {
    return seen.min().minCoeff() < kRim || seen.max().maxCoeff() > kViewSide - kRim;
  });
}

void name_bodies_only(std::vector<render::LegendItem>& legend) {
  constexpr std::string_view kReal = ", real faces", kPseudo = ", pseudo faces";
  if (std::any_of(legend.begin(), legend.end(), [&](const auto& k) { return k.text.ends_with(kPseudo); }))
    return;
  for (render::LegendItem& k : legend)
    if (k.text.ends_with(kReal)) k.text.resize(k.text.size() - kReal.size());
}

std::string length_text(double points) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", points / kPointsPerMm);
  return text;
}

namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr double kLine = 1.3;    ///< line spacing, in font sizes
constexpr double kGutter = 0.8;  ///< between panels, in font sizes
constexpr double kGap = 0.5;     ///< above legend, bar and caption, in font sizes
/// Target aspect ratio of automatic columns. Figures as wide as a page are lower: four panels stand in a row.
constexpr double kShape = 1.5, kPageShape = 2.5, kPageWidth = 150 * kPointsPerMm;
constexpr double kGapCost = 2;  ///< cost of empty cells, in logarithms of that ratio, if all cells are empty
constexpr double kTallest = 1.4;  ///< maximum height of a block, in widths
constexpr double kMinPanel = 5 * kPointsPerMm;
/// Minimum width of a panel in automatic columns, also of one with a title below it.
constexpr double kMinAutomatic = 22 * kPointsPerMm, kMinTitled = 38 * kPointsPerMm;
constexpr double kInset = 0.4;      ///< maximum side of an inset, as a share of the figure's width
constexpr double kInsetGap = 1;     ///< above an inset, in font sizes: space for the lines to its frame
constexpr double kBarWidth = 0.45;  ///< width of the colour bar, as a share of the figure's

/// Wraps text of a font size in points.
std::vector<std::string> wrap(const std::string& text, double width, double font_size) {
  constexpr double kFine = 32;  // widths are measured in whole pixels, so in a larger font
  render::TextStyle style;
  style.height = static_cast<float>(font_size * render::kHeightOfFont * kFine);
  return render::default_font().wrap(text, static_cast<int>(width * kFine), style);
}

/// A block in a given number of columns, with its top at zero.
struct Arranged {
  BlockLayout layout;
  double height = 0;
  double spaces = 0;  ///< part of the height that is empty space around panels
};

class BlockLayouter {
 public:
  BlockLayouter(const Block& block, const LayoutOptions& options, std::size_t columns)
      : block_(block), o_(options), columns_(std::min(columns, block.seen.size())) {
    rows_ = (block.seen.size() + columns_ - 1) / columns_;
    column_.resize(columns_);
    row_.resize(rows_);
    for (std::size_t i = 0; i < block.seen.size(); ++i) {
      extend(column_[i % columns_], block.seen[i].min().x(), block.seen[i].max().x());
      extend(row_[i / columns_], block.seen[i].min().y(), block.seen[i].max().y());
    }
  }

  double panel_width() const {
    return (o_.width - (static_cast<double>(columns_) - 1) * gutter()) / static_cast<double>(columns_);
  }

  Arranged arrange() {
    const double room = o_.width - (static_cast<double>(columns_) - 1) * gutter() -
                        2 * o_.margin * static_cast<double>(columns_);
    const double width = sum(column_), height = sum(row_);
    Arranged out;
    double scale = room / width;
    scale = std::min(scale, kTallest * o_.width / height);
    out.layout.scale = scale;
    std::vector<std::vector<std::string>> lines;
    std::vector<std::size_t> most(rows_, 0);
    std::vector<double> insets(rows_, 0);  // the largest side
    for (std::size_t i = 0; i < block_.seen.size(); ++i) {
      const double own = column_[i % columns_].length() * scale + 2 * o_.margin;
      lines.push_back(block_.texts.empty() ? std::vector<std::string>()
                                           : wrap(block_.texts[i], own, o_.font_size));
      most[i / columns_] = std::max(most[i / columns_], lines.back().size());
      insets[i / columns_] = std::max(insets[i / columns_], inset_side(i, own));
    }
    const double used = width * scale + 2 * o_.margin * static_cast<double>(columns_) +
                        (static_cast<double>(columns_) - 1) * gutter();
    double y = 0;
    for (std::size_t row = 0; row < rows_; ++row) {
      double x = 0.5 * (o_.width - used);
      Space space;
      for (std::size_t i = row * columns_; i < std::min(block_.spaces.size(), (row + 1) * columns_); ++i) {
        space.above = std::max(space.above, block_.spaces[i].above);
        space.below = std::max(space.below, block_.spaces[i].below);
      }
      y += space.above;
      out.spaces += space.above + space.below;
      const double high = row_[row].length() * scale + 2 * o_.margin;
      for (std::size_t i = row * columns_; i < std::min(block_.seen.size(), (row + 1) * columns_); ++i) {
        const Interval& column = column_[i % columns_];
        const double wide = column.length() * scale + 2 * o_.margin;
        PanelPlace place;
        place.box = AlignedBox2d(Vector2d(x, y), Vector2d(x + wide, y + high));
        place.space = space;
        place.seen_from = {column.low, row_[row].low};
        place.lines = std::move(lines[i]);
        place_insets(
            place, i,
            y + high + space.below + (static_cast<double>(most[row]) * kLine + kInsetGap) * o_.font_size);
        out.layout.panels.push_back(std::move(place));
        x += wide + gutter();
      }
      y += high + space.below + static_cast<double>(most[row]) * kLine * o_.font_size +
           (row + 1 < rows_ ? gutter() : 0);
      if (insets[row] > 0) y += kInsetGap * o_.font_size + insets[row];
    }
    out.height = y;
    return out;
  }

 private:
  struct Interval {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    double length() const { return high - low; }
  };
  static void extend(Interval& i, double low, double high) {
    i.low = std::min(i.low, low), i.high = std::max(i.high, high);
  }
  static double sum(const std::vector<Interval>& all) {
    double out = 0;
    for (const Interval& i : all) out += i.length();
    return out;
  }
  double gutter() const { return kGutter * o_.font_size; }
  std::size_t insets_of(std::size_t panel) const { return block_.insets.empty() ? 0 : block_.insets[panel]; }
  /// Returns the side of a panel's insets, which share its width; 0 without insets.
  double inset_side(std::size_t panel, double width) const {
    const auto count = static_cast<double>(insets_of(panel));
    return count > 0 ? std::min(kInset * o_.width, (width - (count - 1) * gutter()) / count) : 0;
  }
  /// Places the insets of a panel side by side below it.
  void place_insets(PanelPlace& place, std::size_t panel, double top) const {
    const double side = inset_side(panel, place.box.sizes().x()), step = side + gutter();
    const auto count = static_cast<double>(insets_of(panel));
    for (std::size_t k = 0; k < insets_of(panel); ++k) {
      const double left =
          place.box.center().x() - 0.5 * (count * step - gutter()) + static_cast<double>(k) * step;
      place.insets.emplace_back(Vector2d(left, top), Vector2d(left + side, top + side));
    }
  }

  const Block& block_;
  const LayoutOptions& o_;
  std::size_t columns_, rows_ = 0;
  std::vector<Interval> column_, row_;
};

/// Returns a block in the requested columns, or in those that bring it closest to its target ratio.
Arranged arrange(const Block& block, const LayoutOptions& options) {
  if (options.columns > 0) {
    BlockLayouter layouter(block, options, options.columns);
    if (layouter.panel_width() < kMinPanel)
      throw InputError("--columns " + std::to_string(options.columns) + ": leaves panels of less than " +
                       length_text(kMinPanel) + " in a figure of " + length_text(options.width) +
                       "; use fewer columns or a larger --width");
    return layouter.arrange();
  }
  std::optional<Arranged> best;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = block.seen.size();
  constexpr std::size_t kLetter = 4;  // "(a)"
  const bool titled = std::any_of(block.texts.begin(), block.texts.end(),
                                  [](const std::string& text) { return text.size() > kLetter; });
  const double narrowest = titled ? kMinTitled : kMinAutomatic;
  const double shape = options.width < kPageWidth ? kShape : kPageShape;
  for (std::size_t columns = 1; columns <= n; ++columns) {
    BlockLayouter layouter(block, options, columns);
    if (best && layouter.panel_width() < narrowest) break;
    Arranged arranged = layouter.arrange();
    const std::size_t rows = (n + columns - 1) / columns;
    const double gaps = static_cast<double>(rows * columns - n) / static_cast<double>(n);
    const double deviation =
        std::abs(std::log(options.width / (arranged.height - arranged.spaces) / shape)) + kGapCost * gaps;
    if (deviation < least) least = deviation, best = std::move(arranged);
  }
  return std::move(*best);
}

/// Moves all parts of a block to their positions, on the grid.
void place(BlockLayout& block, double top, double grid) {
  const auto snapped = [&](double x) { return grid > 0 ? grid * std::round(x / grid) : x; };
  const auto moved = [&](const AlignedBox2d& box) {
    return AlignedBox2d(Vector2d(snapped(box.min().x()), snapped(box.min().y() + top)),
                        Vector2d(snapped(box.max().x()), snapped(box.max().y() + top)));
  };
  for (PanelPlace& p : block.panels) {
    p.box = moved(p.box);
    for (AlignedBox2d& inset : p.insets) inset = moved(inset);
  }
}

/// Places entries one after the other in as many centred rows as necessary. Returns the bottom.
double place_legend(const std::vector<render::LegendItem>& legend, const LayoutOptions& o, double top,
                    FigureLayout& out) {
  const double em = o.font_size, row = kLine * em,
               room = o.width - 0.2 * em;  // outlines of marks stay inside the paper's width
  std::vector<double> widths, marks;
  for (const render::LegendItem& item : legend) {
    marks.push_back(item.is_line() ? 1.8 * em : 0.9 * em);
    widths.push_back(marks.back() + 0.4 * em + render::text_width(item.text, out.text_height));
    if (widths.back() > room)
      throw InputError("the legend's entry \"" + item.text + "\" is wider than the figure of " +
                       length_text(o.width) +
                       "; use a smaller --font-size, a larger --width, or --no-legend");
  }
  const double gap = 1.2 * em;
  for (std::size_t first = 0, end = 0; first < legend.size(); first = end) {
    double used = -gap;
    for (end = first; end < legend.size() && (end == first || used + gap + widths[end] <= room); ++end)
      used += gap + widths[end];
    double x = 0.5 * (o.width - used);
    for (std::size_t i = first; i < end; ++i) {
      const double centre = top + 0.5 * row, half = 0.36 * em;
      out.legend.push_back({AlignedBox2d(Vector2d(x, centre - half), Vector2d(x + marks[i], centre + half)),
                            {x + marks[i] + 0.4 * em, centre}});
      x += widths[i] + gap;
    }
    top += row;
  }
  return top;
}

}  // namespace

FigureLayout lay_out(const std::vector<Block>& blocks, const std::vector<render::LegendItem>& legend,
                     const std::optional<render::ScaleBar>& scale, const std::string& caption,
                     const LayoutOptions& options) {
  FigureLayout out;
  const double em = options.font_size;
  out.text_height = em * render::kHeightOfFont;
  double y = 0;
  for (const Block& block : blocks) {
    if (y > 0) y += kGutter * em;
    Arranged arranged = arrange(block, options);
    place(arranged.layout, y, options.grid);
    out.blocks.push_back(std::move(arranged.layout));
    y += arranged.height;
  }
  if (!legend.empty()) y = place_legend(legend, options, y + kGap * em, out);
  if (scale) {
    y += kGap * em;
    out.bar_text = {0.5 * options.width, y + 0.5 * kLine * em};
    y += kLine * em;
    const double half = 0.5 * kBarWidth * options.width;
    out.bar = AlignedBox2d(Vector2d(0.5 * options.width - half, y + 0.25 * em),
                           Vector2d(0.5 * options.width + half, y + 1.05 * em));
    y += kLine * em;
  }
  if (!caption.empty()) {
    y += kGap * em;
    for (std::string& line : wrap(caption, options.width, em)) {
      out.caption.emplace_back(y + 0.5 * kLine * em, std::move(line));
      y += kLine * em;
    }
  }
  out.height = options.grid > 0 ? options.grid * std::ceil(y / options.grid) : y;
  return out;
}

namespace {

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
      if (item.swatch) {
        // As drawn: half of the mark over what is under the face, half over paper.
        const AlignedBox2d half(box.min(), Vector2d(box.center().x(), box.max().y()));
        canvas.fill({render::corners(half)}, item.swatch->under);
        canvas.fill({render::corners(box)}, item.swatch->face);
        canvas.stroke(render::corners(box), true, {item.swatch->edge, thick, 0});
        break;
      }
      canvas.fill({render::corners(box)}, render::with_alpha(item.colour, 80));
      canvas.stroke(render::corners(box), true, {render::mix(item.colour, style.ink, 0.3), thick, 0});
      break;
    case Mark::line:
      canvas.stroke({left, right}, false, {item.colour, 1.5 * thick, 0});
      break;
    case Mark::thin:
      canvas.stroke({left, right}, false, {item.colour, 0.4 * thick, 0});
      break;
    case Mark::ends: {
      const Vector2d inset(0.25 * box.sizes().y(), 0);
      canvas.stroke({left, right}, false, {item.colour, 1.2 * thick, 0});
      for (const Vector2d& end : {Vector2d(left + inset), Vector2d(right - inset)})
        canvas.disc(end, 0.25 * box.sizes().y(), item.colour);
      break;
    }
    case Mark::arrow:
    case Mark::thin_arrow: {
      const double width = item.mark == Mark::arrow ? 1.2 * thick : 0.4 * thick, head = 0.4 * box.sizes().y();
      canvas.stroke({left, right}, false, {item.colour, width, 0});
      canvas.stroke({right + Vector2d(-head, head), right, right - Vector2d(head, head)}, false,
                    {item.colour, width, 0});
      break;
    }
    case Mark::dashed:
      canvas.stroke({left, right}, false, {item.colour, 1.2 * thick, box.sizes().x() / 5});
      break;
    case Mark::point:
      canvas.disc(box.center(), 0.42 * box.sizes().y(), item.colour);
      break;
  }
}

void paint_bar(render::Canvas& canvas, const FigureLayout& layout, const render::ScaleBar& scale,
               const render::Style& style) {
  constexpr int kSteps = 128;
  const render::Rgba ink = style.ink;
  const AlignedBox2d& bar = *layout.bar;
  // Each step extends to the right end, under the next ones, because paper would show between steps that only
  // touch.
  for (int i = 0; i < kSteps; ++i) {
    const Vector2d from(bar.min().x() + bar.sizes().x() * i / kSteps, bar.min().y());
    canvas.fill({render::corners({from, bar.max()})}, style.value(i / (kSteps - 1.0)));
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
  if (scale) paint_bar(canvas, layout, *scale, style);
}

}  // namespace lrb::figure
