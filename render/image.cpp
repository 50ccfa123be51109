#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::render {

Image::Image(int width, int height, Rgba fill) : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw InputError("image size " + std::to_string(width) + "x" + std::to_string(height) +
                     ": each side must be 1 to " + std::to_string(kMaxSide) + " pixels");
  }
  pixels_.assign(static_cast<std::size_t>(width) * height, fill);
}

bool Image::opaque() const {
  return std::all_of(pixels_.begin(), pixels_.end(), [](Rgba p) { return p.a == 255; });
}

void Image::blend(int x, int y, Rgba colour, int coverage) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  Rgba& p = at(x, y);
  p = over(colour, p, coverage);
}

void Image::fill(const PixelRect& r, Rgba colour) {
  const int x1 = std::min(r.right(), width_), y1 = std::min(r.bottom(), height_);
  for (int y = std::max(r.y, 0); y < y1; ++y) {
    for (int x = std::max(r.x, 0); x < x1; ++x) at(x, y) = over(colour, at(x, y));
  }
}

void Image::stroke(const PixelRect& r, Rgba colour, int thickness) {
  const int t = std::min({thickness, (r.width + 1) / 2, (r.height + 1) / 2});
  fill({r.x, r.y, r.width, t}, colour);
  fill({r.x, r.bottom() - t, r.width, t}, colour);
  fill({r.x, r.y + t, t, r.height - 2 * t}, colour);
  fill({r.right() - t, r.y + t, t, r.height - 2 * t}, colour);
}

void Image::paste(const Image& image, int x, int y) {
  for (int j = 0; j < image.height(); ++j) {
    for (int i = 0; i < image.width(); ++i) blend(x + i, y + j, image.at(i, j));
  }
}

std::uint64_t hash(const Image& image) {
  static_assert(sizeof(Rgba) == 4);
  Fnv64 h;
  h.add_value(image.width());
  h.add_value(image.height());
  h.add_bytes(image.pixels().data(), image.pixels().size() * sizeof(Rgba));
  return h.value();
}

namespace {

int channel_difference(Rgba a, Rgba b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

bool ImageDifference::within(const ImageTolerance& tolerance) const {
  return same_size && share(large, pixels) <= tolerance.large_share &&
         share(small + medium, pixels) <= tolerance.small_share;
}

std::string ImageDifference::text(const ImageTolerance& tolerance) const {
  if (!same_size) return "the images differ in size";
  if (largest == 0) return "the images are identical";
  const double large_share = share(large, pixels), small_share = share(small + medium, pixels);
  const char* verdict = "within tolerance";
  if (large_share > tolerance.large_share) {
    verdict = "too many pixels differ strongly";
  } else if (small_share > tolerance.small_share) {
    verdict = "too many pixels differ slightly";
  }
  char line[256];
  std::snprintf(
      line, sizeof line,
      "%s: %.3g %% of pixels differ by more than %d (allowed %.3g %%), %.3g %% by less (allowed %.3g %%), "
      "largest %d",
      verdict, 100 * large_share, tolerance.large, 100 * tolerance.large_share, 100 * small_share,
      100 * tolerance.small_share, largest);
  return line;
}

ImageDifference compare(const Image& expected, const Image& actual, const ImageTolerance& tolerance) {
  ImageDifference d;
  d.same_size = expected.width() == actual.width() && expected.height() == actual.height();
  if (!d.same_size) return d;
  d.pixels = expected.pixels().size();
  for (std::size_t i = 0; i < expected.pixels().size(); ++i) {
    const int by = channel_difference(expected.pixels()[i], actual.pixels()[i]);
    d.largest = std::max(d.largest, by);
    ++(by == 0 ? d.equal : by <= tolerance.small ? d.small : by <= tolerance.large ? d.medium : d.large);
  }
  return d;
}

Image difference_image(const Image& expected, const Image& actual, int gain) {
  const int width = std::max(expected.width(), actual.width());
  const int height = std::max(expected.height(), actual.height());
  Image out(width, height, kWhite);
  const auto channel = [gain](int a, int b) {
    return static_cast<std::uint8_t>(std::min(255, std::abs(a - b) * gain));
  };
  for (int y = 0; y < std::min(expected.height(), actual.height()); ++y) {
    for (int x = 0; x < std::min(expected.width(), actual.width()); ++x) {
      const Rgba e = expected.at(x, y), a = actual.at(x, y);
      const std::uint8_t alpha = channel(e.a, a.a);
      out.at(x, y) = {std::max(channel(e.r, a.r), alpha), std::max(channel(e.g, a.g), alpha),
                      std::max(channel(e.b, a.b), alpha)};
    }
  }
  return out;
}

// Contact sheets.

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
    const double deviation = std::abs(std::log(shape / kShape)) + 0.5 * gaps / n;
    if (deviation < least) least = deviation, best = columns;
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
