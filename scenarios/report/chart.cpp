#include "scenarios/report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "scenarios/io/files.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::report {
namespace {

const char* program() {
  const char* given = std::getenv("LRB_GNUPLOT");
  return given != nullptr && *given != '\0' ? given : "gnuplot";
}

constexpr const char* kInstall = ": install Debian's gnuplot-nox, or set LRB_GNUPLOT to the program";

/// Returns the command that sets the terminal. The font is DejaVu Sans, as in the pictures.
std::string terminal(const Gnuplot& chart, const std::string& ending) {
  constexpr double kInch = 25.4, kPointsPerInch = 72, kDpi = 300, kPngDpi = 96;
  const std::string font = " font 'DejaVu Sans," + io::number_text(chart.font) + "'";
  const auto size = [&](double dpi) {
    return " size " + io::number_text(std::round(chart.width / kInch * dpi)) + "," +
           io::number_text(std::round(chart.height / kInch * dpi));
  };
  if (ending == ".svg")
    return "svg noenhanced" + size(kPointsPerInch) + font + " linewidth 0.75 background '#ffffff'";
  if (ending == ".pdf")
    return "pdfcairo noenhanced size " + io::number_text(chart.width / kInch) + "," +
           io::number_text(chart.height / kInch) + font + " linewidth 0.75";
  if (ending == ".png")  // its fonts and lines are made for 96 dpi
    return "pngcairo noenhanced" + size(kDpi) + " fontscale " + io::number_text(kDpi / kPngDpi) + font +
           " linewidth " + io::number_text(kDpi / kPngDpi) + " pointscale " + io::number_text(kDpi / kPngDpi);
  throw InputError(ending + ": charts are written as .svg, .png or .pdf");
}

/// Returns the last message of gnuplot in one line: it names the line and the error.
std::string last_lines(const std::string& errors) {
  std::istringstream in(errors);
  std::string line, last;
  while (std::getline(in, line))
    if (line.find_first_not_of(" \t^\r") != std::string::npos)
      last = line.substr(line.find_first_not_of(" \t"));
  return last.empty() ? "it gave no reason" : last;
}

}  // namespace

bool has_gnuplot() {
  return io::run_program({program(), "-"}, "exit\n").code == 0;
}

void Gnuplot::add_data(std::string_view name, const std::vector<std::string>& rows) {
  script += "$" + std::string(name) + " << END_OF_" + std::string(name) + "\n";
  for (const std::string& row : rows) script += row + "\n";
  script += "END_OF_" + std::string(name) + "\n";
}

std::string gnuplot_text(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c == '\n' || c == '\r' || c == '\0' ? ' ' : c;
  }
  return out + "'";
}

std::string gnuplot_data_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"')
      out += "''";  // a data field cannot contain one
    else if (c == '\\')
      out += "/";  // nor a backslash, which would start an escape
    else
      out += c == '\n' || c == '\r' || c == '\0' ? ' ' : c;
  }
  return out + "\"";
}

std::string drawn(const Gnuplot& chart, const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  io::Finished finished =
      io::run_program({program(), "-"}, "set terminal " + terminal(chart, ending) + "\nset encoding utf8\n" +
                                            io::valid_utf8(chart.script));
  if (!finished.not_started.empty())
    throw EnvironmentError(path + ": there is no program " + program() + kInstall);
  if (finished.code != 0 || finished.output.empty())
    throw EnvironmentError(path + ": " + program() + " failed: " + last_lines(finished.errors));
  return std::move(finished.output);
}

void draw(const Gnuplot& chart, const std::string& path) {
  io::write_text(path, drawn(chart, path));
}

