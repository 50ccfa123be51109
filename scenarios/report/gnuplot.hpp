#pragma once
/// Draws charts for print with gnuplot, which runs as a separate program: it is not linked, and everything
/// else works without it.

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

}  // namespace lrb::report
