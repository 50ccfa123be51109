#include <algorithm>
#include <cmath>
#include <cstdio>

#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
namespace lrb::render {
namespace {

constexpr double kTextShare = 0.0275;  ///< height of text, as a share of the frame's
constexpr float kMinText = 10.5F, kMaxText = 44;
constexpr double kPictureShare = 0.5;  ///< minimum share of the frame's height
constexpr const char* kNarrowSpace = "\u202f";
constexpr const char* kRoom = "0\u202f000";

/// Returns 1, 2 and 5 times powers of ten from a positive value on, on a long scale only the powers, and last
/// the largest value, in place of ticks too close to it.
std::vector<double> log_ticks(double low, double high) {
  constexpr double kRounding = 1e-9, kLong = 1e3;  // rounding must not lose the first tick
  const bool is_long = high > kLong * low;
  const double room = is_long ? 3 : 1.6;
  std::vector<double> out;
  for (int power = static_cast<int>(std::floor(std::log10(low))); std::pow(10, power) <= high; ++power)
    for (const int digit : {1, 2, 5}) {
      if (digit > 1 && is_long) continue;
      const double value = digit * std::pow(10, power);
      if (value >= low * (1 - kRounding) && value * room <= high) out.push_back(value);
    }
  out.push_back(high);
  return out;
}

/// Places items from left to right, in as many rows as needed.
class Flow {
 public:
  Flow(int left, int right, int top, int row_height, int gap)
      : left_(left), right_(right), x_(left), y_(top), row_height_(row_height), gap_(gap) {}

  /// Returns the rectangle of an item of width `width`; starts a new row if it does not fit on this one.
  PixelRect place(int width) {
    if (x_ > left_ && x_ + width > right_) new_row();
    const PixelRect r{x_, y_, width, row_height_};
    x_ += width + gap_;
    used_ = true;
    return r;
  }
  void new_row() {
    if (!used_) return;
    y_ += row_height_;
    x_ = left_;
    used_ = false;
  }
  int bottom() const { return used_ ? y_ + row_height_ : y_; }

 private:
  int left_, right_, x_, y_, row_height_, gap_;
  bool used_ = false;
};

/// Lays an overlay out with a given text height.
class Layouter {
 public:
  Layouter(const Overlay& overlay, int width, int height, float text_height)
      : o_(overlay), width_(width), height_(height) {
    style_.height = text_height;
    out_.text_height = text_height;
    row_ = static_cast<int>(std::ceil(1.35F * text_height));
    margin_ = static_cast<int>(std::ceil(0.7F * text_height));
    mark_ = static_cast<int>(std::lround(0.72F * text_height));
  }

  OverlayLayout run() {
    // The picture gets the space between header and footer. The footer is measured first, because it is
    // aligned to the bottom.
    const int top = header();
    const int below = footer(0);
    const int bottom = below == 0 ? height_ : height_ - below - margin_;
    footer(bottom);
    out_.picture = {0, top, width_, bottom - top};
    return std::move(out_);
  }

 private:
  int text_width(const std::string& text, bool bold = false) const {
    TextStyle style = style_;
    style.bold = bold;
    return default_font().measure(text, style).width;
  }

  void add_text(const PixelRect& row, int x, const std::string& text, bool bold = false, bool faint = false) {
    out_.texts.push_back({{x, row.y, text_width(text, bold), row.height}, text, bold, faint});
  }

  /// Returns the y of its lower end.
  int header() {
    int y = o_.title.empty() && o_.event.empty() ? 0 : margin_ / 2;
    y = lines(o_.title, y, true, 0);
    if (!o_.event.empty()) {
      const bool marked = o_.event_colour.a > 0;
      if (marked) out_.event_mark = {margin_, y + (row_ - mark_) / 2, mark_, mark_};
      y = lines(o_.event, y, false, marked ? mark_ + margin_ / 2 : 0);
    }
    return y;
  }

  int lines(const std::string& text, int y, bool bold, int indent) {
    TextStyle style = style_;
    style.bold = bold;
    for (const std::string& line : default_font().wrap(text, width_ - 2 * margin_ - indent, style)) {
      add_text({0, y, width_, row_}, margin_ + indent, line, bold);
      y += row_;
    }
    return y;
  }

