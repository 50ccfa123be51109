#include "scenarios/figure/figure_tex.hpp"

#include <array>
#include <string_view>
#include <utility>

#include <lrbscope/render/svg.hpp>

namespace lrb::figure {

std::string escape_tex(const std::string& text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 18> kCommands = {
      {{"\\", "\\textbackslash{}"},
       {"{", "\\{"},
       {"}", "\\}"},
       {"_", "\\_"},
       {"#", "\\#"},
       {"$", "\\$"},
       {"%", "\\%"},
       {"&", "\\&"},
       {"~", "\\textasciitilde{}"},
       {"^", "\\textasciicircum{}"},
       {"<", "$<$"},
       {">", "$>$"},
       {"\u202f", "\\,"},
       {"\u2265", "$\\geq$"},
       {"\u2264", "$\\leq$"},
       {"\u2212", "$-$"},
       {"\u00d7", "$\\times$"},
       {"\u00b7", "$\\cdot$"}}};
  std::string out;
  for (std::string_view rest = text; !rest.empty();) {
    std::string_view known;
    for (const auto& [from, to] : kCommands) {
      if (!rest.starts_with(from)) continue;
      known = from;
      out += to;
      break;
    }
    if (known.empty()) out += rest[0];
    rest.remove_prefix(known.empty() ? 1 : known.size());
  }
  return out;
}

std::string TextOverlay::tex(const std::string& pdf, double width, double height, double font_size) const {
  using render::svg_text::number;
  std::string out =
      "% Texts of " + pdf +
      ", set by the document: \\input this file in place of \\includegraphics. Needs graphicx; texts in colour need "
      "xcolor.\n% If the PDF is in another folder: \\graphicspath{{folder/}}\n"
      "\\begingroup%\n\\providecommand\\color[2][]{}%\n\\setlength{\\unitlength}{1bp}%\n\\fontsize{" +
      number(font_size) + "bp}{" + number(1.2 * font_size) + "bp}\\selectfont%\n\\begin{picture}(" +
      number(width) + "," + number(height) + ")%\n\\put(0,0){\\includegraphics{\\detokenize{" + pdf +
      "}}}%\n";
  for (const render::PaperText& t : texts_) {
    // The box has no size, and its baseline is at the point.
    const std::string align = t.align == render::Align::left    ? "[lb]"
                              : t.align == render::Align::right ? "[rb]"
                                                                : "[b]";
    std::string text = escape_tex(t.text);
    if (t.bold) text = "\\textbf{" + text + "}";
    if (t.colour.r != 0 || t.colour.g != 0 || t.colour.b != 0)
      text = "\\color[rgb]{" + number(t.colour.r / 255.0) + "," + number(t.colour.g / 255.0) + "," +
             number(t.colour.b / 255.0) + "}" + text;
    out += "\\put(" + number(t.at.x()) + "," + number(height - t.at.y() - render::kBaseline * t.height) +
           "){\\makebox(0,0)" + align + "{\\smash{" + text + "}}}%\n";
  }
  return out + "\\end{picture}%\n\\endgroup%\n";
}

}  // namespace lrb::figure
