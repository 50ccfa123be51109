#include "render/canvas.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo.h>

#include <lrbscope/error.hpp>
#include <lrbscope/render/svg.hpp>

namespace lrb::render {
namespace {

template <class Handle, void (*destroy)(Handle*)>
struct Destroy {
  void operator()(Handle* handle) const { destroy(handle); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy<cairo_surface_t, cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Destroy<cairo_t, cairo_destroy>>;
using FontFace = std::unique_ptr<cairo_font_face_t, Destroy<cairo_font_face_t, cairo_font_face_destroy>>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw EnvironmentError(std::string("cairo cannot draw this picture: ") + cairo_status_to_string(status));
}

/// A font file loaded for cairo. FreeType's handles live as long as the process, because cairo caches objects
/// that use them.
cairo_font_face_t* load_font(bool bold) {
  static const FT_Library library = [] {
    FT_Library made = nullptr;
    if (FT_Init_FreeType(&made) != 0)
      throw EnvironmentError("FreeType, which draws text, cannot be initialised");
    return made;
  }();
  const std::string path = find_font(bold);
  FT_Face face = nullptr;
  if (FT_New_Face(library, path.c_str(), 0, &face) != 0)
    throw EnvironmentError(path + ": not a TrueType font; set LRB_FONT to another one");
  return cairo_ft_font_face_create_for_ft_face(face, 0);
}

cairo_font_face_t* font_face(bool bold) {
  static const FontFace regular(load_font(false)), heavy(load_font(true));
  return (bold ? heavy : regular).get();
}

/// Returns an image as a cairo surface: premultiplied, rows from the top.
Surface surface_of(const Image& image) {
  Surface out(cairo_image_surface_create(image.opaque() ? CAIRO_FORMAT_RGB24 : CAIRO_FORMAT_ARGB32,
                                         image.width(), image.height()));
  check(cairo_surface_status(out.get()));
  cairo_surface_flush(out.get());
  unsigned char* rows = cairo_image_surface_get_data(out.get());
  const int stride = cairo_image_surface_get_stride(out.get());
  for (int y = 0; y < image.height(); ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride);
    // Straight to premultiplied alpha, in cairo's 32-bit native-endian ARGB.
    for (int x = 0; x < image.width(); ++x) {
      const Rgba p = image.at(x, y);
      const auto part = [&](std::uint8_t c) { return static_cast<std::uint32_t>(div255(c * p.a)); };
      row[x] = static_cast<std::uint32_t>(p.a) << 24 | part(p.r) << 16 | part(p.g) << 8 | part(p.b);
    }
  }
  cairo_surface_mark_dirty(out.get());
  return out;
}

void set_font_options(cairo_t* c) {
  cairo_font_options_t* options = cairo_font_options_create();
  // Text width does not depend on the resolution.
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(c, options);
  cairo_font_options_destroy(options);
}

/// Selects the font of a text. Returns the left end of its baseline.
Eigen::Vector2d begin_text(cairo_t* c, const PaperText& t) {
  cairo_set_font_face(c, font_face(t.bold));
  cairo_set_font_size(c, t.height / kHeightOfFont);
  cairo_text_extents_t size;
  cairo_text_extents(c, t.text.c_str(), &size);
  const double share = t.align == Align::left ? 0 : t.align == Align::centre ? 0.5 : 1;
  return {t.at.x() - share * size.x_advance, t.at.y() + kBaseline * t.height};
}

class CairoCanvas : public Canvas {
 public:
  explicit CairoCanvas(cairo_t* context) : c_(context) {
    set_font_options(c_);
    cairo_set_line_join(c_, CAIRO_LINE_JOIN_ROUND);
  }

  void fill(const std::vector<Loop>& loops, Rgba colour, double spread = 0) override {
    for (const Loop& loop : loops) path(loop, true);
    cairo_set_fill_rule(c_, CAIRO_FILL_RULE_EVEN_ODD);
    ink(colour);
    if (!(spread > 0)) return cairo_fill(c_);
    cairo_fill_preserve(c_);
    cairo_set_line_width(c_, 2 * spread);
    cairo_set_dash(c_, nullptr, 0, 0);
    cairo_stroke(c_);
  }

  void stroke(const Loop& points, bool closed, const Pen& pen) override {
    path(points, closed);
    stroke_path(pen);
  }

  void strokes(const std::vector<Loop>& lines, const Pen& pen) override {
    for (const Loop& line : lines) path(line, false);
    stroke_path(pen);
  }

  void disc(const Eigen::Vector2d& at, double radius, Rgba colour) override {
    cairo_new_path(c_);
    cairo_arc(c_, at.x(), at.y(), radius, 0, 2 * std::numbers::pi);
    ink(colour);
    cairo_fill(c_);
  }

  void text(const PaperText& t) override {
    const Eigen::Vector2d at = begin_text(c_, t);
    // The halo is the outline of the glyphs, stroked under the text.
    if (t.halo.a > 0) {
      cairo_move_to(c_, at.x(), at.y());
      cairo_text_path(c_, t.text.c_str());
      ink(t.halo);
      cairo_set_line_width(c_, 2 * kTextHalo * t.height);
      cairo_set_dash(c_, nullptr, 0, 0);
      cairo_stroke(c_);
    }
    ink(t.colour);
    cairo_move_to(c_, at.x(), at.y());
    cairo_show_text(c_, t.text.c_str());
  }