  /// Lays out the strip below the picture from y on and returns its height; y = 0 only measures it.
  int footer(int y) {
    // Texts that are added while measuring are removed again.
    const bool measuring = y == 0;
    const std::size_t texts = out_.texts.size();
    out_.key_marks.clear();
    const int scale_width = o_.scale ? place_scale(y) : 0;
    const int right = width_ - margin_ - (scale_width > 0 ? scale_width + 2 * margin_ : 0);
    Flow flow(margin_, right, y, row_, 2 * margin_);
    for (const OverlayCounter& c : o_.counters) place_counter(flow, c);
    flow.new_row();
    for (const LegendItem& item : o_.key) place_key(flow, item);
    const int bottom = std::max(flow.bottom(), o_.scale ? y + (o_.scale->log ? 3 : 2) * row_ : y);
    if (measuring) out_.texts.resize(texts);
    return bottom - y;
  }

  void place_counter(Flow& flow, const OverlayCounter& c) {
    // Reserve four digits, so that counters do not move while they count.
    const int name = text_width(c.name + " "), value = std::max(text_width(c.value), text_width(kRoom));
    const PixelRect r = flow.place(std::min(name + value, width_ - 2 * margin_));
    add_text(r, r.x, c.name, false, true);
    add_text(r, r.x + name, c.value);
  }

  void place_key(Flow& flow, const LegendItem& item) {
    const int mark = mark_width(item);
    const PixelRect r = flow.place(mark + margin_ / 2 + text_width(item.text));
    out_.key_marks.push_back({r.x, r.y + (row_ - mark_) / 2, mark, mark_});
    add_text(r, r.x + mark + margin_ / 2, item.text);
  }

  int mark_width(const LegendItem& item) const { return item.is_line() ? 2 * mark_ : mark_; }

  int place_scale(int y) { return o_.scale->log ? place_log_scale(y) : place_linear_scale(y); }

  /// Lays out the scale at the right: the quantity above, then the bar, then values below it. Returns its
  /// width.
  int place_log_scale(int y) {
    // The bar is wide enough for all values side by side.
    const std::vector<double> values = log_ticks(o_.scale->low, o_.scale->high);
    int widest = 0;
    for (const double v : values) widest = std::max(widest, text_width(short_number(v)));
    const int count = static_cast<int>(values.size());
    const int bar = std::max({8 * mark_, text_width(o_.scale->text), (count + 1) * (widest + margin_ / 2)});
    const int total = bar + widest, left = width_ - margin_ - total;
    add_text({0, y, width_, row_}, left + (total - text_width(o_.scale->text)) / 2, o_.scale->text);
    out_.bar = {left + widest / 2, y + row_ + (row_ - mark_) / 2, bar, mark_};
    out_.ticks.clear();
    for (const double v : values) {
      const int x = out_.bar.x + static_cast<int>(std::lround(place_on(*o_.scale, v) * (bar - 1)));
      out_.ticks.push_back(x);
      add_text({0, y + 2 * row_, width_, row_}, x - text_width(short_number(v)) / 2, short_number(v));
    }
    return total;
  }

  /// Lays out the scale at the right: the quantity above; low end, bar and high end below. Returns its width.
  int place_linear_scale(int y) {
    const std::string low = short_number(o_.scale->low), high = short_number(o_.scale->high);
    const int low_width = text_width(low), high_width = text_width(high), gap = margin_ / 2;
    // The bar fills the width of the title, or more.
    const int bar = std::max(8 * mark_, text_width(o_.scale->text) - low_width - high_width - 2 * gap);
    const int total = low_width + high_width + bar + 2 * gap, left = width_ - margin_ - total;
    add_text({0, y, width_, row_}, left + (total - text_width(o_.scale->text)) / 2, o_.scale->text);
    const PixelRect row{0, y + row_, width_, row_};
    add_text(row, left, low);
    out_.bar = {left + low_width + gap, row.y + (row_ - mark_) / 2, bar, mark_};
    add_text(row, out_.bar.right() + gap, high);
    return total;
  }

