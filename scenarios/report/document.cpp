#include "scenarios/report/document.hpp"

#include <string_view>

#include <nlohmann/json.hpp>

#include "render/canvas.hpp"
#include "render/page_palette.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::report {
namespace {

constexpr const char* kKinds[] = {"expected", "actual", "difference"};
constexpr const char* kNames[] = {"Approved", "Found", "Difference, 16 times"};

std::string figure_html(const PageComparison& c, std::size_t kind) {
  if (c.data_uris[kind].empty()) return {};
  std::string out =
      "<figure class=\"" + std::string(kKinds[kind]) + "\"><figcaption><b>" + kNames[kind] + "</b>";
  if (kind < c.captions.size() && !c.captions[kind].empty())
    out += " " + render::escape_markup(c.captions[kind]);
  return out + "</figcaption><img alt=\"" + render::escape_markup(c.title + ", " + kKinds[kind]) +
         "\" src=\"" + render::escape_markup(c.data_uris[kind]) + "\"></figure>";
}

std::string modes_html(const PageComparison& c) {
  if (c.data_uris[0].empty() || c.data_uris[1].empty()) return {};
  return "<div class=\"modes\" role=\"group\" aria-label=\"How to compare\">"
         "<button type=\"button\" data-mode=\"side\" aria-pressed=\"true\">Side by side</button>"
         "<button type=\"button\" data-mode=\"swipe\" aria-pressed=\"false\">Swipe</button>"
         "<button type=\"button\" data-mode=\"difference\" aria-pressed=\"false\">Difference</button>"
         "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"Swipe: approved on the left, "
         "found on the right\"></div>\n";
}

}  // namespace

std::string comparisons_html(const std::vector<PageComparison>& comparisons) {
  std::string out;
  for (const PageComparison& c : comparisons) {
    out += "<section class=\"comparison\" id=\"" + render::escape_markup(c.id) + "\"><h2>" +
           render::escape_markup(c.title) + " <span class=\"outcome " +
           (c.passed ? "passed\">passed" : "failed\">failed") + "</span></h2>\n";
    out += "<p class=\"finding\">" + render::escape_markup(c.text) + "</p>\n" + modes_html(c);
    out += "<div class=\"pictures\" data-mode=\"side\">";
    for (std::size_t kind = 0; kind < c.data_uris.size(); ++kind) out += figure_html(c, kind);
    out += "</div>\n";
    if (!c.command.empty())
      out += "<p class=\"note\">If this is how it should be:</p>\n<pre class=\"command\"><code>" +
             render::escape_markup(c.command) + "</code></pre>\n";
    out += "</section>\n";
  }
  return out;
}