  void picture(const Image& image, const Eigen::AlignedBox2d& place) override {
    const Surface surface = surface_of(image);
    cairo_save(c_);
    cairo_translate(c_, place.min().x(), place.min().y());
    cairo_scale(c_, place.sizes().x() / image.width(), place.sizes().y() / image.height());
    cairo_set_source_surface(c_, surface.get(), 0, 0);
    // Keep the picture's pixels, without interpolation.
    cairo_pattern_set_filter(cairo_get_source(c_), CAIRO_FILTER_NEAREST);
    cairo_paint(c_);
    cairo_restore(c_);
  }

  void begin_clip(const Eigen::AlignedBox2d& box) override {
    cairo_save(c_);
    path(corners(box), true);
    cairo_clip(c_);
  }

  void end_clip() override { cairo_restore(c_); }

 private:
  void stroke_path(const Pen& pen) {
    ink(pen.colour);
    cairo_set_line_width(c_, pen.width);
    // Round ends would fill the gaps between dashes.
    cairo_set_line_cap(c_, pen.dash > 0 ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
    cairo_set_dash(c_, &pen.dash, pen.dash > 0 ? 1 : 0, 0);
    cairo_stroke(c_);
  }

  void path(const Loop& points, bool closed) {
    for (std::size_t i = 0; i < points.size(); ++i)
      i == 0 ? cairo_move_to(c_, points[i].x(), points[i].y())
             : cairo_line_to(c_, points[i].x(), points[i].y());
    if (closed && !points.empty()) cairo_close_path(c_);
  }

  void ink(Rgba c) { cairo_set_source_rgba(c_, c.r / 255.0, c.g / 255.0, c.b / 255.0, c.a / 255.0); }

  cairo_t* c_;
};

void paint_page(cairo_surface_t* surface, double scale, const PaperPage& page,
                const std::function<void(Canvas&)>& paint) {
  const Context context(cairo_create(surface));
  check(cairo_status(context.get()));
  cairo_scale(context.get(), scale, scale);
  CairoCanvas canvas(context.get());
  if (page.background)
    canvas.fill({corners({Eigen::Vector2d::Zero(), Eigen::Vector2d(page.width, page.height)})},
                *page.background);
  paint(canvas);
  check(cairo_status(context.get()));
}

cairo_status_t append(void* closure, const unsigned char* bytes, unsigned int size) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(bytes), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string paint_pdf(const PaperPage& page, const std::function<void(Canvas&)>& paint) {
  std::string out;
  const Surface surface(cairo_pdf_surface_create_for_stream(append, &out, page.width, page.height));
  check(cairo_surface_status(surface.get()));
  cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_5);
  // No creation date: equal pages give equal files.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  if (!page.title.empty())
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, page.title.c_str());
  if (!page.creator.empty())
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, page.creator.c_str());
  paint_page(surface.get(), 1, page, paint);
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return out;
}

Image paint_pixels(const PaperPage& page, double dpi, const std::function<void(Canvas&)>& paint) {
  const double scale = dpi / kPointsPerInch;
  constexpr double kRounding = 1e-6;  // a size within rounding of a whole number is not enlarged
  Image out(static_cast<int>(std::ceil(page.width * scale - kRounding)),
            static_cast<int>(std::ceil(page.height * scale - kRounding)), kTransparent);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, out.width(), out.height()));
  check(cairo_surface_status(surface.get()));
  // The page is enlarged to whole pixels, so that its background covers the last row and column.
  PaperPage whole = page;
  whole.width = out.width() / scale, whole.height = out.height() / scale;
  paint_page(surface.get(), scale, whole, paint);
  cairo_surface_flush(surface.get());
  const unsigned char* rows = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < out.height(); ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(rows + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < out.width(); ++x) {
      // Premultiplied to straight, rounded to nearest.
      const auto a = static_cast<int>(row[x] >> 24);
      if (a == 0) continue;
      const auto part = [&](int shift) {
        return static_cast<std::uint8_t>(
            std::min(255, (static_cast<int>(row[x] >> shift & 255) * 255 + a / 2) / a));
      };
      out.at(x, y) = {part(16), part(8), part(0), static_cast<std::uint8_t>(a)};
    }
  }
  return out;
}

std::string text_outlines(const PaperText& text) {
  const Surface surface(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
  const Context context(cairo_create(surface.get()));
  cairo_t* c = context.get();
  check(cairo_status(c));
  set_font_options(c);
  const Eigen::Vector2d at = begin_text(c, text);
  cairo_move_to(c, at.x(), at.y());
  cairo_text_path(c, text.text.c_str());
  const std::unique_ptr<cairo_path_t, Destroy<cairo_path_t, cairo_path_destroy>> path(cairo_copy_path(c));
  check(path->status);
  std::string out;
  for (int i = 0; i < path->num_data; i += path->data[i].header.length) {
    const cairo_path_data_t* d = path->data + i;
    // A command with the points that follow it.
    out += "MLCZ"[d->header.type];
    for (int k = 1; k < d->header.length; ++k)
      out += (k > 1 ? " " : "") + svg_text::number(d[k].point.x) + " " + svg_text::number(d[k].point.y);
  }
  return out;
}

double text_width(const std::string& text, double height, bool bold) {
  TextStyle style;
  style.height = 256;  // line width is rounded to whole pixels: negligible for a large font
  style.bold = bold;
  return default_font().measure(text, style).width * height / style.height;
}

Canvas::Loop corners(const Eigen::AlignedBox2d& box) {
  return {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}};
}

}  // namespace lrb::render
