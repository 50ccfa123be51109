#include <algorithm>

#include "render/canvas.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/core/strings.hpp>

namespace lrb::report {
namespace {

constexpr std::array<const char*, kPageParts> kPartClasses = {"wrong", "crashed", "timed-out", "refused"};
/// Marks, by which parts are told apart without colour.
constexpr std::array<const char*, kPageParts> kPartMarks = {"", "\u2715", "\u25f7", "\u2298"};

std::string profile_svg(const PageGridCell& cell) {
  constexpr double kBar = 4, kStep = 5, kHeight = 20, kBase = 1;
  constexpr double kLeast = 2.5;  // least height of a part that is there, so that it is always seen
  const double width = kStep * static_cast<double>(cell.bars.size()) - (kStep - kBar);
  std::string out = "<svg class=\"profile\" viewBox=\"-1 -1 " + io::number_text(width + 2) + " " +
                    io::number_text(kHeight + kBase + 2) +
                    "\" preserveAspectRatio=\"none\" aria-hidden=\"true\">";
  const auto rect = [&](double x, double y, double h, const char* kind) {
    out += "<rect class=\"" + std::string(kind) + "\" x=\"" + io::number_text(x, 4) + "\" y=\"" +
           io::number_text(y, 4) + "\" width=\"" + io::number_text(kBar) + "\" height=\"" +
           io::number_text(h, 4) + "\"/>";
  };
  for (std::size_t i = 0; i < cell.bars.size(); ++i) {
    const double x = kStep * static_cast<double>(i);
    if (cell.bars[i][0] < 0) continue;
    rect(x, kHeight, kBase, "base");
    double y = kHeight;
    for (std::size_t k = 0; k < kPageParts; ++k) {
      if (cell.bars[i][k] <= 0) continue;
      const double h = std::max(kLeast, kHeight * cell.bars[i][k]);
      y = std::max(0.0, y - h);
      rect(x, y, h, kPartClasses[k]);
    }
  }
  return out + "</svg>";
}

std::string cell_class(const PageGridCell& cell) {
  if (cell.level == PageGridCell::kOnlyRefused) return "only-refused";
  return "level-" + std::to_string(cell.level);
}

std::string mark_html(std::size_t part, const std::string& text) {
  return "<span class=\"mark " + std::string(kPartClasses[part]) + "\">" + kPartMarks[part] + "\u2009" +
         render::escape_markup(text) + "</span>";
}

std::string cell_html(const PageGrid& grid, const PageGridCell& cell) {
  const std::string label = render::escape_markup(cell.label);
  std::string out = "<td class=\"" + cell_class(cell) + "\" title=\"" + label + "\">";
  const bool linked = cell.detail >= 0;
  if (linked)
    out += "<a href=\"#" + render::escape_markup(grid.details[static_cast<std::size_t>(cell.detail)].id) +
           "\" aria-label=\"" + label + "\">";
  else
    out += "<div>";
  out += "<span class=\"count\"><b>" + render::escape_markup(cell.count) + "</b> " +
         render::escape_markup(cell.of) + "</span>";
  out += profile_svg(cell) + "<span class=\"marks\">";
  for (std::size_t k = 0; k < kPageParts; ++k)
    if (!cell.marks[k].empty()) out += mark_html(k, cell.marks[k]);
  return out + "</span>" + (linked ? "</a>" : "</div>") + "</td>";
}

/// Lets long names of functions break at their underscores.
std::string breakable(const std::string& text) {
  std::string out;
  for (const char c : render::escape_markup(text)) {
    out += c;
    if (c == '_') out += "<wbr>";
  }
  return out;
}

std::string column_html(const PageGridHead& head) {
  std::string out = "<th scope=\"col\" title=\"" + render::escape_markup(head.text) + "\"><b>" +
                    breakable(head.title) + "</b>";
  if (!head.text.empty()) out += "<small>" + render::escape_markup(head.text) + "</small>";
  return out + "</th>";
}

/// Returns marks under a line as wide as a profile: every third bar has its value.
std::string axis_html(const std::vector<std::string>& axis) {
  constexpr std::size_t kEvery = 3;
  std::string out = "<small class=\"axis\" aria-hidden=\"true\">";
  for (std::size_t i = 0; i < axis.size(); i += kEvery)
    out += "<i style=\"left:" +
           io::number_text(100 * (static_cast<double>(i) + 0.5) / static_cast<double>(axis.size()), 4) +
           "%\">" + render::escape_markup(axis[i]) + "</i>";
  return out + "</small>";
}

std::string row_html(const PageGridHead& head) {
  std::string out = "<th scope=\"row\"><b>" + render::escape_markup(head.title) + "</b>";
  if (!head.text.empty()) out += "<small>" + render::escape_markup(head.text) + "</small>";
  if (!head.low.empty() || !head.high.empty())
    out += "<small class=\"dial\"><span>" + render::escape_markup(head.low) + "</span> \u2192 <span>" +
           render::escape_markup(head.high) + "</span></small>";
  if (!head.axis.empty()) out += axis_html(head.axis);
  return out + "</th>";
}

/// Where all columns fit, the page scrolls as a whole, under heads that stay; else the table scrolls in a
/// frame.
std::string wide_style(const PageGrid& grid) {
  constexpr double kHead = 15, kColumn = 5.6, kMargins = 3.5;  // as in grid.css, rem
  return "<style>@media (min-width: " +
         io::number_text(kHead + kMargins + kColumn * static_cast<double>(grid.columns.size())) +
         "rem) { .frame { overflow: visible; max-height: none; } }</style>\n";
}

std::string legend_html(const PageGrid& grid) {
  std::string out = "<ul class=\"key\">";
  for (std::size_t i = 0; i < grid.level_names.size(); ++i)
    out += "<li><i class=\"swatch level-" + std::to_string(i) + "\"></i>" +
           render::escape_markup(grid.level_names[i]) + "</li>";
  out += "<li><i class=\"swatch only-refused\"></i>refusals alone</li>";
  out += "</ul><ul class=\"key\">";
  for (std::size_t k = 0; k < kPageParts; ++k)
    out += "<li><svg class=\"swatch\" viewBox=\"0 0 1 1\" aria-hidden=\"true\"><rect class=\"" +
           std::string(kPartClasses[k]) + "\" width=\"1\" height=\"1\"/></svg>" +
           (*kPartMarks[k] != '\0' ? std::string(kPartMarks[k]) + " " : std::string()) +
           render::escape_markup(grid.part_names[k]) + "</li>";
  return out + "</ul>\n";
}

std::string detail_html(const PageGridDetail& d) {
  std::string out = "<dialog class=\"detail\" id=\"" + render::escape_markup(d.id) + "\"><header><h2>" +
                    render::escape_markup(d.title) +
                    "</h2><a class=\"close\" href=\"#grid\" aria-label=\"Close\">\u2715</a></header>\n";
  if (!d.text.empty()) out += "<p class=\"answer\">" + render::escape_markup(d.text) + "</p>\n";
  if (!d.data_uri.empty()) {
    const std::string image = "<img src=\"" + render::escape_markup(d.data_uri) + "\" alt=\"" +
                              render::escape_markup(d.title + ": " + d.text) + "\">";
    out += d.file.empty() ? image : "<a href=\"" + render::escape_markup(d.file) + "\">" + image + "</a>";
  }
  if (!d.facts.empty()) {
    out += "<dl class=\"facts\">";
    for (const auto& [name, value] : d.facts)
      out += "<div><dt>" + render::escape_markup(name) + "</dt><dd>" + render::escape_markup(value) +
             "</dd></div>";
    out += "</dl>\n";
  }
  if (!d.note.empty()) out += "<p class=\"note\">" + render::escape_markup(d.note) + "</p>\n";
  if (!d.command.empty())
    out += "<h3>See it again</h3><pre class=\"command\"><code>" + render::escape_markup(d.command) +
           "</code></pre>";
  return out + "</dialog>\n";
}

}  // namespace

std::string grid_html(const PageGrid& grid) {
  if (grid.empty()) return {};
  std::string out =
      "<section class=\"grid\" id=\"grid\"><h2>" + render::escape_markup(grid.title) + "</h2>\n";
  out += wide_style(grid) + legend_html(grid);
  if (!grid.missing.empty())
    out += "<p class=\"missing note\">" + render::escape_markup(grid.missing) + "</p>\n";
  out += "<div class=\"frame\" tabindex=\"0\" role=\"region\" aria-label=\"" +
         render::escape_markup(grid.title) +
         "\"><table style=\"--columns:" + std::to_string(grid.columns.size()) +
         "\"><thead><tr><th class=\"corner\">" + render::escape_markup(grid.corner) + "</th>";
  for (const PageGridHead& c : grid.columns) out += column_html(c);
  out += "</tr></thead><tbody>\n";
  for (std::size_t r = 0; r < grid.rows.size(); ++r) {
    const bool total = r + grid.total_rows >= grid.rows.size();
    out += (total ? "<tr class=\"total\">" : "<tr>") + row_html(grid.rows[r]);
    for (std::size_t c = 0; c < grid.columns.size(); ++c)
      out += cell_html(grid, grid.cells[r * grid.columns.size() + c]);
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  out += "<dl class=\"columns\">";  // in full, because the heads have no room for it
  for (const PageGridHead& c : grid.columns)
    if (!c.text.empty())
      out += "<div><dt>" + breakable(c.title) + "</dt><dd>" + render::escape_markup(c.text) + "</dd></div>";
  out += "</dl>\n";
  if (!grid.note.empty()) out += "<p class=\"note\">" + render::escape_markup(grid.note) + "</p>\n";
  out += "</section>\n";
  if (!grid.details.empty())
    out +=
        "<noscript><style>.detail:target { display: block; position: fixed; inset: 0; margin: auto; z-index: "
        "10; "
        "height: fit-content; }</style></noscript>\n";
  for (const PageGridDetail& d : grid.details) out += detail_html(d);
  return out;
}

}  // namespace lrb::report
