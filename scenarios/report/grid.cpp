#include <algorithm>

#include "scenarios/report/document.hpp"
#include <lrbscope/core/strings.hpp>

namespace lrb::report {
namespace {

using io::number_text;

constexpr std::array<const char*, kParts> kPartClasses = {"wrong", "crashed", "timed-out", "refused"};
/// Marks that distinguish the parts without colour.
constexpr std::array<const char*, kParts> kPartMarks = {"", "\u2715", "\u25f7", "\u2298"};

std::string profile_svg(const GridCell& cell) {
  constexpr double kBar = 4, kStep = 5, kHeight = 20, kBase = 1;
  constexpr double kMin = 2.5;  // minimum height of a nonempty part, so that it is always visible
  const double width = kStep * static_cast<double>(cell.bars.size()) - (kStep - kBar);
  std::string out =
      fill(R"(<svg class="profile" viewBox="-1 -1 {} {}" preserveAspectRatio="none" aria-hidden="true">)",
           {number_text(width + 2), number_text(kHeight + kBase + 2)});
  const auto rect = [&](double x, double y, double h, const char* kind) {
    out += fill(R"(<rect class="{}" x="{}" y="{}" width="{}" height="{}"/>)",
                {kind, number_text(x, 4), number_text(y, 4), number_text(kBar), number_text(h, 4)});
  };
  for (std::size_t i = 0; i < cell.bars.size(); ++i) {
    const double x = kStep * static_cast<double>(i);
    if (cell.bars[i][0] < 0) continue;
    rect(x, kHeight, kBase, "base");
    double y = kHeight;
    for (std::size_t k = 0; k < kParts; ++k) {
      if (cell.bars[i][k] <= 0) continue;
      const double h = std::max(kMin, kHeight * cell.bars[i][k]);
      y = std::max(0.0, y - h);
      rect(x, y, h, kPartClasses[k]);
    }
  }
  return out + "</svg>";
}

std::string cell_html(const Grid& grid, const GridCell& cell) {
  const std::string level =
      cell.level == GridCell::kOnlyRejected ? "only-refused" : "level-" + std::to_string(cell.level);
  std::string marks;
  for (std::size_t k = 0; k < kParts; ++k)
    if (!cell.marks[k].empty())
      marks +=
          fill("<span class=\"mark {}\">{}\u2009{}</span>", {kPartClasses[k], kPartMarks[k], cell.marks[k]});
  std::string begin = "<div>", end = "</div>";
  if (cell.detail >= 0) {
    const std::string& id = grid.details[static_cast<std::size_t>(cell.detail)].id;
    begin = fill("<a href=\"#{}\" aria-label=\"{}\">", {id, cell.label});
    end = "</a>";
  }
  return fill(
      R"(<td class="{}" title="{}">{!}<span class="count"><b>{}</b> {}</span>{!}<span class="marks">{!}</span>{!}</td>)",
      {level, cell.label, begin, cell.count, cell.of, profile_svg(cell), marks, end});
}

/// Allows line breaks at the underscores of long function names.
std::string breakable(const std::string& text) {
  std::string out;
  for (const char c : render::escape_markup(text)) {
    out += c;
    if (c == '_') out += "<wbr>";
  }
  return out;
}

/// Returns marks under a line as wide as a profile, with a value at every third bar.
std::string axis_html(const std::vector<std::string>& axis) {
  constexpr std::size_t kEvery = 3;
  if (axis.empty()) return {};
  std::string out = "<small class=\"axis\" aria-hidden=\"true\">";
  for (std::size_t i = 0; i < axis.size(); i += kEvery) {
    const double at = 100 * (static_cast<double>(i) + 0.5) / static_cast<double>(axis.size());
    out += fill("<i style=\"left:{}%\">{}</i>", {number_text(at, 4), axis[i]});
  }
  return out + "</small>";
}

std::string row_html(const GridHead& head) {
  std::string ends;
  if (!head.low.empty() || !head.high.empty())
    ends = fill("<small class=\"difficulty\"><span>{}</span> \u2192 <span>{}</span></small>",
                {head.low, head.high});
  const std::string text = head.text.empty() ? "" : fill("<small>{!}</small>", {breakable(head.text)});
  return fill("<th scope=\"row\"><b>{}</b>{!}{!}{!}</th>", {head.title, text, ends, axis_html(head.axis)});
}

/// If all columns fit, the page scrolls as a whole under fixed heads; otherwise the table scrolls in a frame.
std::string wide_style(const Grid& grid) {
  constexpr double kHead = 15, kColumn = 4.6, kMargins = 3.5;  // as in grid.css, rem
  return fill(
      "<style>@media (min-width: {}rem) { .frame { overflow: visible; max-height: none; } }</style>\n",
      {number_text(kHead + kMargins + kColumn * static_cast<double>(grid.columns.size()))});
}

std::string legend_html(const Grid& grid) {
  std::string out = "<ul class=\"key\">";
  for (std::size_t i = 0; i < grid.level_names.size(); ++i)
    out += fill(R"(<li><i class="swatch level-{}"></i>{}</li>)", {std::to_string(i), grid.level_names[i]});
  out += "<li><i class=\"swatch only-refused\"></i>only refusals</li></ul><ul class=\"key\">";
  for (std::size_t k = 0; k < kParts; ++k)
    out += fill(
        R"(<li><svg class="swatch" viewBox="0 0 1 1" aria-hidden="true"><rect class="{}" width="1" height="1"/></svg>{} {}</li>)",
        {kPartClasses[k], kPartMarks[k], grid.part_names[k]});
  return out + "</ul>\n";
}

/// `uri`: its picture; may be empty.
std::string detail_html(const GridDetail& d, const std::string& uri) {
  std::string facts;
  for (const auto& [name, value] : d.facts) facts += fill("<div><dt>{}</dt><dd>{}</dd></div>", {name, value});
  std::string out = fill(
      R"(<dialog class="detail" id="{}"><header><h2>{}</h2><a class="close" href="#grid" aria-label="Close">)"
      "\u2715</a></header>\n<p class=\"answer\">{}</p>\n",
      {d.id, d.title, d.text});
  if (!uri.empty())
    out += fill(R"(<a href="{}"><img src="{}" alt="{}: {}"></a>)", {d.file, uri, d.title, d.text});
  out += fill("<dl class=\"facts\">{!}</dl>\n<p class=\"note\">{}</p>\n", {facts, d.note});
  if (!d.command.empty())
    out += fill("<h3>See it again</h3><pre class=\"command\"><code>{}</code></pre>", {d.command});
  return out + "</dialog>\n";
}

std::string table_html(const Grid& grid) {
  std::string out = fill(
      R"(<div class="frame" tabindex="0" role="region" aria-label="{}"><table style="--columns:{}"><thead>)"
      R"(<tr><th class="corner">{}</th>)",
      {grid.title, std::to_string(grid.columns.size()), grid.corner});
  for (const GridHead& c : grid.columns)
    out += fill(R"(<th scope="col" title="{}"><b>{}</b></th>)", {c.text, c.title});
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < grid.rows.size(); ++i) {
    const bool total = i < grid.total_rows;  // sums first
    const std::size_t r = (i + grid.rows.size() - grid.total_rows) % grid.rows.size();
    out += (total ? "<tr class=\"total\">" : "<tr>") + row_html(grid.rows[r]);
    for (std::size_t c = 0; c < grid.columns.size(); ++c)
      out += cell_html(grid, grid.cells[r * grid.columns.size() + c]);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string grid_html(const Grid& grid, const InlinedImages& images) {
  std::string columns;  // in full, because the heads are too narrow for it
  for (const GridHead& c : grid.columns)
    if (!c.text.empty()) columns += fill("<div><dt>{}</dt><dd>{!}</dd></div>", {c.title, breakable(c.text)});
  std::string out = fill("<section class=\"grid\" id=\"grid\"><h2>{}</h2>\n", {grid.title}) +
                    wide_style(grid) + legend_html(grid);
  if (!grid.missing.empty()) out += fill("<p class=\"missing note\">{}</p>\n", {grid.missing});
  out += table_html(grid) + fill("<dl class=\"columns\">{!}</dl>\n<p class=\"note\">{} {}</p>\n</section>\n",
                                 {columns, grid.note, images.note});
  out +=
      "<noscript><style>.detail:target { display: block; position: fixed; inset: 0; margin: auto; z-index: 10; "
      "height: fit-content; }</style></noscript>\n";
  std::size_t next = 0;
  for (const GridDetail& d : grid.details) out += detail_html(d, d.file.empty() ? "" : images.uris[next++]);
  return out;
}

}  // namespace lrb::report