namespace {

using nlohmann::json;

/// Returns JSON that can stand in a script element: nothing in it can end the element.
std::string script_safe(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text)
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

const char* name_of(PageCursor cursor) {
  switch (cursor) {
    case PageCursor::event:
      return "event";
    case PageCursor::step:
      return "step";
    case PageCursor::none:
      break;
  }
  return "";
}

json chart_json(const PageChart& chart) {
  json series = json::array();
  for (const PageSeries& s : chart.series) {
    json points = json::array();
    for (std::size_t i = 0; i < s.x.size() && i < s.y.size(); ++i) {
      points.push_back({{"x", s.x[i]}, {"y", s.y[i]}});
      if (i < s.notes.size()) points.back()["note"] = s.notes[i];
      if (i < s.targets.size() && !s.targets[i].empty()) points.back()["target"] = s.targets[i];
    }
    series.push_back({{"label", s.label},
                      {"data", std::move(points)},
                      {"colour", s.colour},
                      {"shape", s.shape},
                      {"line", s.line}});
  }
  return {{"x", chart.x_label},       {"y", chart.y_label},          {"cursor", name_of(chart.cursor)},
          {"logX", chart.log_x},      {"logY", chart.log_y},         {"stepped", chart.stepped},
          {"scatter", chart.scatter}, {"series", std::move(series)}, {"leastX", chart.least_x},
          {"mostX", chart.most_x}};
}

json page_json(const Page& page) {
  json frames = json::array(), charts = json::array();
  for (const PageFrame& f : page.frames)
    frames.push_back({{"src", f.data_uri},
                      {"caption", f.caption},
                      {"file", f.file},
                      {"event", f.event},
                      {"step", f.step}});
  for (const PageChart& c : page.charts) charts.push_back(chart_json(c));
  return {{"frames", std::move(frames)}, {"charts", std::move(charts)}};
}

std::string numbers_html(const Page& page) {
  if (page.numbers.empty()) return {};
  std::string out = "<dl class=\"numbers\">\n";
  for (const PageNumber& n : page.numbers) {
    out += "<div><dt>" + render::escape_markup(n.label) + "</dt><dd>" + render::escape_markup(n.value);
    if (!n.note.empty()) out += "<small>" + render::escape_markup(n.note) + "</small>";
    out += "</dd></div>\n";
  }
  return out + "</dl>\n";
}

std::string texts_html(const Page& page) {
  if (page.texts.empty()) return {};
  std::string out = "<div class=\"texts\">\n";
  for (const PageText& t : page.texts)
    out += "<div><h2>" + render::escape_markup(t.title) + "</h2><p>" + render::escape_markup(t.text) +
           "</p></div>\n";
  return out + "</div>\n";
}

void fill_in(std::string& text, std::string_view mark, const std::string& with) {
  text.replace(text.find(mark), mark.size(), with);
}

std::string player_html(const Page& page) {
  if (page.frames.empty()) return {};
  std::string out(io::embedded_file("player.html"));
  fill_in(out, "{{note}}", render::escape_markup(page.frames_note));
  // Beside the view of the run, keys move from event to event, and frames are what is left without it.
  fill_in(out, "{{keys}}",
          page.scene.empty() ? "Keys: ← → one frame, shift ten, Home, End, space plays. " : "");
  if (page.scene.empty()) return out;
  return "<details class=\"frames\" id=\"frames\"><summary>Frames, as lrbscope drew them: " +
         std::to_string(page.frames.size()) + "</summary>\n" + out + "</details>\n";
}

std::string charts_html(const Page& page) {
  if (page.charts.empty()) return {};
  std::string out = "<section class=\"charts\">\n";
  for (std::size_t i = 0; i < page.charts.size(); ++i) {
    const PageChart& c = page.charts[i];
    out += "<figure class=\"chart\"><figcaption><h2>" + render::escape_markup(c.title) + "</h2>";
    if (!c.note.empty()) out += "<p>" + render::escape_markup(c.note) + "</p>";
    out += "</figcaption><div class=\"plot\"><canvas id=\"chart-" + std::to_string(i) +
           "\" role=\"img\" aria-label=\"" + render::escape_markup(c.title) + "\"></canvas></div></figure>\n";
  }
  return out + "</section>\n";
}

constexpr std::size_t kProse = 60;  // characters: cells longer than this are broken into lines

constexpr std::size_t kLong = 30;  // rows: tables of more scroll by themselves

bool looks_numeric(std::string_view cell) {
  // The last three bytes: a narrow space, between groups of digits.
  return cell.find_first_of("0123456789") != std::string_view::npos &&
         cell.find_first_not_of("0123456789.,+-eE %x\xE2\x80\xAF") == std::string_view::npos;
}

/// Tells the page's script what the rows of a table lead to.
std::string rows_attribute(PageRows rows) {
  switch (rows) {
    case PageRows::regions_of_a:
      return " data-rows=\"region 0\"";
    case PageRows::regions_of_b:
      return " data-rows=\"region 1\"";
    case PageRows::steps:
      return " data-rows=\"step\"";
    case PageRows::plain:
      break;
  }
  return {};
}

std::string tables_html(const Page& page) {
  std::string out;
  for (const PageTable& t : page.tables) {
    out += "<section><h2>" + render::escape_markup(t.title) + "</h2>\n<div class=\"scroll" +
           (t.rows.size() > kLong ? " long\" tabindex=\"0" : "") + "\"><table" + rows_attribute(t.rows_are) +
           "><thead><tr>";
    for (std::size_t c = 0; c < t.columns.size(); ++c) {
      const bool numeric = !t.rows.empty() && c < t.rows[0].size() && looks_numeric(t.rows[0][c]);
      out +=
          std::string(numeric ? "<th class=\"n\">" : "<th>") + render::escape_markup(t.columns[c]) + "</th>";
    }
    out += "</tr></thead><tbody>\n";
    for (const auto& row : t.rows) {
      out += "<tr>";
      for (const std::string& cell : row) {
        const bool prose = cell.size() > kProse;
        out += std::string(looks_numeric(cell) ? "<td class=\"n\">"
                           : cell == "FAILED"  ? "<td class=\"bad\">"
                           : prose             ? "<td class=\"prose\">"
                                               : "<td>") +
               render::escape_markup(cell) + "</td>";
      }
      out += "</tr>\n";
    }
    out += "</tbody></table></div>";
    if (!t.note.empty()) out += "<p class=\"note\">" + render::escape_markup(t.note) + "</p>";
    out += "</section>\n";
  }
  return out;
}

std::string views_html(const Page& page) {
  if (page.views.empty()) return {};
  std::string out = "<section class=\"views\"><h2>Seen by one camera</h2>\n<div class=\"pair\">";
  for (const PageView& v : page.views)
    out += "<figure><figcaption>" + render::escape_markup(v.title) + "</figcaption><iframe src=\"" +
           render::escape_markup(v.target) + "?alone\" title=\"" + render::escape_markup(v.title) +
           "\"></iframe></figure>";
  return out +
         "</div>\n<p class=\"note\">These are the runs' own pages, which this one only frames: they must stay where they "
         "are. Turning one turns the other; a time step of one is shown in the other.</p></section>\n";
}

std::string figures_html(const Page& page) {
  std::string out;
  for (const PageFigure& f : page.figures)
    out += "<section class=\"figure\"><h2>" + render::escape_markup(f.title) + "</h2>\n<figure><a href=\"" +
           render::escape_markup(f.file) + "\">" +
           (f.svg.empty() ? "<img src=\"" + f.data_uri + "\" alt=\"" + render::escape_markup(f.title) + "\">"
                          : f.svg) +
           "</a><figcaption>" + render::escape_markup(f.caption) + "</figcaption></figure></section>\n";
  return out;
}

std::string source_html(const Page& page) {
  std::string out;
  if (!page.command.empty())
    out += "<section><h2>Made by</h2>\n<pre class=\"command\"><code>" + render::escape_markup(page.command) +
           "</code></pre></section>\n";
  if (!page.links.empty()) {
    out += "<section><h2>Files</h2>\n<ul class=\"links\">\n";
    for (const PageLink& l : page.links) {
      out +=
          "<li><a href=\"" + render::escape_markup(l.target) + "\">" + render::escape_markup(l.text) + "</a>";
      if (!l.note.empty()) out += " <span>" + render::escape_markup(l.note) + "</span>";
      out += "</li>\n";
    }
    out += "</ul></section>\n";
  }
  return out;
}

/// Returns the scripts of others that the page needs.
std::string libraries(const Page& page) {
  std::string out;
  if (!page.charts.empty()) out += io::embedded_file("chart.min.js");
  if (!page.scene.empty())
    for (const char* name : {"three.min.js", "OrbitControls.js"})
      out.append("\n").append(io::embedded_file(name));
  return out;
}

/// Returns ours for the view of a run, each after those that it builds on.
std::string scene_scripts(const Page& page) {
  std::string out;
  if (page.scene.empty()) return out;
  for (const char* name : {"packed",         "scene_dom",          "scene_body",
                           "scene_events",   "scene_explanations", "scene_wrappers",
                           "scene_words",    "scene_selection",    "scene_filter",
                           "scene_table",    "scene_form",         "scene_panel",
                           "scene_why",      "scene_work",         "scene_counts",
                           "scene_colours",  "scene_meshes",       "scene_fill",
                           "scene_bodyview", "scene_marks",        "scene_why_marks",
                           "scene_measured", "scene_legend",       "scene_camera",
                           "scene_pick",     "scene_view",         "scene_time",
                           "scene_keys",     "scene_controls",     "scene_together",
                           "scene_rows",     "scene_load",         "scene"})
    out += io::embedded_file(name + std::string(".js"));
  return out;
}

}  // namespace