  const Overlay& o_;
  int width_, height_;
  TextStyle style_;
  int row_ = 0, margin_ = 0, mark_ = 0;
  OverlayLayout out_;
};

bool fits(const OverlayLayout& layout, int width, int height) {
  if (layout.picture.height < kPictureShare * height) return false;
  const PixelRect frame{0, 0, width, height};
  return std::all_of(layout.texts.begin(), layout.texts.end(),
                     [&](const auto& t) { return frame.contains(t.box); });
}

/// Returns true if there is more than one colour along the border.
bool runs_over(const Image& picture) {
  // A picture with a uniform border needs no frame.
  const Rgba first = picture.at(0, 0);
  for (int x = 0; x < picture.width(); ++x) {
    if (picture.at(x, 0) != first || picture.at(x, picture.height() - 1) != first) return true;
  }
  for (int y = 0; y < picture.height(); ++y) {
    if (picture.at(0, y) != first || picture.at(picture.width() - 1, y) != first) return true;
  }
  return false;
}

/// Returns the width of a line one screen pixel thick.
int hairline(float scale) {
  return std::max(1, static_cast<int>(std::lround(scale)));
}

/// Draws a disc. Radius and centre are in pixels.
void draw_disc(Image& image, double cx, double cy, double radius, Rgba colour) {
  const auto first = [&](double c) { return static_cast<int>(std::floor(c - radius)); };
  const auto last = [&](double c) { return static_cast<int>(std::ceil(c + radius)); };
  for (int y = first(cy); y <= last(cy); ++y)
    for (int x = first(cx); x <= last(cx); ++x) {
      const double inside = radius + 0.5 - std::hypot(x + 0.5 - cx, y + 0.5 - cy);
      image.blend(x, y, colour, static_cast<int>(255 * std::clamp(inside, 0.0, 1.0)));
    }
}

void draw_mark(Image& image, const PixelRect& r, const LegendItem& item, int thin, const Style& style) {
  using Mark = LegendItem::Mark;
  const int thick = std::max(2, r.height / 5), centre = r.y + r.height / 2;
  const int width = item.mark == Mark::thin || item.mark == Mark::thin_arrow ? thin : thick;
  const PixelRect line{r.x, r.y + (r.height - width) / 2, r.width, width};
  switch (item.mark) {
    case Mark::solid:
      image.fill(r, item.colour);
      image.stroke(r, style.edge_of(item.colour), thin);
      break;
    case Mark::translucent:
      image.fill(r, with_alpha(item.colour, 80));
      image.stroke(r, mix(item.colour, style.ink, 0.3), std::max(thin, thick / 2));
      break;
    case Mark::line:
    case Mark::thin:
      image.fill(line, item.colour);
      break;
    case Mark::dashed:
      // Three dashes with gaps of the same width.
      for (int part = 0; part < 5; part += 2) {
        const int x0 = r.x + r.width * part / 5, x1 = r.x + r.width * (part + 1) / 5;
        image.fill({x0, line.y, x1 - x0, width}, item.colour);
      }
      break;
    case Mark::ends:
      image.fill(line, item.colour);
      for (const double x : {r.x + 0.2 * r.height, r.right() - 0.2 * r.height})
        draw_disc(image, x, line.y + width / 2.0, 0.25 * r.height, item.colour);
      break;
    case Mark::arrow:
    case Mark::thin_arrow:
      image.fill({line.x, line.y, line.width - width, width}, item.colour);
      for (int back = 0; back < r.height / 2; ++back)
        for (const int y : {centre - back - 1, centre + back})
          image.fill({r.right() - width - back - 1, y, width + 1, 1}, item.colour);
      break;
    case Mark::point:
      draw_disc(image, r.x + 0.5 * r.width, r.y + 0.5 * r.height, 0.42 * r.height, item.colour);
      break;
  }
}

}  // namespace

double place_on(const ScaleBar& scale, double value) {
  const double t = scale.log ? std::log(value / scale.low) / std::log(scale.high / scale.low)
                             : (value - scale.low) / (scale.high - scale.low);
  return t > 0 ? std::min(t, 1.0) : 0;
}

OverlayLayout lay_out(const Overlay& overlay, int width, int height, float scale) {
  if (overlay.empty()) {
    OverlayLayout layout;
    layout.picture = {0, 0, width, height};
    layout.scale = scale;
    return layout;
  }
  // Text size depends on the frame's smaller side: a frame higher than wide has no more space for a line than
  // its width.
  const double side = std::min<double>(height, width * 0.75) / scale;
  float text = std::clamp(static_cast<float>(std::round(2 * kTextShare * side) / 2), kMinText, kMaxText);
  // Reduce the text until everything fits.
  for (;; text -= 0.5F) {
    OverlayLayout layout = Layouter(overlay, width, height, text * scale).run();
    layout.scale = scale;
    if (fits(layout, width, height)) return layout;
    if (text <= kMinText) break;
  }
  throw InputError("a frame of " + std::to_string(width) + "x" + std::to_string(height) +
                   " is too small for its title, counters and legend; make it larger or omit some of them");
}

PixelRect common_picture(std::span<const OverlayLayout> layouts) {
  if (layouts.empty()) return {};
  PixelRect out = layouts[0].picture;
  for (const OverlayLayout& l : layouts) {
    // The intersection of all: panels of a series have pictures of the same size.
    const int top = std::max(out.y, l.picture.y), bottom = std::min(out.bottom(), l.picture.bottom());
    out.y = top;
    out.height = std::max(1, bottom - top);
  }
  return out;
}

void draw_overlay(Image& image, const Overlay& overlay, const OverlayLayout& layout) {
  const Style& style = style_of(overlay.style);
  // The event marker, the key, the scale, then all texts over them.
  if (layout.event_mark.width > 0) {
    image.fill(layout.event_mark, overlay.event_colour);
    image.stroke(layout.event_mark, style.edge_of(overlay.event_colour), hairline(layout.scale));
  }
  for (std::size_t i = 0; i < layout.key_marks.size(); ++i)
    draw_mark(image, layout.key_marks[i], overlay.key[i], hairline(layout.scale), style);
  for (int x = 0; x < layout.bar.width; ++x) {
    const double t = layout.bar.width > 1 ? static_cast<double>(x) / (layout.bar.width - 1) : 0;
    image.fill({layout.bar.x + x, layout.bar.y, 1, layout.bar.height}, style.value(t));
  }
  const PixelRect& bar = layout.bar;
  for (const int x : layout.ticks)
    image.fill({x - hairline(layout.scale) / 2, bar.bottom(), hairline(layout.scale), bar.height / 3},
               style.ink);
  for (const OverlayLayout::Text& t : layout.texts) {
    TextStyle text;
    text.height = layout.text_height;
    text.bold = t.bold;
    text.colour = t.faint ? style.faint : style.ink;
    const int height = default_font().measure(t.text, text).height;
    default_font().draw(image, t.text, t.box.x, t.box.y + (t.box.height - height) / 2, text);
  }
}

Image compose_frame(const Image& picture, const PixelRect& place, const Overlay& overlay, int width,
                    int height, Rgba background, float scale) {
  Image frame(width, height, background);
  frame.paste(picture, place.x, place.y);
  if (runs_over(picture)) frame.stroke(place, style_of(overlay.style).rule, hairline(scale));
  draw_overlay(frame, overlay, lay_out(overlay, width, height, scale));
  return frame;
}

std::string group_digits(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += kNarrowSpace;
    out += digits[i];
  }
  return out;
}

std::string counted(std::uint64_t n, const char* one, const char* many) {
  return group_digits(n) + " " + (n == 1 ? one : many);
}

std::string short_number(double value) {
  constexpr double kWholeFrom = 999.5;  // three digits would show 1e+03
  if (std::abs(value) >= kWholeFrom && std::abs(value) < 1e6) value = std::round(value);
  if (value == std::floor(value) && std::abs(value) < 1e6) {
    const std::string digits = group_digits(static_cast<std::uint64_t>(std::abs(value)));
    return value < 0 ? std::string("-").append(digits) : digits;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string percent(double share) {
  return short_number(100 * share) + " %";
}

}  // namespace lrb::render