namespace {

using io::number_text;
using nlohmann::json;

struct Shape {
  const char* name;  ///< Chart.js's
  int point;         ///< gnuplot's number
};

/// Shapes of series without one of their own, cycled through the first seven.
constexpr Shape kShapes[] = {{"circle", 7},   {"rect", 5},  {"triangle", 9},
                             {"rectRot", 13}, {"star", 3},  {"rectRounded", 4},
                             {"crossRot", 2}, {"cross", 1}, {"none", 0}};

json axis_json(const Axis& axis) {
  json ticks = json::array();
  for (const Tick& t : axis.ticks) ticks.push_back({{"at", t.at}, {"label", t.label}});
  return {{"label", axis.label}, {"log", axis.log}, {"min", axis.min}, {"max", axis.max}, {"ticks", ticks}};
}

json series_json(const Series& s) {
  constexpr const char* kLines[] = {"straight", "steps", "dashed", "none", "bars"};
  json points = json::array();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    json point = {{"x", s.x[i]}, {"y", s.y[i]}};
    for (const auto& [key, values] : {std::pair{"low", &s.low}, {"high", &s.high}, {"from", &s.from}})
      if (!values->empty()) point[key] = (*values)[i];
    if (!s.notes.empty()) point["note"] = s.notes[i];
    if (!s.targets.empty() && !s.targets[i].empty()) point["target"] = s.targets[i];
    points.push_back(std::move(point));
  }
  return {{"label", s.label},
          {"data", std::move(points)},
          {"colour", s.style.colour},
          {"shape", s.style.shape},
          {"line", kLines[static_cast<std::size_t>(s.style.line)]}};
}

std::string colour_of(const SeriesStyle& style, std::size_t i) {
  return " lc rgb '" + (style.colour.empty() ? series_colour(i) : style.colour) + "'";
}

/// Returns the style of the i-th series in gnuplot: colour, point and dashes.
std::string look(const SeriesStyle& style, std::size_t i) {
  const std::size_t colours = render::page::kSeries.size();
  const Shape* shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                    [&](const Shape& s) { return s.name == style.shape; });
  const int point = (shape == std::end(kShapes) ? kShapes[i % colours] : *shape).point;
  return colour_of(style, i) + " pt " + std::to_string(point) + " ps 0.5 dt " +
         (style.line == Line::dashed ? "2" : std::to_string(1 + i / colours)) + " lw 1.2";
}

const char* form(const Series& s) {
  if (s.style.line == Line::bars) return "boxes";
  if (s.style.line == Line::none || s.x.size() == 1) return "points";
  if (s.style.line == Line::steps) return "steps";
  return s.style.shape == "none" ? "lines" : "linespoints";
}

/// Returns the plot commands of a series, and adds its data to the chart.
std::string plot(Gnuplot& chart, const Series& s, std::size_t i, const std::string& name) {
  std::vector<std::string> rows;
  for (std::size_t k = 0; k < s.x.size(); ++k)
    rows.push_back(number_text(s.x[k]) + " " + number_text(s.y[k]) +
                   (s.low.empty() ? "" : " " + number_text(s.low[k]) + " " + number_text(s.high[k])) +
                   (s.from.empty() ? "" : " " + number_text(s.from[k])));
  chart.add_data(name, rows);
  const std::string style = look(s.style, i), data = "$" + name + " using ";
  const std::string title = s.label.empty() ? " notitle" : " title " + gnuplot_text(s.label);
  std::string out;
  if (!s.low.empty()) out += data + "1:2:3:4 with yerrorbars" + style + " notitle, ";
  if (!s.from.empty())
    out += data + "3:2:($1-$3):(0) with vectors nohead" + colour_of(s.style, i) + " dt 3 lw 1.2 notitle, ";
  return out + data + "1:2 with " + form(s) + style + title;
}

std::string axis_commands(const std::string& name, const Axis& axis, bool labelled) {
  std::string out =
      (axis.log ? "set logscale " : "unset logscale ") + name + "\nset " + name + "range " +
      (axis.max > axis.min ? "[" + number_text(axis.min) + ":" + number_text(axis.max) + "]" : "[*:*]") +
      "\nset " + name + "label " + gnuplot_text(labelled ? axis.label : "") + "\nset " + name + "tics ";
  if (axis.ticks.empty()) return out + "autofreq\n";
  for (std::size_t i = 0; i < axis.ticks.size(); ++i) {
    std::string label;
    for (const char c : axis.ticks[i].label) label += c == '%' ? std::string("%%") : std::string(1, c);
    out += (i == 0 ? "(" : ", ") + gnuplot_text(label) + " " + number_text(axis.ticks[i].at);
  }
  return out + ")\n";
}

