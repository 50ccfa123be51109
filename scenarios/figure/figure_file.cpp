#include <filesystem>

#include "scenarios/figure/figure.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::figure {

FigureSpec::Format format_of(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".pdf") return FigureSpec::Format::pdf;
  if (ending == ".svg") return FigureSpec::Format::svg;
  if (ending == ".png") return FigureSpec::Format::png;
  throw InputError(path + ": a figure is a .pdf, an .svg or a .png file: end its name in one of these");
}

double default_dpi(FigureSpec::Format format) {
  return format == FigureSpec::Format::png ? 300 : 600;
}

std::string figure_file(FigureSpec::Format format, double dpi, const render::PaperPage& page,
                        const std::function<void(render::Canvas&)>& paint) {
  constexpr double kPointsPerScreenPixel = 0.75;
  switch (format) {
    case FigureSpec::Format::pdf:
      return render::paint_pdf(page, paint);
    case FigureSpec::Format::svg: {
      render::SvgCanvas canvas(render::SvgCanvas::Texts::outlines);
      paint(canvas);
      return render::svg_file(
          canvas, {page.width, page.height, kPointsPerScreenPixel, page.title, page.background, true});
    }
    case FigureSpec::Format::png:
      break;
  }
  const auto png = render::encode_png(render::paint_pixels(page, dpi, paint),
                                      {{{"Software", page.creator}, {"lrbscope:scenario", page.title}}, dpi});
  return {png.begin(), png.end()};
}

}  // namespace lrb::figure
