#pragma once
/// Makes every HTML page and chart of the project: one file that opens from disk, with style, script,
/// charting library and pictures inside, and nothing fetched from anywhere.

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/report/page/comparison.hpp"
#include "scenarios/report/page/grid.hpp"

namespace lrb::report {

/// A number that is worth reading first.
struct PageNumber {
  std::string label, value;
  std::string note;  ///< small print under it; may be empty
};

/// A picture of a sequence.
struct PageFrame {
  std::string data_uri;  ///< see inline_image.hpp
  std::string caption;
  std::string file;   ///< link to the full picture, relative to the page; may be empty
  double event = -1;  ///< where it stands on charts over events; negative: nowhere
  double step = -1;   ///< where it stands on charts over time steps; negative: nowhere
};

struct PageSeries {
  std::string label;
  std::vector<double> x, y;  ///< of one length, x ascending
  // For scatter charts only:
  std::string colour = {}, shape = {};    ///< #rrggbb and Chart.js's name of a shape; empty: the page chooses
  bool line = false;                      ///< points are joined by steps and not drawn
  std::vector<std::string> notes = {};    ///< (|x|) what is said about each point, in lines; or empty
  std::vector<std::string> targets = {};  ///< (|x|) where a click on each point leads, relative to the page;
                                          ///< or empty
};

enum class PageCursor { none, event, step };

/// A chart of lines, or of points if `scatter`. The frame that is shown is marked on it, and a click leads to
/// a frame.
struct PageChart {
  std::string title, x_label, y_label;
  std::string note;  ///< one sentence on how to read the chart; may be empty
  std::vector<PageSeries> series;
  PageCursor cursor = PageCursor::none;  ///< what x counts
  bool log_x = false, log_y = false;
  bool stepped = false;  ///< values hold until the next point
  bool scatter = false;
  double least_x = 0, most_x = 0;  ///< ends of the x axis; equal: as the data have it
};

/// What the first cells of a table's rows number: a click on a row leads to it in the view of the run.
enum class PageRows : std::uint8_t { plain, regions_of_a, regions_of_b, steps };

struct PageTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< numbers in them are aligned right
  std::string note;
  PageRows rows_are = PageRows::plain;
};

/// A picture with its caption.
struct PageFigure {
  std::string title, caption;
  std::string data_uri;  ///< see inline_image.hpp
  std::string file;      ///< link to the full picture, relative to the page; may be empty
  std::string svg =
      {};  ///< in place of data_uri: the picture's own markup, so that its parts can say what they are
};

/// The view in three dimensions of another page, beside this one.
struct PageView {
  std::string title;
  std::string target;  ///< of the page that has it, relative to this one
};

/// A heading and a paragraph.
struct PageText {
  std::string title, text;
};

struct PageLink {
  std::string text, target;  ///< target: relative to the page
  std::string note;
};

/// What a page shows, from top to bottom; empty parts are left out.
struct Page {
  std::string title;
  std::string purpose;          ///< one or two sentences under the title
  std::string verdict;          ///< a short word beside the title, such as the relation of the bodies
  bool is_bad = false;          ///< the verdict is shown as a failure
  std::vector<PageText> texts;  ///< what a reader should know first, side by side
  std::vector<PageNumber> numbers;
  PageGrid grid;
  std::vector<PageComparison> comparisons;
  std::vector<PageView> views;  ///< side by side, with one camera and one time step
  std::string scene;            ///< a run as JSON, for the view in three dimensions (scene.js); empty: none
  std::vector<PageFrame> frames;
  std::string frames_note;
  std::vector<PageChart> charts;
  std::vector<PageTable> tables;
  std::vector<PageFigure> figures;
  std::string command;  ///< that made it, ready to copy
  std::vector<PageLink> links;
  std::string footer;
};

/// Returns what stands at a page's foot: the version that made it, if given, and that it is complete.
std::string footer(const std::string& version = {});

/// Returns the page as HTML.
std::string page_html(const Page& page);

}  // namespace lrb::report