/// Dimensions of the whole figure, in millimetres from the upper left corner.
struct Sheet {
  double width, height;
  std::string margins(double left, double right, double top, double bottom) const {
    std::string out;
    for (const auto& [side, at] : {std::pair{"l", left / width},
                                   {"r", right / width},
                                   {"t", 1 - top / height},
                                   {"b", 1 - bottom / height}})
      out += std::string("set ") + side + "margin at screen " + number_text(at) + "\n";
    return out;
  }
};

/// The labels of all panels, each once, with the series that shows it and its number.
std::vector<std::pair<const Series*, std::size_t>> key_of(std::span<const Chart> panels) {
  std::vector<std::pair<const Series*, std::size_t>> out;
  for (const Chart& panel : panels)
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      const Series& s = panel.series[i];
      const auto same = [&](const auto& entry) { return entry.first->label == s.label; };
      if (!s.label.empty() && !s.x.empty() && std::none_of(out.begin(), out.end(), same))
        out.emplace_back(&s, i);
    }
  return out;
}

/// Returns the commands that draw a key in a separate panel, in units of its columns and lines.
std::string key_commands(Gnuplot& chart, const std::vector<std::pair<const Series*, std::size_t>>& key,
                         int columns, int lines) {
  std::string out =
      "unset border\nunset tics\nunset title\nunset xlabel\nunset ylabel\nunset grid\nunset logscale\n"
      "set xrange [0:" +
      std::to_string(columns) + "]\nset yrange [0:" + std::to_string(lines) + "]\nplot ";
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < key.size(); ++i) {
    const double x = static_cast<int>(i) / lines, y = lines - 0.5 - static_cast<int>(i) % lines;
    const bool points = key[i].first->style.line == Line::none;
    const Series sample{"", points ? std::vector{x + 0.05} : std::vector{x + 0.02, x + 0.08},
                        std::vector(points ? 1 : 2, y), key[i].first->style};
    out += plot(chart, sample, key[i].second, "key" + std::to_string(i)) + ", ";
    labels.push_back(number_text(x + 0.1) + " " + number_text(y) + " " +
                     gnuplot_data_text(key[i].first->label));
  }
  chart.add_data("labels", labels);
  return out + "$labels using 1:2:3 with labels left\n";
}

}  // namespace

std::string series_colour(std::size_t i) {
  return render::css(render::page::kSeries[i % render::page::kSeries.size()].light);
}

void Ends::add(double x, double low, double high) {
  lower.x.push_back(x);
  lower.y.push_back(low);
  if (!std::isfinite(high)) return;
  upper.x.push_back(x);
  upper.y.push_back(high);
}

void Ends::move_to(Chart& chart) {
  for (Series* s : {&lower, &upper})
    if (!s->x.empty()) chart.series.push_back(std::move(*s));
}

