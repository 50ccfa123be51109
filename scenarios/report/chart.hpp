#pragma once
/// Charts: one record each, drawn by a page's script and, for print, by gnuplot, which runs as a separate
/// program: it is not linked, and everything else works without it.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lrb::report {

/// Returns true if gnuplot is available: $LRB_GNUPLOT if set, else `gnuplot` on the PATH.
bool has_gnuplot();

/// A chart: gnuplot's commands with their data, without terminal and output, which follow from the file's
/// name.
struct Gnuplot {
  std::string script;  ///< gnuplot commands; data by add_data()
  double width = 160;  ///< millimetres
  double height = 100;
  double font = 8;  ///< points

  /// Appends a data block `$name`, which plot commands can read like a file. `rows` are lines of fields;
  /// their texts must be quoted by gnuplot_data_text().
  void add_data(std::string_view name, const std::vector<std::string>& rows);
};

/// Quotes text as a literal string of a gnuplot command: in single quotes, within which nothing is run or
/// substituted. Line breaks become spaces.
std::string gnuplot_text(std::string_view text);
/// Quotes text as one field of a data block.
std::string gnuplot_data_text(std::string_view text);

/// Runs gnuplot, without a shell, and returns the chart as a file of the path's extension: .svg, .png at 300
/// dpi, or .pdf. Throws EnvironmentError in one line if gnuplot is missing or fails, InputError for other
/// extensions.
std::string drawn(const Gnuplot& chart, const std::string& path);
/// Writes the chart to the path, atomically.
void draw(const Gnuplot& chart, const std::string& path);

struct Tick {
  double at;
  std::string label;
};

struct Axis {
  std::string label;
  bool log = false;
  double min = 0, max = 0;       ///< range; equal: that of the data
  std::vector<Tick> ticks = {};  ///< in print; empty: gnuplot's default
};

/// How the points of a series are joined. `steps`: a value is constant until the next point. `bars`: not at
/// all; each is a bar on top of those of the series before. (In print, bars start from 0.)
enum class Line : std::uint8_t { straight, steps, dashed, none, bars };

struct SeriesStyle {
  Line line = Line::straight;
  std::string colour = {};  ///< #rrggbb; empty: the next one of the palette
  std::string shape =
      {};  ///< of the points, by Chart.js's name; "none": no points; empty: the next one in print
};

struct Series {
  std::string label;         ///< empty: not in the key
  std::vector<double> x, y;  ///< of one length, x ascending
  SeriesStyle style = {};
  std::vector<double> low = {}, high = {};  ///< (|x|) ends of an error bar; or empty
  std::vector<double> from = {};            ///< (|x|) start of a thin level line to each point; or empty
  std::vector<std::string> notes = {};      ///< (|x|) tooltip of each point, by line; or empty
  std::vector<std::string> targets = {};    ///< (|x|) link of each point, relative to the page; or empty
};

/// Quantity on the x axis: the current frame is marked on it, and a click leads to a frame.
enum class Cursor : std::uint8_t { none, event, step };

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Series> series = {};
  std::string note = {};  ///< how to read the chart, in a sentence
  Cursor cursor = Cursor::none;
  bool has_key = true;  ///< on a page; false: that of an earlier chart is for this one as well
};

/// Returns the palette's colour for the i-th series of a chart.
std::string series_colour(std::size_t i);

/// Two curves that bound a number from below and above.
struct Ends {
  Series lower, upper;

  explicit Ends(const std::string& what, Line line = Line::straight)
      : lower{what + ", lower bound", {}, {}, {line}}, upper{what + ", upper bound", {}, {}, {line}} {}
  /// An infinite `high` is left out.
  void add(double x, double low, double high);
  /// Adds the curves that have points.
  void move_to(Chart& chart);
};

/// Returns the chart for the page's script.
std::string chart_json(const Chart& chart);

/// Sizes are in millimetres.
struct PrintLayout {
  int columns = 1;
  double panel_width = 135, panel_height = 85;  ///< between the axes' ends
  double font = 8;                              ///< points
  std::string key = "top right";  ///< position of each panel's key, in gnuplot's syntax; empty: one key below
                                  ///< all
  int key_columns = 2;            ///< of the common key
};

/// Returns how many readable panels with common axes stand side by side at a width in millimetres. Throws
/// InputError if not even one does.
int columns_within(double width);
/// Returns a layout of panels with common axes that is `width` millimetres wide and at most a page high, with
/// a common key.
PrintLayout layout_for(double width, int columns, std::span<const Chart> panels);

/// Returns the label of a tick at a power of ten: 0.1, 100, 10\u2075.
std::string power_label(int exponent);

/// Lays out panels in rows. Panels with one key below them have the same axes, whose ticks have labels at the
/// left and lower ends of rows and columns only; of others only the axes' labels are left out, where they do
/// not differ from the neighbour's.
Gnuplot gnuplot(std::span<const Chart> panels, const PrintLayout& layout = {});

}  // namespace lrb::report
