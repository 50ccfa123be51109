#include "scenarios/report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "render/canvas.hpp"
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
           io::number_text(chart.height / kInch) + " fontscale 0.75 pointscale 0.7" + font +
           " linewidth 0.75";
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
  const char* name;  ///< Chart.js's, with "Open" for an outline
  int point;         ///< gnuplot's number
};

/// Shapes of series without one of their own, cycled through the first seven.
constexpr Shape kShapes[] = {{"circle", 7},       {"rect", 5},         {"triangle", 9}, {"rectRot", 13},
                             {"star", 3},         {"rectOpen", 4},     {"crossRot", 2}, {"cross", 1},
                             {"triangleOpen", 8}, {"rectRotOpen", 12}, {"none", 0}};

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
  return colour_of(style, i) + " pt " + std::to_string(point) + " ps 0.55 dt " +
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
  if (!s.low.empty())
    out += data + "1:3:(0):($4-$3) with vectors nohead" + colour_of(s.style, i) + " lw 1.2 notitle, ";
  if (!s.from.empty())
    out += data + "3:2:($1-$3):(0) with vectors nohead" + colour_of(s.style, i) + " dt 3 lw 1.2 notitle, ";
  return out + data + "1:2 with " + form(s) + style + title;
}

constexpr double kPoint = 25.4 / 72;  // millimetres

/// `labelled`, `ticked`: with its label, with those of the ticks.
std::string axis_commands(const std::string& name, const Axis& axis, bool labelled, bool ticked) {
  std::string out =
      (axis.log ? "set logscale " : "unset logscale ") + name + "\nset " + name + "range " +
      (axis.max > axis.min ? "[" + number_text(axis.min) + ":" + number_text(axis.max) + "]" : "[*:*]") +
      "\nset format " + name + (ticked ? " '%g'" : " ''") + "\nset " + name + "label " +
      gnuplot_text(labelled ? axis.label : "") + "\nset " + name + "tics ";
  if (axis.ticks.empty()) return out + "autofreq\n";
  for (std::size_t i = 0; i < axis.ticks.size(); ++i) {
    std::string label;
    for (const char c : ticked ? axis.ticks[i].label : "")
      label += c == '%' ? std::string("%%") : std::string(1, c);
    out += (i == 0 ? "(" : ", ") + gnuplot_text(label) + " " + number_text(axis.ticks[i].at);
  }
  out += ")\n";
  if (axis.log && axis.ticks.size() > 1 && axis.ticks[0].label == "0")  // the axis is broken behind 0
    out += "set label 1 '//' at first " + number_text(std::sqrt(axis.ticks[0].at * axis.ticks[1].at)) +
           ", graph 0 center boxed front\n";
  return out;
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
      if (!s.label.empty() && !s.x.empty() && std::ranges::none_of(out, same)) out.emplace_back(&s, i);
    }
  return out;
}