std::string chart_json(const Chart& chart) {
  constexpr const char* kCursors[] = {"", "event", "step"};
  json series = json::array();
  for (const Series& s : chart.series) series.push_back(series_json(s));
  const json out = {{"x", axis_json(chart.x)},
                    {"y", axis_json(chart.y)},
                    {"cursor", kCursors[static_cast<std::size_t>(chart.cursor)]},
                    {"series", std::move(series)}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

namespace {

/// Widths and heights around a panel, in millimetres.
struct PanelMargins {
  double line, left, right, top, bottom;
};

PanelMargins margins_of(double font, std::size_t panels) {
  constexpr double kPoint = 25.4 / 72;  // millimetres
  const double line = 1.3 * kPoint * font;
  return {line, 5.5 * line, line, panels > 1 ? 2 * line : line, 3.5 * line};
}

}  // namespace

PrintLayout layout_for(double width, std::span<const Chart> panels) {
  constexpr double kLeastPanel = 30, kLetter = 0.6, kSample = 8;  // of the key: letters per line, millimetres
  PrintLayout layout;
  const PanelMargins m = margins_of(layout.font, panels.size());
  const double around = m.left + m.right;
  if (width < around + kLeastPanel)
    throw InputError("expected a width of at least " + io::number_text(std::ceil(around + kLeastPanel)) +
                     " mm for a chart, found " + io::number_text(std::round(width * 10) / 10) + " mm");
  layout.columns = std::clamp(static_cast<int>(width / (around + kLeastPanel)), 1,
                              std::max(1, static_cast<int>(panels.size())));
  layout.panel_width = width / layout.columns - around;
  layout.panel_height = std::min(layout.panel_width, 0.6 * layout.panel_width + 12);
  std::size_t longest = 1;
  for (const auto& entry : key_of(panels)) longest = std::max(longest, entry.first->label.size());
  layout.key = "";
  layout.key_columns =
      std::max(1, static_cast<int>((width - 2 * m.line) /
                                   (kSample + kLetter * m.line / 1.3 * static_cast<double>(longest))));
  return layout;
}

Gnuplot gnuplot(std::span<const Chart> panels, const PrintLayout& layout) {
  const auto [line, left, right, top, bottom] = margins_of(layout.font, panels.size());
  const int count = static_cast<int>(panels.size()), columns = std::min(count, layout.columns);
  const int rows = (count + columns - 1) / columns;
  const auto key = layout.key.empty() ? key_of(panels) : key_of({});
  const int lines = (static_cast<int>(key.size()) + layout.key_columns - 1) / layout.key_columns;
  // A label of all panels is only below the last ones: the rows above need less space.
  const bool has_common_label = std::all_of(panels.begin(), panels.end(), [&](const Chart& panel) {
    return panel.x.label == panels.front().x.label;
  });
  const double gap = has_common_label ? 2 * line : bottom;
  const double column_width = left + layout.panel_width + right, row_height = top + layout.panel_height + gap,
               panels_height = rows * row_height + bottom - gap;
  const Sheet sheet{columns * column_width, panels_height + (lines > 0 ? 1.2 * line * lines + line : 0)};
  Gnuplot out{"", sheet.width, sheet.height, layout.font};
  std::string commands;
  const auto is_empty = [](const Chart& panel) {
    return std::all_of(panel.series.begin(), panel.series.end(), [](const Series& s) { return s.x.empty(); });
  };
  for (int p = 0; p < count; ++p) {
    const Chart& panel = panels[static_cast<std::size_t>(p)];
    if (is_empty(panel)) continue;
    const auto at = [&](int other) -> const Chart& { return panels[static_cast<std::size_t>(other)]; };
    const int column = p % columns, row = p / columns;
    const double x = column * column_width + left, y = row * row_height + top;
    commands +=
        sheet.margins(x, x + layout.panel_width, y, y + layout.panel_height) + "set title " +
        gnuplot_text(count > 1 ? panel.title : "") + " offset 0,-0.6\n" +
        axis_commands(
            "x", panel.x,
            p + columns >= count || is_empty(at(p + columns)) || at(p + columns).x.label != panel.x.label) +
        axis_commands("y", panel.y, column == 0 || is_empty(at(p - 1)) || at(p - 1).y.label != panel.y.label);
    std::string plots;
    for (std::size_t i = 0; i < panel.series.size(); ++i)
      if (!panel.series[i].x.empty())
        plots += (plots.empty() ? "plot " : ", ") +
                 plot(out, panel.series[i], i, "p" + std::to_string(p) + "s" + std::to_string(i));
    commands += plots + "\n";
  }
  if (lines > 0)
    commands +=
        sheet.margins(line, sheet.width - line, panels_height + 0.5 * line, sheet.height - 0.5 * line) +
        key_commands(out, key, layout.key_columns, lines);
  out.script +=
      "set multiplot\nset border 3 lw 0.6 lc rgb '#8a8f95'\nset tics nomirror scale 0.5\nset format '%g'\n"
      "set grid lw 0.4 lc rgb '#dddddd' dt 1\n" +
      (layout.key.empty() ? "unset key" : "set key " + layout.key + " reverse Left samplen 1.5") + "\n" +
      commands + "unset multiplot\n";
  return out;
}

}  // namespace lrb::report
