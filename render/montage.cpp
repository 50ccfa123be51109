#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::render {
namespace {

constexpr double kGutterShare = 1.0 / 24;
constexpr double kLabelShare = 1.0 / 20;
constexpr float kMinLabel = 12;
constexpr double kShape = 4.0 / 3;  ///< target ratio of width to height for automatic columns

int columns_for(const std::vector<Panel>& panels) {
  int best = 1;
  double least = std::numeric_limits<double>::infinity();
  const int n = static_cast<int>(panels.size());
  for (int columns = 1; columns <= n; ++columns) {
    // Compare the logarithm of the aspect ratio, with a penalty on empty cells.
    const int rows = (n + columns - 1) / columns, gaps = rows * columns - n;
    const double shape =
        static_cast<double>(columns * panels[0].image.width()) / (rows * panels[0].image.height());
    const double off = std::abs(std::log(shape / kShape)) + 0.5 * gaps / n;
    if (off < least) least = off, best = columns;
  }
  return best;
}

std::string caption_of(const std::vector<Panel>& panels, std::size_t i, const MontageOptions& options) {
  std::string text = options.letters ? panel_letter(i) : "";
  if (!text.empty() && !panels[i].caption.empty()) text += " ";
  return text + panels[i].caption;
}

TextStyle caption_style(float height, const Style& look = style_of(StyleName::screen)) {
  TextStyle style;
  style.height = height;
  style.align = Align::centre;
  style.colour = look.ink;
  return style;
}

}  // namespace

std::string panel_letter(std::size_t index) {
  std::string letters;
  // Bijective base 26: (a) to (z), then (aa).
  for (std::size_t n = index + 1; n > 0; n = (n - 1) / 26) {
    letters.insert(letters.begin(), static_cast<char>('a' + (n - 1) % 26));
  }
  return "(" + letters + ")";
}

MontageLayout lay_out(const std::vector<Panel>& panels, const MontageOptions& options) {
  if (panels.empty()) throw InputError("a montage needs at least one panel");
  const std::size_t columns = std::min(
      panels.size(), static_cast<std::size_t>(options.columns > 0 ? options.columns : columns_for(panels)));
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  // Step 1: columns and rows are as large as their largest panel.
  std::vector<int> column_width(columns, 0), row_height(rows, 0), caption_height(rows, 0);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    column_width[i % columns] = std::max(column_width[i % columns], panels[i].image.width());
    row_height[i / columns] = std::max(row_height[i / columns], panels[i].image.height());
  }
  const int side = std::min(panels[0].image.width(), panels[0].image.height());
  const int gutter =
      options.gutter >= 0 ? options.gutter : std::max(4, static_cast<int>(kGutterShare * side));

  MontageLayout out;
  out.text_height = options.text_height > 0
                        ? options.text_height
                        : std::max(kMinLabel, static_cast<float>(kLabelShare * panels[0].image.height()));
  const bool text = options.letters || std::any_of(panels.begin(), panels.end(),
                                                   [](const Panel& p) { return !p.caption.empty(); });
  const TextStyle style = caption_style(out.text_height);
  const int line = text ? default_font().measure("", style).height : 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    out.lines.push_back(
        text ? default_font().wrap(caption_of(panels, i, options), column_width[i % columns], style)
             : std::vector<std::string>{});
    const int lines = static_cast<int>(out.lines.back().size());
    const int height = lines == 0 ? 0 : lines * line + line / 2;
    caption_height[i / columns] = std::max(caption_height[i / columns], height);
  }
  int y = gutter;
  for (std::size_t row = 0; row < rows; ++row) {
    int x = gutter;
    for (std::size_t i = row * columns; i < std::min(panels.size(), (row + 1) * columns); ++i) {
      const int cell = column_width[i % columns];
      const Image& image = panels[i].image;
      out.panels.push_back({x + (cell - image.width()) / 2, y + (row_height[row] - image.height()) / 2,
                            image.width(), image.height()});
      out.captions.push_back({x, y + row_height[row], cell, caption_height[row]});
      x += cell + gutter;
    }
    out.width = std::max(out.width, x);
    y += row_height[row] + caption_height[row] + gutter;
  }
  out.height = y;
  return out;
}

Image montage(const std::vector<Panel>& panels, const MontageOptions& options) {
  const MontageLayout layout = lay_out(panels, options);
  Image out(layout.width, layout.height, options.background);
  const Style& look = style_of(options.style);
  const TextStyle style = caption_style(layout.text_height, look);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const PixelRect& r = layout.panels[i];
    out.paste(panels[i].image, r.x, r.y);
    if (options.frame) out.stroke(r, look.rule);
    if (layout.lines[i].empty()) continue;
    const PixelRect& c = layout.captions[i];
    const int line = default_font().measure("", style).height;
    int y = c.y + line / 4;
    for (const std::string& text : layout.lines[i]) {
      default_font().draw(out, text, c.x + c.width / 2, y, style);
      y += line;
    }
  }
  return out;
}

}  // namespace lrb::render