/// Returns the commands that draw a key in a separate panel, in units of its columns and lines.
std::string key_commands(Gnuplot& chart, const std::vector<std::pair<const Series*, std::size_t>>& key,
                         int columns, int lines) {
  std::string out =
      "unset label\nunset border\nunset tics\nunset title\nunset xlabel\nunset ylabel\nunset grid\nunset logscale\n"
      "set xrange [0:" +
      std::to_string(columns) + "]\nset yrange [0:" + std::to_string(lines) + "]\nplot ";
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < key.size(); ++i) {
    const double x = static_cast<int>(i) / lines, y = lines - 0.5 - static_cast<int>(i) % lines;
    const bool points = key[i].first->style.line == Line::none;
    const Series sample{"", points ? std::vector{x + 0.055} : std::vector{x + 0.02, x + 0.09},
                        std::vector(points ? 1 : 2, y), key[i].first->style};
    out += plot(chart, sample, key[i].second, "key" + std::to_string(i)) + ", ";
    labels.push_back(number_text(x + 0.13) + " " + number_text(y) + " " +
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
                    {"has_key", chart.has_key},
                    {"series", std::move(series)}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

namespace {

constexpr double kLeastPanel = 20, kNarrow = 31, kHighest = 230;  // millimetres
const PrintLayout kCommon{1, 0, 0, 7, ""};                        ///< of panels with common axes and one key

/// Dimensions of a figure, in millimetres. `is_common`: panels have one key and the same axes.
struct Dimensions {
  bool is_common;
  double line, left, right, bottom, column_gap;  ///< around panels
  double top = 0, row = 0, panels = 0, key = 0;  ///< heights
  int key_lines = 0;
};

Dimensions dimensions_of(const PrintLayout& layout, std::span<const Chart> panels) {
  const bool is_common = layout.key.empty();
  const double line = 1.3 * kPoint * layout.font, left = (is_common ? 4.7 : 5.5) * line;
  Dimensions out{is_common, line, left, line, (is_common ? 3 : 3.5) * line, is_common ? line : left + line};
  const auto columns = static_cast<std::size_t>(layout.columns), key = is_common ? key_of(panels).size() : 0;
  const auto rows = static_cast<double>((panels.size() + columns - 1) / columns);
  // A label of all panels is only below the last ones: the rows above need less space.
  const bool has_common_label = std::ranges::all_of(
      panels, [&](const Chart& panel) { return panel.x.label == panels.front().x.label; });
  const double gap = is_common ? 0.5 * line : has_common_label ? 2 * line : out.bottom;
  out.top = line * (panels.size() < 2 ? 1 : is_common ? 3 : 2);
  out.row = out.top + layout.panel_height + gap;
  out.panels = rows * out.row + out.bottom - gap;
  out.key_lines =
      static_cast<int>(key + static_cast<std::size_t>(layout.key_columns) - 1) / layout.key_columns;
  if (out.key_lines > 0) out.key = (out.key_lines + 1) * line;
  return out;
}

bool is_empty(const Chart& panel) {
  return std::ranges::all_of(panel.series, [](const Series& s) { return s.x.empty(); });
}

}  // namespace

std::string power_label(int exponent) {
  constexpr const char* kDigits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  if (exponent >= -2 && exponent <= 3) return number_text(std::pow(10, exponent));
  std::string out = exponent < 0 ? "10\u207b" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) out += kDigits[digit - '0'];
  return out;
}

int columns_within(double width) {
  const Dimensions m = dimensions_of(kCommon, {});
  const double least = std::ceil(m.left + kLeastPanel + m.right);
  if (width < least)
    throw InputError("expected a width of at least " + number_text(least) + " mm for a chart, found " +
                     number_text(std::round(width * 10) / 10) + " mm");
  return static_cast<int>((width - m.left - m.right + m.column_gap) / (kLeastPanel + m.column_gap));
}

PrintLayout layout_for(double width, int columns, std::span<const Chart> panels) {
  constexpr double kSample = 6, kLowest = 12;  // of the key, of panels: millimetres
  PrintLayout layout = kCommon;
  layout.columns = columns;
  const Dimensions m = dimensions_of(layout, {});
  layout.panel_width = (width - m.left - m.right + m.column_gap) / columns - m.column_gap;
  double longest = 0;
  for (const auto& entry : key_of(panels))
    longest = std::max(longest,
                       kPoint * render::text_width(entry.first->label, layout.font * render::kHeightOfFont));
  layout.key_columns = std::max(1, static_cast<int>((width - m.line) / (kSample + longest)));
  const Dimensions around = dimensions_of(layout, panels);
  const double rows = std::ceil(static_cast<double>(panels.size()) / columns),
               room = (kHighest - around.panels - around.key) / rows;
  layout.panel_height =
      std::min({layout.panel_width, 0.6 * layout.panel_width + 12, std::max(kLowest, room)});
  return layout;
}

Gnuplot gnuplot(std::span<const Chart> panels, const PrintLayout& given) {
  PrintLayout layout = given;
  const int count = static_cast<int>(panels.size());
  layout.columns = std::max(1, std::min(count, layout.columns));
  const int columns = layout.columns;
  const Dimensions m = dimensions_of(layout, panels);
  const double step = layout.panel_width + m.column_gap;
  const Sheet sheet{m.left + m.right + columns * step - m.column_gap, m.panels + m.key};
  Gnuplot out{"", sheet.width, sheet.height, layout.font};
  std::string commands;
  const auto differs = [&](int p, int other, Axis Chart::*axis) {
    const auto at = [&](int i) -> const Chart& { return panels[static_cast<std::size_t>(i)]; };
    return is_empty(at(other)) || (at(other).*axis).label != (at(p).*axis).label;
  };
  for (int p = 0; p < count; ++p) {
    const Chart& panel = panels[static_cast<std::size_t>(p)];
    if (is_empty(panel)) continue;
    const int column = p % columns, row = p / columns;
    const double x = column * step + m.left, y = row * m.row + m.top;
    const bool is_lowest = p + columns >= count || differs(p, p + columns, &Chart::x),
               is_left = column == 0 || differs(p, p - 1, &Chart::y);
    const bool is_first = commands.empty();
    std::string title = gnuplot_text(count > 1 ? panel.title : "");
    if (const std::size_t comma = title.find(", "); m.is_common && comma != std::string::npos)
      title.replace(comma, 2, "'.\"\\n\".'");
    Axis x_axis = panel.x;
    if (m.is_common && layout.panel_width < kNarrow)  // every second label, or they would touch
      for (std::size_t t = x_axis.ticks.size(); t > 1; t -= 2) x_axis.ticks[t - 2].label = "";
    commands += sheet.margins(x, x + layout.panel_width, y, y + layout.panel_height) +
                "unset label\nset title " + title + " offset 0,-0.6\n" +
                axis_commands("x", x_axis, is_lowest && !m.is_common, is_lowest || !m.is_common) +
                axis_commands("y", panel.y, is_left, is_left || !m.is_common);
    std::string plots;
    for (std::size_t i = 0; i < panel.series.size(); ++i)
      if (!panel.series[i].x.empty())
        plots += (plots.empty() ? "plot " : ", ") +
                 plot(out, panel.series[i], i, "p" + std::to_string(p) + "s" + std::to_string(i));
    if (m.is_common && is_first)  // the label of all panels
      commands += "set label 2 " + gnuplot_text(panel.x.label) + " at screen " +
                  number_text((m.left + 0.5 * (sheet.width - m.left - m.right)) / sheet.width) + ", screen " +
                  number_text((m.key + 0.6 * m.line) / sheet.height) + " center\n";
    commands += plots + "\n";
  }
  if (m.key_lines > 0)
    commands += sheet.margins(0.5 * m.line, sheet.width - 0.5 * m.line, m.panels + 0.5 * m.line,
                              sheet.height - 0.5 * m.line) +
                key_commands(out, key_of(panels), layout.key_columns, m.key_lines);
  out.script +=
      "set multiplot\nset border 3 lw 0.6 lc rgb '#6b7075'\nset tics nomirror scale 0.5\n"
      "set grid lw 0.4 lc rgb '#dddddd' dt 1\nset style textbox opaque noborder margins 0.2,0.1\n" +
      (layout.key.empty() ? "unset key" : "set key " + layout.key + " reverse Left samplen 1.5") + "\n" +
      commands + "unset multiplot\n";
  return out;
}

}  // namespace lrb::report