std::string footer(const std::string& version) {
  return (version.empty() ? "" : "lrbscope " + version + ". ") +
         "This page holds all it needs and fetches nothing.";
}

std::string page_html(const Page& page) {
  const std::string_view shape = io::embedded_file("page.html");
  const auto part = [&](std::string_view key) -> std::string {
    if (key == "title") return render::escape_markup(page.title);
    if (key == "purpose")
      return page.purpose.empty() ? ""
                                  : "<p class=\"purpose\">" + render::escape_markup(page.purpose) + "</p>";
    if (key == "verdict")
      return page.verdict.empty() ? ""
                                  : "<span class=\"verdict" + std::string(page.is_bad ? " bad" : "") + "\">" +
                                        render::escape_markup(page.verdict) + "</span>";
    if (key == "style")
      return render::page_root_css() + std::string(io::embedded_file("page.css")) +
             (page.scene.empty() ? ""
                                 : render::scene_root_css() + std::string(io::embedded_file("scene.css"))) +
             (page.grid.empty() ? "" : render::grid_root_css() + std::string(io::embedded_file("grid.css"))) +
             (page.views.empty() ? "" : std::string(io::embedded_file("views.css"))) +
             (page.comparisons.empty() ? "" : std::string(io::embedded_file("comparison.css")));
    if (key == "texts") return texts_html(page);
    if (key == "grid") return grid_html(page.grid);
    if (key == "numbers") return numbers_html(page);
    if (key == "layout") return page.scene.empty() ? "" : " class=\"wide\"";
    if (key == "scene") return page.scene.empty() ? "" : std::string(io::embedded_file("scene.html"));
    if (key == "player") return player_html(page);
    if (key == "charts") return charts_html(page);
    if (key == "tables") return tables_html(page);
    if (key == "figures") return figures_html(page);
    if (key == "views") return views_html(page);
    if (key == "frames") return page.views.empty() ? "" : "; frame-src file: 'self'";
    if (key == "comparisons") return comparisons_html(page.comparisons);
    if (key == "source") return source_html(page);
    if (key == "footer") return render::escape_markup(page.footer);
    if (key == "data")
      return script_safe(page_json(page).dump(-1, ' ', false, json::error_handler_t::replace));
    if (key == "scene_data")
      return page.scene.empty() ? ""
                                : "<script type=\"application/json\" id=\"scene-data\">" +
                                      script_safe(page.scene) + "</script>\n";
    if (key == "library") return libraries(page);
    if (key == "script")
      return std::string(io::embedded_file("page.js")) + scene_scripts(page) +
             (page.grid.empty() ? "" : std::string(io::embedded_file("grid.js"))) +
             (page.views.empty() ? "" : std::string(io::embedded_file("views.js"))) +
             (page.comparisons.empty() ? "" : std::string(io::embedded_file("comparison.js")));
    return {};
  };
  // The template is filled in one pass, so that marks inside what is put in are left alone.
  std::string out;
  std::size_t at = 0;
  for (std::size_t open = shape.find("{{"); open != std::string_view::npos; open = shape.find("{{", at)) {
    const std::size_t close = shape.find("}}", open);
    out += shape.substr(at, open - at);
    out += part(shape.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  out += shape.substr(at);
  return out;
}

}  // namespace lrb::report
