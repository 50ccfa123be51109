#pragma once
/// Charts for print, drawn by gnuplot: a program of its own, so that nothing of it is linked and everything
/// else works without it.

#include <string>
#include <string_view>
#include <vector>

namespace lrb::report {

/// Whether there is a gnuplot to run: $LRB_GNUPLOT if set, else `gnuplot` on the PATH.
bool has_gnuplot();

/// A chart: commands and their data, without terminal and output, which follow from the file.
struct Gnuplot {
  std::string script;  ///< gnuplot commands; data by add_data()
  double width = 160;  ///< millimetres
  double height = 100;
  double font = 8;  ///< points

  /// Appends a data block `$name`, to be plotted from as if it were a file. Rows of fields; texts quoted by
  /// gnuplot_data_text().
  void add_data(std::string_view name, const std::vector<std::string>& rows);
};

/// Text as a string of a gnuplot command, taken literally: single quotes, within which nothing is run or
/// substituted. Line breaks become spaces.
std::string gnuplot_text(std::string_view text);
/// Text as one field of a data block.
std::string gnuplot_data_text(std::string_view text);

/// Runs gnuplot, without a shell, and writes the chart under `path`: .svg, .png (300 dpi) or .pdf. Whole or
/// not at all. Throws EnvironmentError in one line if gnuplot is missing or fails, InputError for other
/// endings.
void draw(const Gnuplot& chart, const std::string& path);

}  // namespace lrb::report
